// What the two runs of a twin have in common, and what tells them apart.
#pragma once

#include <array>
#include <string>

#include "core/tick/parameters.h"

namespace limpid {

// Gives the twin all that it has not of its own: it has ControllerSettings.
void share_world(const Parameters& first, Parameters& twin);
// What the two are called: by what they differ in.
std::array<std::string, 2> twin_names(const Parameters& first, const Parameters& twin);

}  // namespace limpid
