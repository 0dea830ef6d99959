// Parameters below each other.
#pragma once

#include <initializer_list>

#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"

namespace limpid {

// What is left to the arm shows this arm's value, and stays the arm's until it is moved. Parameters
// that take effect with another loop only are left out.
void draw_parameters(Parameters& p, const ArmDescription& arm,
                     std::initializer_list<const char*> keys);

}  // namespace limpid
