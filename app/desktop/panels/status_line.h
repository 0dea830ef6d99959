// What is going on, at the right-hand end of the menu bar.
#pragma once

#include <string>

#include "app/live/live_loop.h"

namespace limpid {

// The coupling that is on screen.
struct StatusLaw {
  CouplingKind kind;
  double eta;
};

// Activity of the window: the name of the recording that is shown, empty for the loop; how a
// virtual arm's time goes, empty as usual; and whether a program leads the window.
struct StatusGoing {
  std::string played, pace;
  bool led = false;
};

// As much as there is room for; the force is the last to go.
void draw_status(const LiveLoop& loop, const StatusLaw& law, const StatusGoing& going);
// Of the force alone [px].
float least_status_width(const LiveLoop& loop);

}  // namespace limpid
