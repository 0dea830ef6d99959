// The plots of what is on screen, side by side.
#pragma once

#include "app/desktop/base/stage.h"
#include "app/plot/plot_menu.h"
#include "app/session/player.h"

namespace limpid {

// `player` of the recording that is shown; null: the loop is.
void draw_plots(Stage& stage, Player* player, const PlotSaving& saving, ScreenRect rect);

}  // namespace limpid
