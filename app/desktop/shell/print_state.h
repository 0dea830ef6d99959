// State of the window for scripts that drive it.
#pragma once

#include "app/desktop/shell/desktop.h"
#include "app/desktop/shell/window.h"

namespace limpid {

// Part of the state that only the window knows.
struct WindowState {
  int width, height;
  long frames;       // drawn so far
  bool input_waits;  // some input is not in these frames
  InputTaken taken;
};

// Prints the state as one line of JSON on stdout.
void print_state(Desktop& desktop, const WindowState& window);

}  // namespace limpid
