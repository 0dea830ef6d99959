#include "app/desktop/panels.h"
#include "app/style/theme.h"

namespace limpid {

void draw_plots(Workbench& bench, Window& window, const ScreenRect& rect) {
  begin_panel("plots", rect);
  Stage& stage = bench.shown();
  const bool recorded = bench.playing_back();
  stage.group.begin_frame(stage.history,
                          recorded ? std::optional(bench.playback->player.time()) : std::nullopt);
  const PlotSaving saving{
      .folder = sessions_dir(),
      .save_png = [&](const ScreenRect& box, const std::filesystem::path& file) {
        window.save_picture(file, box.min.x, box.min.y, box.max.x, box.max.y);
      }};
  const auto count = static_cast<float>(stage.plots.size());
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const ImVec2 size((room.x - gap * (count - 1)) / count, room.y);
  for (std::size_t i = 0; i < stage.plots.size(); ++i) {
    if (i > 0) ImGui::SameLine();
    const PlotEvents events = stage.plots[i].draw(stage.history, stage.group, size, saving);
    if (events.playback && recorded) bench.playback->player.seek(*events.playback);
  }
  ImGui::End();
}

}  // namespace limpid
