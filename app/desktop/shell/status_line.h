// Status line at the right-hand end of the menu bar.
#pragma once

#include <string>

#include "app/live/live_loop.h"

namespace limpid {

// Coupling on screen.
struct StatusLaw {
  CouplingKind kind;
  double eta;
};

// Activity of the window: name of the recording shown, empty for the loop; pace of the virtual
// arm's time, empty as usual; and whether a program leads the window.
struct StatusGoing {
  std::string played, pace;
  bool led = false;
};

// Draws as much as there is room for; the force is left out last.
void draw_status(const LiveLoop& loop, const StatusLaw& law, const StatusGoing& going);
// Returns the width of the force alone [px].
float least_status_width(const LiveLoop& loop);

}  // namespace limpid
