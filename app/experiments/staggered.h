// The usual way to couple a body to a device, for comparison: the force of a tick follows from the
// last positions of device and body. The body is stepped after it (semi-implicit Euler).
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "app/experiments/moving.h"
#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"
#include "devices/files/session/hand_file.h"

namespace limpid {

// A point mass tied to the tip by a spring and damper F = K x + B dx/dt, with x and dx/dt of the
// last two ticks.
struct StaggeredBody {
  double mass = 0.05;       // [kg]
  double stiffness = 2000;  // K [N/m]
  double damping = 0;       // B [N s/m]
  // Unit normal of the body's surface: the tip only pushes the body, which only moves along it.
  // None: the spring holds the body, which moves anywhere.
  std::optional<Vec3> normal = {};
  double gap = 0;  // between tip and surface at the start [m]
  // Further force on the body along the normal [N], over its travel against the normal [m].
  std::function<double(double travel)> own = {};
  // Lower end of the travel against the normal, where the body stops without bouncing [m].
  double least_travel = -std::numeric_limits<double>::infinity();
};

struct StaggeredRun {
  TipRecord record;
  std::vector<double> travel;   // of the body against its normal, at each tick [m]
  std::vector<double> contact;  // of the tip on the body along its normal, over each tick [N]
  std::vector<double> speed;    // of the body at each tick [m/s]
  std::vector<double>
      beyond;  // energy given to the human beyond what the body gave, up to each tick [J]
  bool diverged = false;  // from the last of these ticks on

  double most_beyond() const;  // highest `beyond`; infinite if it diverged [J]
};

// Runs an arm of three joints with its own damping, without any coupling: motors push with J^T F.
// Hand and limits come from `p`.
StaggeredRun run_staggered(const ArmDescription& arm, const Parameters& p, const HandPath& hand,
                           const StaggeredBody& body);

// Least mass for which the staggered coupling is stable with the device at rest, by Jury's
// criterion for the characteristic polynomial: K T^2/4 + B T/2 [kg].
inline double least_staggered_mass(double K, double B, double T) {
  return K * T * T / 4 + B * T / 2;
}

}  // namespace limpid
