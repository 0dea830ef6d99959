// Panel of the grip: a button that measures it, what was found, and what follows for the laws.
#pragma once

#include "app/live/grip_meter.h"

namespace limpid {

// Draws into the open ImGui window. `p` takes the grip's values as the hand's where somebody asks
// for it.
void draw_grip(GripMeter& meter, const ArmDescription& arm, const Scene& scene, Parameters& p);

}  // namespace limpid
