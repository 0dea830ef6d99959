// What the stretch of time selected in a plot amounts to, and what can be done with it.
#pragma once

#include <vector>

#include "app/desktop/base/stage.h"
#include "app/desktop/playback/player.h"
#include "app/plot/plot_menu.h"
#include "app/plot/range_figures.h"

namespace limpid {

class RangePanel {
 public:
  // At the bottom of the view above the plots, while a stretch is selected. `player` as
  // draw_plots() has it.
  void draw(Stage& stage, Player* player, const PlotSaving& saving, ScreenRect view);

 private:
  struct Line {
    std::size_t curve;
    RangeFigures figures;
  };
  void reckon(const Plot& plot, const History& history, const PlotRange& range);

  // Of which stretch, and of which rows and curves, the lines are.
  PlotRange known_{};
  SampleIndex first_ = 0, end_ = 0;
  std::vector<int> channels_;
  std::vector<Line> lines_;
};

}  // namespace limpid
