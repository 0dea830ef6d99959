// Map of a sweep over the window: choice of axes, values under the mouse, and points to run again.
#pragma once

#include <cstdint>
#include <optional>

#include "app/desktop/experiments/sweep_controller.h"

namespace limpid {

// Point to be played, or the wish for another sweep.
struct MapRequest {
  std::optional<std::uint64_t> point = {};
  std::optional<double> at = {};  // value on the boundary's axis
  bool anew = false;
};
// Draws the map while `open`, which closing it clears. Returns what was clicked.
MapRequest draw_sweep_panel(SweepController& controller, Playback& playback, bool& open);

}  // namespace limpid
