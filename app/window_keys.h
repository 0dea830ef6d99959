// The window's keys, for the manual.
#pragma once

#include <vector>

#include "app/cli/manual_page.h"

namespace limpid {

// Returns the keys of the window, as on a US keyboard.
std::vector<ManualKey> keys_of_window();

}  // namespace limpid
