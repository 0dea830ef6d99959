// Settings that the two runs of a twin share, and names by those that differ.
#pragma once

#include <array>
#include <string>

#include "core/tick/parameters.h"

namespace limpid {

// Copies to the twin all settings but its own ControllerSettings.
void share_world(const Parameters& first, Parameters& twin);
// Names the two runs by what they differ in.
std::array<std::string, 2> twin_names(const Parameters& first, const Parameters& twin);

}  // namespace limpid
