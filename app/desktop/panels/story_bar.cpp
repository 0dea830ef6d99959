#include "app/desktop/panels/story_bar.h"

#include <imgui.h>

#include "app/style/theme.h"
#include "app/style/tooltip.h"

namespace limpid {

bool story_asked_for(const Playback& playback, const Settings& settings, ScreenRect view,
                     bool hinted) {
  if (settings.hint_seen || playback.on() || playback.loading()) return false;
  // Above the hint's lines, or the tab that folds the plots.
  const float above = (hinted ? 8 : 1.5f) * font(Face::semibold)->FontSize;
  ImGui::SetNextWindowPos({(view.min.x + view.max.x) / 2, view.max.y - above}, ImGuiCond_Always,
                          {0.5f, 1});
  ImGui::Begin("story", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoFocusOnAppearing |
                   ImGuiWindowFlags_NoNav);
  const bool asked = ImGui::Button("Show me (47 s)");
  tooltip(
      "Plays a story: two couplings in one hand. Drag in the picture, or Backspace, to take "
      "over at any moment.");
  ImGui::End();
  return asked;
}

bool story_taken_over(const Playback& playback, ScreenRect view) {
  if (!playback.on() || playback.shown()->step() == nullptr) return false;
  const ImGuiIO& io = ImGui::GetIO();
  return ImGui::IsMouseClicked(ImGuiMouseButton_Left) && !io.WantCaptureMouse && !io.KeyAlt &&
         view.contains(io.MousePos);
}

}  // namespace limpid
