#include "app/desktop/panels/loading_bar.h"

#include <fmt/format.h>
#include <imgui.h>

#include "app/desktop/widgets/widgets.h"

namespace limpid {

void draw_loading(SceneLoader& loader, ScreenRect view) {
  if (!loader.busy()) return;
  const float em = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({(view.min.x + view.max.x) / 2, view.max.y - em}, ImGuiCond_Always,
                          {0.5f, 1});
  ImGui::Begin("loading", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
  std::string text = loader.what();
  const double left = loader.seconds_left();
  if (loader.part() >= 1) {
    text += ", making it touchable";
  } else if (left >= 1) {
    text += fmt::format(", {:.0f} s left", left);
  }
  if (loader.waiting() > 0) text += fmt::format(", {} more after it", loader.waiting());
  ImGui::TextUnformatted(text.c_str());
  progress_bar(loader.part(), 22 * em);
  ImGui::SameLine();
  if (ImGui::Button("Cancel")) loader.cancel();
  ImGui::End();
}

}  // namespace limpid
