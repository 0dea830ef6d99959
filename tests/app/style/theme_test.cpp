// Look of the window: every colour is the theme's own and can be read, and all sizes follow the
// scale.
#include "app/style/theme.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/style/palette.h"

namespace limpid {
namespace {

constexpr Theme kThemesOfAll[] = {Theme::dark, Theme::light, Theme::contrast};

class ALook : public testing::Test {
 protected:
  ALook() { ImGui::CreateContext(); }
  ~ALook() override { ImGui::DestroyContext(); }

  static Rgb rgb_of(ImGuiCol which) {
    const ImVec4& c = ImGui::GetStyle().Colors[which];
    const auto byte = [](float part) { return static_cast<std::uint8_t>(std::lround(255 * part)); };
    return {byte(c.x), byte(c.y), byte(c.z)};
  }
  static float alpha_of(ImGuiCol which) { return ImGui::GetStyle().Colors[which].w; }
};

// Relative luminance by WCAG 2.
double light_of(Rgb c) {
  const auto linear = [](int byte) {
    const double part = byte / 255.0;
    return part <= 0.04045 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b);
}

double contrast_of(Rgb a, Rgb b) {
  const double x = light_of(a) + 0.05, y = light_of(b) + 0.05;
  return std::max(x, y) / std::min(x, y);
}

// Colours that the theme's palette has.
std::vector<Rgb> colours_of(const Palette& p) {
  std::vector<Rgb> all{p.text,   p.muted,         p.panel,        p.raised,   p.border,
                       p.frame,  p.frame_hovered, p.frame_active, p.backdrop, p.axis,
                       p.accent, p.chosen,        p.grid};
  all.push_back(ink(p, Ink::neutral));
  return all;
}

// ImGui's own colours are none of a theme's, so that one that is not set is found.
TEST_F(ALook, HasNoColourButThoseOfItsTheme) {
  for (const Theme theme : kThemesOfAll) {
    apply_theme(theme, 1);
    const std::vector<Rgb> own = colours_of(palette(theme));
    for (int which = 0; which < ImGuiCol_COUNT; ++which) {
      EXPECT_NE(std::ranges::find(own, rgb_of(which)), own.end())
          << ImGui::GetStyleColorName(which) << " in theme " << static_cast<int>(theme);
    }
    EXPECT_EQ(current_theme(), theme);
    EXPECT_EQ(&current_palette(), &palette(theme));
  }
}

TEST_F(ALook, CanBeReadOnEveryGround) {
  for (const Theme theme : kThemesOfAll) {
    apply_theme(theme, 1);
    for (const ImGuiCol ground :
         {ImGuiCol_WindowBg, ImGuiCol_PopupBg, ImGuiCol_FrameBg, ImGuiCol_FrameBgHovered,
          ImGuiCol_TitleBg, ImGuiCol_TitleBgActive, ImGuiCol_MenuBarBg, ImGuiCol_Button,
          ImGuiCol_ButtonHovered, ImGuiCol_Header, ImGuiCol_HeaderHovered, ImGuiCol_Tab,
          ImGuiCol_TabActive, ImGuiCol_TableHeaderBg}) {
      EXPECT_GE(contrast_of(rgb_of(ImGuiCol_Text), rgb_of(ground)), 4.5)
          << ImGui::GetStyleColorName(ground) << " in theme " << static_cast<int>(theme);
      EXPECT_EQ(alpha_of(ground), 1) << ImGui::GetStyleColorName(ground);
    }
    EXPECT_GE(contrast_of(rgb_of(ImGuiCol_TextDisabled), rgb_of(ImGuiCol_WindowBg)), 4.5);
    EXPECT_GE(contrast_of(rgb_of(ImGuiCol_CheckMark), rgb_of(ImGuiCol_FrameBg)), 3);
  }
}

// A thing that is pointed at looks otherwise than at rest, and one that is held than both.
TEST_F(ALook, ShowsWhatIsPointedAtAndHeld) {
  for (const Theme theme : kThemesOfAll) {
    apply_theme(theme, 1);
    constexpr ImGuiCol kTriples[][3] = {
        {ImGuiCol_Button, ImGuiCol_ButtonHovered, ImGuiCol_ButtonActive},
        {ImGuiCol_FrameBg, ImGuiCol_FrameBgHovered, ImGuiCol_FrameBgActive},
        {ImGuiCol_ScrollbarGrab, ImGuiCol_ScrollbarGrabHovered, ImGuiCol_ScrollbarGrabActive},
        {ImGuiCol_Separator, ImGuiCol_SeparatorHovered, ImGuiCol_SeparatorActive}};
    for (const auto& [rest, pointed, held] : kTriples) {
      // Lines are all alike in high contrast.
      if (theme == Theme::contrast && rest == ImGuiCol_Separator) continue;
      EXPECT_NE(rgb_of(rest), rgb_of(pointed)) << ImGui::GetStyleColorName(rest);
      EXPECT_NE(rgb_of(pointed), rgb_of(held)) << ImGui::GetStyleColorName(rest);
      EXPECT_NE(rgb_of(rest), rgb_of(held)) << ImGui::GetStyleColorName(rest);
    }
  }
}

// Lines stay a pixel wide; all else is as many times as large.
TEST_F(ALook, GrowsWithItsScale) {
  apply_theme(Theme::dark, 1);
  const ImGuiStyle one = ImGui::GetStyle();
  apply_theme(Theme::dark, 3);
  const ImGuiStyle& three = ImGui::GetStyle();
  for (ImVec2 ImGuiStyle::*pair :
       {&ImGuiStyle::WindowPadding, &ImGuiStyle::FramePadding, &ImGuiStyle::CellPadding,
        &ImGuiStyle::ItemSpacing, &ImGuiStyle::ItemInnerSpacing}) {
    EXPECT_EQ((three.*pair).x, 3 * (one.*pair).x);
    EXPECT_EQ((three.*pair).y, 3 * (one.*pair).y);
    EXPECT_GT((one.*pair).x, 0);
  }
  for (float ImGuiStyle::*size :
       {&ImGuiStyle::IndentSpacing, &ImGuiStyle::ScrollbarSize, &ImGuiStyle::GrabMinSize,
        &ImGuiStyle::WindowRounding, &ImGuiStyle::FrameRounding}) {
    EXPECT_EQ(three.*size, 3 * (one.*size));
  }
  for (float ImGuiStyle::*line : {&ImGuiStyle::WindowBorderSize, &ImGuiStyle::ChildBorderSize,
                                  &ImGuiStyle::PopupBorderSize}) {
    EXPECT_EQ(three.*line, 1);
  }
  // All corners are alike, and a title stands at the left.
  for (float ImGuiStyle::*corner :
       {&ImGuiStyle::ChildRounding, &ImGuiStyle::FrameRounding, &ImGuiStyle::PopupRounding,
        &ImGuiStyle::GrabRounding, &ImGuiStyle::TabRounding}) {
    EXPECT_EQ(one.*corner, one.WindowRounding);
  }
  EXPECT_EQ(one.WindowTitleAlign.x, 0);
  EXPECT_EQ(one.WindowMenuButtonPosition, ImGuiDir_None);
}

TEST_F(ALook, HasEdgesAroundFieldsInHighContrastAlone) {
  for (const Theme theme : kThemesOfAll) {
    apply_theme(theme, 1);
    const bool edged = theme == Theme::contrast;
    EXPECT_EQ(ImGui::GetStyle().FrameBorderSize, edged ? 1 : 0);
    EXPECT_EQ(ImGui::GetStyle().TabBorderSize, edged ? 1 : 0);
    // A slider's number stands on its knob.
    if (edged) {
      EXPECT_GE(contrast_of(rgb_of(ImGuiCol_Text), rgb_of(ImGuiCol_SliderGrab)), 4.5);
      EXPECT_GT(ImGui::GetStyle().DisabledAlpha, 0.6f) << "what is off can still be read";
    }
  }
}

TEST_F(ALook, HasThreeFacesWhoseDigitsAreEquallyWide) {
  if (!load_fonts(2)) GTEST_SKIP() << "Inter is not installed";
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
  EXPECT_EQ(font(Face::regular)->FontSize, font(Face::semibold)->FontSize);
  EXPECT_LT(font(Face::small)->FontSize, font(Face::regular)->FontSize);
  EXPECT_NE(font_file(Face::regular), font_file(Face::semibold));
  EXPECT_EQ(font_file(Face::regular), font_file(Face::small));
  for (const Face face : {Face::regular, Face::semibold, Face::small}) {
    const ImFont* f = font(face);
    for (ImWchar digit = '0'; digit <= '9'; ++digit) {
      EXPECT_EQ(f->FindGlyph(digit)->AdvanceX, f->FindGlyph('0')->AdvanceX);
    }
    EXPECT_LT(f->FindGlyph('i')->AdvanceX, f->FindGlyph('m')->AdvanceX) << "letters are not";
    // Greek, a dash, a raised and a lowered digit, a sign, a shape.
    for (const int letter : {0x3b7, 0x2212, 0x2013, 0x2079, 0x2081, 0x2264, 0x25cf, 0xb2}) {
      EXPECT_NE(f->FindGlyphNoFallback(static_cast<ImWchar>(letter)), nullptr)
          << std::hex << letter;
    }
  }
  const float large = font(Face::regular)->FontSize;
  load_fonts(1);
  ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
  EXPECT_EQ(font(Face::regular)->FontSize, large / 2);
}

TEST_F(ALook, TurnsColoursIntoImGuisOwn) {
  EXPECT_EQ(colour({255, 0, 0}), IM_COL32(255, 0, 0, 255));
  EXPECT_EQ(colour({1, 2, 3}, 0), IM_COL32(1, 2, 3, 0));
  EXPECT_EQ(colour({1, 2, 3}, 0.5f), IM_COL32(1, 2, 3, 128));
  const ImVec4 half = colour_vector({0, 255, 51}, 0.25f);
  EXPECT_EQ(half.x, 0);
  EXPECT_EQ(half.y, 1);
  EXPECT_NEAR(half.z, 0.2f, 1e-6f);
  EXPECT_EQ(half.w, 0.25f);
}

}  // namespace
}  // namespace limpid
