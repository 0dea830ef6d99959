// The plots of what is on screen, side by side.
#pragma once

#include <optional>

#include "app/desktop/base/stage.h"
#include "app/desktop/playback/player.h"
#include "app/plot/plot_menu.h"

namespace limpid {

// What was asked for in the panel, beyond what plots do themselves.
struct PlotsRequest {
  PlotWish wish = PlotWish::none;  // choose, add, remove
  std::size_t plot = 0;
};

// `player` of the recording that is shown; null: the loop is.
PlotsRequest draw_plots(Stage& stage, Player* player, const PlotSaving& saving, ScreenRect rect);

}  // namespace limpid
