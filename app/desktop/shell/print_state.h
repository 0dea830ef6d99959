// The state of the window for scripts that drive it.
#pragma once

#include "app/desktop/shell/desktop.h"
#include "app/desktop/shell/window.h"

namespace limpid {

// What only the window knows.
struct WindowState {
  int width, height;
  long frames;       // drawn up to now
  bool input_waits;  // what was done is not all in them
  InputTaken taken;
};

// One line of JSON on stdout.
void print_state(Desktop& desktop, const WindowState& window);

}  // namespace limpid
