// The bar below: recording, playback, and what the plots show.
#pragma once

#include <optional>

#include "app/desktop/base/notices.h"
#include "app/desktop/live/live_session.h"
#include "app/desktop/playback/playback.h"

namespace limpid {

// `tick` of the loop [s]; `plot_length` of the live plots [s], which can be chosen here. Returns
// which mark of the recording is to be changed, if one was clicked for that.
std::optional<std::size_t> draw_transport(Playback& playback, LiveSession& live, double tick,
                                          double& plot_length, const Act& act, ScreenRect rect);

}  // namespace limpid
