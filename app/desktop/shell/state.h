// State of the window, for programs on the control socket and scripts that drive it.
#pragma once

#include <nlohmann/json.hpp>

#include "app/desktop/shell/desktop.h"
#include "app/desktop/shell/window.h"

namespace limpid {

// State that programs are sent: the loop's, the scene's and what the window does.
nlohmann::json state_of(const Desktop& desktop);

// Part of the state that only the window knows.
struct WindowState {
  int width, height;
  long frames;       // drawn so far
  bool input_waits;  // some input is not in these frames
  InputTaken taken;
};

// Prints that state as one line of JSON on stdout, with what is shown, and where on the screen.
void print_state(Desktop& desktop, const WindowState& window);

}  // namespace limpid
