#include "app/desktop/widgets/panel_edges.h"

#include <imgui_internal.h>

#include <algorithm>

#include "app/style/palette.h"
#include "app/style/theme.h"
#include "app/style/tooltip.h"

namespace limpid {

void splitter(const char* name, ScreenRect rect, bool vertical, double direction, double& size,
              double least, double most) {
  ImGui::SetNextWindowPos(rect.min);
  ImGui::SetNextWindowSize(rect.size());
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoSavedSettings);
  ImGui::InvisibleButton("grip", rect.size());
  if (ImGui::IsItemActive() || ImGui::IsItemHovered()) {
    ImGui::SetMouseCursor(vertical ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
  }
  if (ImGui::IsItemActive()) {
    const ImVec2 delta = ImGui::GetIO().MouseDelta;
    size += direction * static_cast<double>((vertical ? delta.x : delta.y) / current_scale());
  }
  size = std::clamp(size, least, most);
  ImGui::End();
  ImGui::PopStyleVar(2);
}

void fold_tab(const char* name, ScreenRect rect, ImGuiDir arrow, const char* help, bool& wanted) {
  ImGui::SetNextWindowPos(rect.min);
  ImGui::SetNextWindowSize(rect.size());
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  if (ImGui::InvisibleButton("fold", rect.size())) wanted = !wanted;
  const bool over = ImGui::IsItemHovered();
  const Palette& colours = current_palette();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(rect.min, rect.max, colour(over ? colours.frame_active : colours.frame, 0.8f),
                     3 * current_scale());
  const float size = 0.6f * ImGui::GetFontSize();
  ImGui::RenderArrow(
      &list, {(rect.min.x + rect.max.x - size) / 2, (rect.min.y + rect.max.y - size) / 2},
      colour(over ? colours.text : colours.muted), arrow, size / ImGui::GetFontSize());
  tooltip(help);
  ImGui::End();
  ImGui::PopStyleVar(3);
}

}  // namespace limpid
