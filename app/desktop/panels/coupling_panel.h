// The coupling: its law, its parameters, and whether it is passive.
#pragma once

#include "app/plot/plot_frame.h"
#include "app/run/analysis.h"
#include "core/tick/parameters.h"

namespace limpid {

// What the present row says of it.
struct CouplingReading {
  double energy;            // given by the controller in all [J]
  double reserve;           // of the ledger [J]
  double contact_governor;  // shares let through, 0 to 1
  double damping_governor;
};

// `analysis` of these parameters.
void draw_coupling_panel(Parameters& p, const Analysis& analysis, const CouplingReading& now,
                         ScreenRect rect);

}  // namespace limpid
