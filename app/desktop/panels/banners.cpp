#include "app/desktop/panels/banners.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/desktop/widgets/modal.h"
#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

constexpr float kBeside = 26;  // room that a sentence needs beside the legend [em]

float buttons_width(const Banner& banner) {
  const ImGuiStyle& style = ImGui::GetStyle();
  float width = 0;
  for (const Banner::Button& button : banner.buttons) {
    width += style.ItemSpacing.x + 2 * style.FramePadding.x + ImGui::CalcTextSize(button.label).x;
  }
  return width;
}

// Text and buttons in one line, or the buttons below where there is no room.
void draw_contents(const Banner& banner, float room, const Act& act) {
  const Palette& colours = current_palette();
  const bool one_line = ImGui::CalcTextSize(banner.text.c_str()).x + buttons_width(banner) <= room;
  ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(colours.panel));
  if (one_line) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(banner.text.c_str());
  } else {
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + room);
    ImGui::TextUnformatted(banner.text.c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::PopStyleColor();
  bool first = !one_line;
  for (const Banner::Button& button : banner.buttons) {
    if (!std::exchange(first, false)) ImGui::SameLine();
    if (noted_button(button.label)) act(button.command);
  }
}

}  // namespace

ScreenRect draw_banners(std::span<const Banner> banners, ScreenRect view, ScreenRect signs,
                        const Act& act) {
  if (banners.empty()) return signs;
  const Palette& colours = current_palette();
  const float em = ImGui::GetFontSize(), pad = 0.5f * em;
  const bool beside = view.max.x - signs.max.x > kBeside * em;
  const float left = (beside ? signs.max.x : view.min.x) + pad, right = view.max.x - 2 * em;
  float y = (beside ? view.min.y : signs.max.y) + pad;
  for (const Banner& banner : banners) {
    ImGui::PushStyleColor(ImGuiCol_WindowBg,
                          colour_vector(banner.bad ? colours.broken : colours.accent));
    ImGui::SetNextWindowPos({std::round((left + right) / 2), y}, ImGuiCond_Always, {0.5f, 0});
    ImGui::Begin(banner.id, nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav |
                     ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::PopStyleColor();  // the theme is told by it
    draw_contents(banner, right - left - 2 * ImGui::GetStyle().WindowPadding.x, act);
    y += ImGui::GetWindowHeight() + 0.5f * pad;
    ImGui::End();
  }
  return {signs.min, {view.max.x, std::max(y, signs.max.y)}};
}

}  // namespace limpid
