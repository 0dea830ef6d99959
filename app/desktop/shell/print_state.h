// The state of the window for scripts that drive it.
#pragma once

#include "app/desktop/shell/desktop.h"

namespace limpid {

// One line of JSON on stdout; the size is the window's.
void print_state(Desktop& desktop, int width, int height);

}  // namespace limpid
