// Rows of parameters.
#pragma once

#include <initializer_list>

#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"

namespace limpid {

// Draws parameters below each other. A value that is left to the arm is shown as the arm's until it
// is moved. Parameters that need another loop are left out.
void draw_parameters(Parameters& p, const ArmDescription& arm,
                     std::initializer_list<const char*> keys);

}  // namespace limpid
