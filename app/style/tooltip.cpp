#include "app/style/tooltip.h"

#include <imgui_internal.h>

#include <algorithm>

namespace limpid {
namespace {

constexpr float kWidth = 26;          // [text sizes]
constexpr float kNarrowPanel = 0.5f;  // of the window's width

struct Place {
  ImVec2 at, pivot;
};

Place place_of(const ImRect& item, const ImRect& panel, ImVec2 window) {
  const float gap = 0.5f * ImGui::GetFontSize();
  const bool low = item.GetCenter().y > 0.5f * window.y;
  const bool right = item.GetCenter().x > 0.5f * window.x;
  if (panel.GetWidth() <= kNarrowPanel * window.x) {
    return {{right ? panel.Min.x - gap : panel.Max.x + gap, low ? item.Max.y : item.Min.y},
            {right ? 1.0f : 0.0f, low ? 1.0f : 0.0f}};
  }
  return {{right ? item.Max.x : item.Min.x, low ? item.Min.y - gap : item.Max.y + gap},
          {right ? 1.0f : 0.0f, low ? 1.0f : 0.0f}};
}

}  // namespace

void begin_tooltip(ImVec2 from, ImVec2 to) {
  const ImGuiWindow* window = ImGui::GetCurrentWindow();
  const ImRect panel = window->RootWindow != nullptr ? window->RootWindow->Rect() : window->Rect();
  const ImVec2 size = ImGui::GetMainViewport()->Size;
  const Place place = place_of(ImRect(from, to), panel, size);
  ImGui::SetNextWindowPos(place.at, ImGuiCond_Always, place.pivot);
  ImGui::BeginTooltip();
  const float room = place.pivot.x > 0 ? place.at.x : size.x - place.at.x;
  ImGui::PushTextWrapPos(
      std::min(kWidth * ImGui::GetFontSize(), room - 3 * ImGui::GetStyle().WindowPadding.x));
}

void end_tooltip() {
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

void tooltip(const char* text) {
  if (!ImGui::IsItemHovered()) return;
  begin_tooltip(ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  ImGui::TextUnformatted(text);
  end_tooltip();
}

}  // namespace limpid
