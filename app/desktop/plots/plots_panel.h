// Panel of plots side by side.
#pragma once

#include <optional>
#include <string>

#include "app/desktop/playback/player.h"
#include "app/plot/plot_menu.h"
#include "app/stage/stage.h"

namespace limpid {

// Requests made in the panel that the plots do not carry out themselves.
struct PlotsRequest {
  PlotWish wish = PlotWish::none;  // choose, add, remove
  std::size_t plot = 0;
  std::string dropped = {};  // key of a channel that the plot is to show as well
};

// Draws the plots. `player` of the recording that is shown; null: the loop is shown.
PlotsRequest draw_plots(Stage& stage, Player* player, const PlotSaving& saving, ScreenRect rect);

}  // namespace limpid
