#include "app/style/theme.h"

#include <imgui_freetype.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>

namespace limpid {

namespace {

constexpr float kTextSize = 16;  // [px] at scale 1

void set_colours(const Palette& p, ImVec4* colours) {
  const auto set = [colours](ImGuiCol which, Rgb rgb, float alpha = 1) {
    colours[which] = colour_vector(rgb, alpha);
  };
  set(ImGuiCol_Text, p.text);
  set(ImGuiCol_TextDisabled, p.muted);
  set(ImGuiCol_WindowBg, p.panel);
  set(ImGuiCol_ChildBg, p.panel, 0);
  set(ImGuiCol_PopupBg, p.raised);
  set(ImGuiCol_Border, p.border);
  set(ImGuiCol_BorderShadow, p.border, 0);
  set(ImGuiCol_FrameBg, p.frame);
  set(ImGuiCol_FrameBgHovered, p.frame_hovered);
  set(ImGuiCol_FrameBgActive, p.frame_active);
  set(ImGuiCol_TitleBg, p.backdrop);
  set(ImGuiCol_TitleBgActive, p.backdrop);
  set(ImGuiCol_TitleBgCollapsed, p.backdrop);
  set(ImGuiCol_MenuBarBg, p.backdrop);
  set(ImGuiCol_ScrollbarBg, p.panel, 0);
  set(ImGuiCol_ScrollbarGrab, p.frame_hovered);
  set(ImGuiCol_ScrollbarGrabHovered, p.frame_active);
  set(ImGuiCol_ScrollbarGrabActive, p.axis);
  set(ImGuiCol_CheckMark, p.accent);
  set(ImGuiCol_SliderGrab, p.accent);
  set(ImGuiCol_SliderGrabActive, p.text);
  set(ImGuiCol_Button, p.frame);
  set(ImGuiCol_ButtonHovered, p.frame_hovered);
  set(ImGuiCol_ButtonActive, p.frame_active);
  set(ImGuiCol_Header, p.chosen);
  set(ImGuiCol_HeaderHovered, p.frame_hovered);
  set(ImGuiCol_HeaderActive, p.frame_active);
  set(ImGuiCol_Separator, p.border);
  set(ImGuiCol_SeparatorHovered, p.axis);
  set(ImGuiCol_SeparatorActive, p.accent);
  set(ImGuiCol_ResizeGrip, p.border, 0);
  set(ImGuiCol_ResizeGripHovered, p.axis);
  set(ImGuiCol_ResizeGripActive, p.accent);
  set(ImGuiCol_Tab, p.panel);
  set(ImGuiCol_TabHovered, p.frame_hovered);
  set(ImGuiCol_TabActive, p.chosen);
  set(ImGuiCol_TabUnfocused, p.panel);
  set(ImGuiCol_TabUnfocusedActive, p.chosen);
  set(ImGuiCol_PlotLines, ink(p, Ink::neutral));
  set(ImGuiCol_PlotLinesHovered, p.text);
  set(ImGuiCol_PlotHistogram, ink(p, Ink::neutral));
  set(ImGuiCol_PlotHistogramHovered, p.text);
  set(ImGuiCol_TableHeaderBg, p.raised);
  set(ImGuiCol_TableBorderStrong, p.border);
  set(ImGuiCol_TableBorderLight, p.grid);
  set(ImGuiCol_TableRowBg, p.panel, 0);
  set(ImGuiCol_TableRowBgAlt, p.frame, 0.35f);
  set(ImGuiCol_TextSelectedBg, p.axis, 0.5f);
  set(ImGuiCol_DragDropTarget, p.accent);
  set(ImGuiCol_NavHighlight, p.accent, 0.8f);
  set(ImGuiCol_NavWindowingHighlight, p.accent, 0.8f);
  set(ImGuiCol_NavWindowingDimBg, p.backdrop, 0.5f);
  set(ImGuiCol_ModalWindowDimBg, p.backdrop, 0.6f);
}

constexpr float kRegularSize = 16;  // height of a line [px] at scale 1
constexpr float kSmallSize = 14;
constexpr float kDigitWidth = 0.51f;  // part of that height, as wide as Inter's 0

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

// Sets more than one pixel for a unit: only Wayland's windows have that, with a newer ImGui.
void set_density([[maybe_unused]] ImFontConfig& config, [[maybe_unused]] float density) {
#if IMGUI_VERSION_NUM >= 19010
  config.RasterizerDensity = density;
#endif
}

// Adds a face with digits first and all equally wide, so that changing numbers do not jump about.
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

void apply_theme(Theme theme, float scale) {
  ImGuiStyle style;
  style.WindowPadding = {10, 10};
  style.FramePadding = {8, 4};
  style.CellPadding = {6, 3};
  style.ItemSpacing = {8, 6};
  style.ItemInnerSpacing = {6, 4};
  style.IndentSpacing = 14;
  style.ScrollbarSize = 11;
  style.GrabMinSize = 10;
  style.WindowRounding = 4;
  style.ChildRounding = 4;
  style.FrameRounding = 4;
  style.PopupRounding = 4;
  style.ScrollbarRounding = 6;
  style.GrabRounding = 4;
  style.TabRounding = 4;
  style.WindowTitleAlign = {0, 0.5f};
  style.WindowMenuButtonPosition = ImGuiDir_None;
  style.ScaleAllSizes(scale);
  style.WindowBorderSize = 1;
  style.ChildBorderSize = 1;
  style.PopupBorderSize = 1;
  style.FrameBorderSize = style.TabBorderSize = theme == Theme::contrast ? 1 : 0;
  set_colours(palette(theme), style.Colors);
  if (theme == Theme::contrast) {
    // Numbers of ImGui's own sliders stand on their knobs.
    style.Colors[ImGuiCol_SliderGrab] = style.Colors[ImGuiCol_Header];
    style.Colors[ImGuiCol_ScrollbarGrab] = style.Colors[ImGuiCol_Header];
    style.DisabledAlpha = 0.75f;
  }
  ImGui::GetStyle() = style;
}

Theme current_theme() {
  const ImVec4& background = ImGui::GetStyle().Colors[ImGuiCol_WindowBg];
  if (background.y >= 0.5f) return Theme::light;
  return background.y > 0 ? Theme::dark : Theme::contrast;
}

const Palette& current_palette() { return palette(current_theme()); }

float current_scale() { return ImGui::GetFontSize() / kTextSize; }

ImU32 colour(Rgb rgb, float alpha) {
  return IM_COL32(rgb.r, rgb.g, rgb.b, static_cast<int>(std::lround(alpha * 255)));
}

ImVec4 colour_vector(Rgb rgb, float alpha) {
  return {static_cast<float>(rgb.r) / 255, static_cast<float>(rgb.g) / 255,
          static_cast<float>(rgb.b) / 255, alpha};
}

std::string font_file(Face face) {
  return find_font(face == Face::semibold ? "Inter-SemiBold.otf" : "Inter-Regular.otf");
}

bool load_fonts(float scale, float density) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  atlas.FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
  const std::string regular = font_file(Face::regular), semibold = font_file(Face::semibold);
  if (regular.empty() || semibold.empty()) {
    ImFontConfig config;
    config.SizePixels = std::round(13 * scale);
    atlas.AddFontDefault(&config);
    return false;
  }
  // Fonts follow the order of Face.
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
