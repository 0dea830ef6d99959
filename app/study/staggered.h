// The usual way to couple a body to a device, to compare: the force of a tick follows from where
// device and body last were, and the body is stepped after it (semi-implicit Euler).
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "app/study/moving.h"
#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"
#include "devices/files/session/hand_file.h"

namespace limpid {

// A point of mass `mass`, tied to the tip by a spring and damper F = K x + B dx/dt with x and dx/dt
// of the last two ticks.
struct StaggeredBody {
  double mass = 0.05;       // [kg]
  double stiffness = 2000;  // K [N/m]
  double damping = 0;       // B [N s/m]
  // Unit, out of its surface: the tip then only pushes it, and it only moves along this. None: the
  // spring holds it, and it moves anywhere.
  std::optional<Vec3> normal = {};
  double gap = 0;  // between tip and surface at the start [m]
  // What else acts on it along the normal, of how far it has moved against that [N, m].
  std::function<double(double travel)> own = {};
  // How far it can move against the normal; it stops there without bouncing [m].
  double least_travel = -std::numeric_limits<double>::infinity();
};

struct StaggeredRun {
  TipRecord record;
  std::vector<double> travel;   // of the body against its normal, at each tick [m]
  std::vector<double> contact;  // of the tip on the body along its normal, over each tick [N]
  std::vector<double> speed;    // of the body at each tick [m/s]
  std::vector<double> beyond;   // given to the human beyond what the body gave, up to each [J]
  bool diverged = false;        // from the last of these ticks on

  double most_beyond() const;  // infinite where it diverged [J]
};

// The arm of three joints with its own damping, in the hand and under the limits of `p`, without
// any coupling: motors push with J^T F.
StaggeredRun run_staggered(const ArmDescription& arm, const Parameters& p, const HandPath& hand,
                           const StaggeredBody& body);

// The least mass with which this way is stable while the device stands still, by Jury's criterion
// for its characteristic polynomial: K T^2/4 + B T/2 [kg].
inline double least_staggered_mass(double K, double B, double T) {
  return K * T * T / 4 + B * T / 2;
}

}  // namespace limpid
