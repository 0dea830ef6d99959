#include "app/desktop/panels/plots_panel.h"

#include "app/desktop/widgets/widgets.h"

namespace limpid {

void draw_plots(Stage& stage, Player* player, const PlotSaving& saving, ScreenRect rect) {
  begin_panel("plots", rect);
  stage.group.begin_frame(stage.history,
                          player != nullptr ? std::optional(player->time()) : std::nullopt);
  const auto count = static_cast<float>(stage.plots.size());
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const ImVec2 size((room.x - gap * (count - 1)) / count, room.y);
  for (std::size_t i = 0; i < stage.plots.size(); ++i) {
    if (i > 0) ImGui::SameLine();
    const PlotEvents events = stage.plots[i].draw(stage.history, stage.group, size, saving);
    if (events.playback && player != nullptr) player->seek(*events.playback);
  }
  ImGui::End();
}

}  // namespace limpid
