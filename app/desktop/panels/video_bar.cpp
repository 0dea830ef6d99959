#include "app/desktop/panels/video_bar.h"

#include <imgui.h>

#include "app/desktop/widgets/widgets.h"

namespace limpid {

void draw_video_bar(Playback& playback, ScreenRect view) {
  if (!playback.video().busy()) return;
  const float em = ImGui::GetFontSize();
  const float below_names = 2.6f * em;  // of a twin's runs
  ImGui::SetNextWindowPos({view.max.x - em, view.min.y + below_names}, ImGuiCond_Always, {1, 0});
  ImGui::Begin("video", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
  ImGui::TextUnformatted(playback.video().what().c_str());
  progress_bar(playback.video().part(), 14 * em);
  ImGui::SameLine();
  if (ImGui::Button("Cancel")) playback.cancel_video();
  ImGui::End();
}

}  // namespace limpid
