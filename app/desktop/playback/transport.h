// Bar below the view: recording, playback, and the length of the plots.
#pragma once

#include <optional>

#include "app/desktop/base/notices.h"
#include "app/desktop/live/live_stage.h"
#include "app/desktop/playback/playback.h"

namespace limpid {

// Draws the bar. `tick` of the loop [s]; `plot_length` of the live plots [s], which can be chosen
// here. Returns the place of the recording's mark that was clicked for a change, if any.
std::optional<std::size_t> draw_transport(Playback& playback, LiveStage& live, double tick,
                                          double& plot_length, const Act& act, ScreenRect rect);

}  // namespace limpid
