// Notes on a run before it begins.
#pragma once

#include <string>
#include <vector>

#include "core/tick/parameters.h"

namespace limpid {

// Returns sentences on settings that do nothing, or that a law's promise was not tried with.
std::vector<std::string> notes_on(const Parameters& p);

}  // namespace limpid
