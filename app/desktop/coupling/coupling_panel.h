// Panel of the coupling: its law, its parameters, and whether it is passive.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/desktop/base/notices.h"
#include "app/plot/plot_frame.h"
#include "app/plot/trace_channels.h"
#include "app/run/analysis.h"
#include "app/run/rerun.h"

namespace limpid {

// Values of the present row that are about the coupling.
struct CouplingReading {
  double energy_total;  // E_c [J]
  double compensation;  // part of E_c for the device's own forces [J]
  EnergyAccount energy;
  bool chatters;
  std::vector<int> limited;  // joints whose motors are at their limit
  double reserve;            // of the energy ledger [J]
  double contact_governor;   // share let through, as the two below, 0 to 1
  double damping_governor;
  double torque_governor;
  double unsettled;    // ticks without a joint solution for contacts and motors at their limit
  double left_out;     // contacts of bodies for which there was no room
  double stood_still;  // ticks in which forces of bodies were not found
  double turned_less;  // ticks in which mechanisms turned as far as they may
  double error = 0;    // |x_E| in its unit
  std::string error_unit = "rad";
  double gap = 0;        // of the tips of device and proxy [m]
  double contact = 0;    // how hard the scene pushes on the proxy [N]
  bool carries = false;  // an object is on the magnet
  std::string warm{};    // which motor its warmth holds back, in words; empty: none
};

// Situation of the coupling. `analysis` is of these parameters; `real`: a device is in the arm's
// place, and its grip cannot be chosen; `broken`: passivity is broken on purpose; `everything`:
// else what a first hour needs.
struct CouplingSituation {
  const Analysis& analysis;
  const ArmDescription& arm;
  bool real = false;
  bool broken = false;
  bool everything = true;
};
// Draws the running loop's coupling into the open ImGui window, as the two below do.
void draw_coupling(Parameters& p, const CouplingSituation& now, const CouplingReading& reading,
                   const Act& act);
// Settings at a recording's first row, and keys of those that were changed while recording.
struct RecordedCoupling {
  const Parameters& began;
  std::vector<std::string> changed;
  std::span<const RunFigures> tried{};  // the recording and its re-runs; empty before the first one
};
// Draws the parameters for the next re-run of a recording; `live`: the loop's own.
void draw_coupling_of_rerun(Parameters& p, const RecordedCoupling& recording,
                            const Parameters& live, const CouplingSituation& now);
// Draws what a first hour needs of a row: how far device and proxy are apart, what is felt, and
// whether that is safe.
void draw_simple_reading(const CouplingReading& reading, const Parameters& p,
                         const CouplingSituation& now);
// Draws the rest of it, line by line as there is reason to: who gave energy, and limits of motors
// and solver.
void draw_simple_notes(const CouplingReading& reading, const Parameters& p);
// Draws energy and motors at a recording's row.
void draw_reading(const CouplingReading& reading, const Parameters& p, const Analysis& analysis);

}  // namespace limpid
