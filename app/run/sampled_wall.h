// A wall before a tip along a line, as the loop samples it, in the hand: whether it is stable.
// Encoders are exact, and motors meet no limit.
#pragma once

#include <functional>

#include "core/coupling/spring_damper.h"

namespace limpid {

// Device and hand at the tip, along a line.
struct HeldTip {
  double mass = 0;       // of the device with the hand's [kg]
  double damping = 0;    // of both [N s/m]
  double stiffness = 0;  // of the hand [N/m]
  double T = 0.001;      // [s]
  int delay = 0;         // of the device's torque [ticks]
};

// Largest growth in a tick with a wall K [N/m] on the device itself: its force is held for a tick.
double growth_on_device(const HeldTip& tip, double K);
// The same with the wall before a proxy of mass M2 [kg] behind spring and damper, (1)-(2), in N/m
// and N s/m at the tip.
double growth_behind_spring(const HeldTip& tip, const SpringDamper& gains, double M2, double K);

// Stiffest walls that were reckoned, and growth that round-off makes.
inline constexpr double kStiffestReckoned = 1e6;  // [N/m]
inline constexpr double kStillStable = 1 + 1e-9;

// Stiffness up to which all walls are stable [N/m]; infinite if all are up to kStiffestReckoned, 0
// if none is. growth: of a wall.
double stable_up_to(const std::function<double(double)>& growth);

}  // namespace limpid
