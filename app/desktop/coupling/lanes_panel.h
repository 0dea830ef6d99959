// Panel of several runs on one hand: their numbers side by side, and which of them is edited.
#pragma once

#include <cstddef>
#include <span>

#include "app/desktop/base/notices.h"
#include "app/stage/stage.h"

namespace limpid {

// Draws into the open ImGui window. `rows`: newest rows of all runs. `edited`: the run that the
// sliders set; null: none can be chosen. Runs come and go by `act`.
void draw_lanes(const Stage& stage, LaneRows rows, std::size_t* edited, bool& overlaid,
                const Act& act);

}  // namespace limpid
