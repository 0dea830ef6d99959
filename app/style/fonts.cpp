#include <imgui_freetype.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>

#include "app/style/theme.h"

namespace limpid {
namespace {

constexpr float kRegularSize = 16;  // height of a line [px] at scale 1
constexpr float kSmallSize = 14;
constexpr float kDigitWidth = 0.51f;  // of that height, as wide as Inter's 0

constexpr std::array<ImWchar, 3> kDigits{'0', '9', 0};
constexpr std::array<ImWchar, 13> kGlyphs{
    0x20,   0xff,    // Latin
    0x370,  0x3ff,   // Greek
    0x2010, 0x2027,  // dashes, quotes, dots
    0x2070, 0x209f,  // raised and lowered digits
    0x2190, 0x22ff,  // arrows, mathematics
    0x25a0, 0x25ff,  // shapes
    0,
};

std::string find_font(const char* name) {
  constexpr std::array kFolders{"/usr/share/fonts/opentype/inter", "/usr/local/share/fonts",
                                "/usr/share/fonts/truetype/inter", "/usr/share/fonts/inter"};
  for (const char* folder : kFolders) {
    const std::filesystem::path file = std::filesystem::path(folder) / name;
    if (std::error_code error; std::filesystem::exists(file, error)) return file.string();
  }
  return "";
}

// Windows with more than one pixel for a unit are Wayland's, which come with a newer ImGui.
void set_density([[maybe_unused]] ImFontConfig& config, [[maybe_unused]] float density) {
#if IMGUI_VERSION_NUM >= 19010
  config.RasterizerDensity = density;
#endif
}

// Digits come first and all equally wide, so that changing numbers do not jump about.
void add_face(ImFontAtlas& atlas, const std::string& file, float size, float density) {
  ImFontConfig config;
  set_density(config, density);
  config.GlyphMinAdvanceX = config.GlyphMaxAdvanceX = std::round(kDigitWidth * size);
  atlas.AddFontFromFileTTF(file.c_str(), size, &config, kDigits.data());
  ImFontConfig rest;
  set_density(rest, density);
  rest.MergeMode = true;
  atlas.AddFontFromFileTTF(file.c_str(), size, &rest, kGlyphs.data());
}

}  // namespace

bool load_fonts(float scale, float density) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  atlas.FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
  const std::string regular = find_font("Inter-Regular.otf");
  const std::string semibold = find_font("Inter-SemiBold.otf");
  if (regular.empty() || semibold.empty()) {
    ImFontConfig config;
    config.SizePixels = std::round(13 * scale);
    atlas.AddFontDefault(&config);
    return false;
  }
  // In the order of Face.
  add_face(atlas, regular, std::round(kRegularSize * scale), density);
  add_face(atlas, semibold, std::round(kRegularSize * scale), density);
  add_face(atlas, regular, std::round(kSmallSize * scale), density);
  return true;
}

ImFont* font(Face face) {
  const ImVector<ImFont*>& fonts = ImGui::GetIO().Fonts->Fonts;
  const auto index = static_cast<int>(face);
  return index < fonts.Size ? fonts[index] : ImGui::GetFont();
}

}  // namespace limpid
