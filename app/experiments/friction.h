// Rough walls, and what their friction does from tick to tick.
#pragma once

#include <vector>

#include "app/experiments/experiment.h"
#include "app/experiments/signals.h"

namespace limpid {

// A flat wall, an edge of two walls or a corner of three. They meet at kMeet: above, to the right
// of and in front of the tip.
struct RoughWalls {
  int walls = 1;
  double stiffness = 1000;                           // [N/m]
  double friction_static = 0, friction_kinetic = 0;  // [-]
};
inline const Vec3 kMeet(0.2, 0, -0.04);  // [m]
inline const Vec3 kOutward[] = {Vec3::UnitZ(), -Vec3::UnitY(), -Vec3::UnitX()};

Trial rubbing(const ArmDescription& arm, const std::string& name, const RoughWalls& walls,
              HandPath hand, const Parameters& p);

// A contact over a tick.
struct Rub {
  double normal = 0;             // the wall's force [N]
  Vec3 friction = Vec3::Zero();  // [N]
  Vec3 moved = Vec3::Zero();     // motion of the tip along the wall [m]
};

// For every tick but the last, the contact with each wall; zero without contact.
std::vector<std::vector<Rub>> rubs_of(const Trial& trial, const RoughWalls& walls,
                                      const Session& session);

// Energy that friction gave over the tick `now`: its work and the change of its spring's energy
// since the tick `before` [J].
double given_by_friction(const RoughWalls& walls, const Rub& before, const Rub& now);

// Slip of the tip over the wall during `now`: its motion less that of the friction's spring [m].
double slipped(const RoughWalls& walls, const Rub& before, const Rub& now);

}  // namespace limpid
