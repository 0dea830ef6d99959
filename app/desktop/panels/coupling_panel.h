// The coupling: its law, its parameters, and whether it is passive.
#pragma once

#include <vector>

#include "app/desktop/base/notices.h"
#include "app/plot/plot_frame.h"
#include "app/plot/trace_channels.h"
#include "app/run/analysis.h"

namespace limpid {

// What the present row says of it.
struct CouplingReading {
  double energy_total;  // E_c [J]
  double compensation;  // of it for the device's own forces [J]
  EnergyAccount energy;
  bool chatters;
  std::vector<int> limited;  // joints whose motors are at their limit
  double reserve;            // of the ledger [J]
  double contact_governor;   // shares let through, 0 to 1
  double damping_governor;
  double torque_governor;
  double unsettled;  // ticks without a solution for motors at their limit and contacts together
  double left_out;   // points at which bodies meet that there is no room for
};

// Both draw into the ImGui window that is open.

// Of the loop that runs. `analysis` of these parameters; `real`: a device is in the arm's place,
// whose grip is nobody's to choose; `broken`: its passivity is, on purpose.
struct CouplingSituation {
  const Analysis& analysis;
  const ArmDescription& arm;
  bool real = false;
  bool broken = false;
};
void draw_coupling(Parameters& p, const CouplingSituation& now, const CouplingReading& reading,
                   const Act& act);
// What the next re-run of a recording is to have.
void draw_coupling_of_rerun(Parameters& p, const CouplingSituation& now);
// What a recording says of energy and motors at the row that is shown.
void draw_reading(const CouplingReading& reading, const Parameters& p, const Analysis& analysis);

}  // namespace limpid
