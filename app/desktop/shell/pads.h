// The gamepads that are plugged in, as GLFW knows them.
#pragma once

#include <vector>

#include "app/desktop/desk/pad_hand.h"

namespace limpid {

// After input was collected; in the order of their slots. Joysticks whose buttons GLFW has no names
// for are none.
std::vector<Pad> plugged_pads();

}  // namespace limpid
