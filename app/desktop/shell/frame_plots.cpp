// The row of plots, and what is asked for there.
#include "app/desktop/panels/plots_panel.h"
#include "app/desktop/shell/frame.h"

namespace limpid {

void Frame::draw_plot_row(ScreenRect rect) {
  const PlotSaving saving{
      .folder = sessions_dir(),
      .save_png =
          [this](const ScreenRect& box, const std::filesystem::path& file) {
            window_.save_picture(file, box.min.x, box.min.y, box.max.x, box.max.y);
          },
      .beside =
          [this](std::function<PlotNotice()> work) { desktop_.live.save_beside(std::move(work)); },
      .arranged = true};
  PlayedSession* session = desktop_.playback.shown();
  const PlotsWish asked = draw_plots(
      desktop_.shown.stage(), session != nullptr ? &session->player() : nullptr, saving, rect);
  if (asked.wish == PlotWish::add) desktop_.plots.add();
  if (asked.wish == PlotWish::choose) desktop_.plots.choose(asked.plot);
  if (asked.wish == PlotWish::remove) desktop_.plots.remove(asked.plot);
}

}  // namespace limpid
