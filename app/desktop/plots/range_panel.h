// Panel of the range selected in a plot: its figures, and commands for it.
#pragma once

#include <vector>

#include "app/desktop/playback/player.h"
#include "app/plot/plot_menu.h"
#include "app/plot/range_figures.h"
#include "app/stage/stage.h"

namespace limpid {

class RangePanel {
 public:
  // Draws at the bottom of the view above the plots, while a range is selected. `player` as in
  // draw_plots().
  void draw(Stage& stage, Player* player, const PlotSaving& saving, ScreenRect view);

 private:
  struct Line {
    std::size_t curve;
    RangeFigures figures;
  };
  void reckon(const Plot& plot, const History& history, const PlotRange& range);

  // Range, rows and curves that lines_ are of.
  PlotRange known_{};
  SampleIndex first_ = 0, end_ = 0;
  std::vector<int> channels_;
  std::vector<Line> lines_;
};

}  // namespace limpid
