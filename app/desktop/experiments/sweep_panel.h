// Map of a sweep over the window: choice of axes, values under the mouse, and points to run again.
#pragma once

#include <cstdint>
#include <optional>

#include "app/desktop/experiments/sweep_controller.h"

namespace limpid {

// Point to be played.
struct MapRequest {
  std::optional<std::uint64_t> point;
  std::optional<double> at;  // value on the boundary's axis
};
// Draws the map while `open`, which closing it clears. Returns the point to be played, if one was
// clicked.
MapRequest draw_sweep_panel(SweepController& controller, Playback& playback, bool& open);

}  // namespace limpid
