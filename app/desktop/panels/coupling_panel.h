// The coupling: its law, its parameters, and whether it is passive.
#pragma once

#include <vector>

#include "app/desktop/panels/passivity_break.h"
#include "app/plot/plot_frame.h"
#include "app/run/analysis.h"
#include "app/session/energy_account.h"

namespace limpid {

// What the present row says of it.
struct CouplingReading {
  EnergyAccount energy;
  std::vector<int> limited;  // joints whose motors are at their limit
  double reserve;            // of the ledger [J]
  double contact_governor;   // shares let through, 0 to 1
  double damping_governor;
};

class CouplingPanel {
 public:
  // Draws into the ImGui window that is open. `analysis` of these parameters; `real`: a device is
  // in the arm's place, whose grip is nobody's to choose.
  void draw(Parameters& p, const Analysis& analysis, const CouplingReading& now,
            const ArmDescription& arm, bool real);

 private:
  void draw_break(Parameters& p, const ArmDescription& arm);

  PassivityBreak break_;
};

}  // namespace limpid
