// Notes on a run before it begins.
#pragma once

#include <string>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"

namespace limpid {

// Returns sentences on settings that do nothing, that a law's promise was not tried with, or that
// do not suit the arm.
std::vector<std::string> notes_on(const ArmDescription& arm, const Parameters& p);
// Says which joint the coupling's spring is too weak for; empty: none.
std::string weak_spring_text(const ArmDescription& arm, const Parameters& p);

}  // namespace limpid
