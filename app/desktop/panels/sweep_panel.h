// The map of a sweep over the window: what of it is shown, its values under the mouse, and its
// points, to be run again.
#pragma once

#include <cstdint>
#include <optional>

#include "app/desktop/live/sweep_controller.h"

namespace limpid {

// While `open`, which closing it clears. What is to be played.
struct MapRequest {
  std::optional<std::uint64_t> point;
  std::optional<double> at;  // of a boundary's axis
};
MapRequest draw_sweep_panel(SweepController& controller, Playback& playback, bool& open);

}  // namespace limpid
