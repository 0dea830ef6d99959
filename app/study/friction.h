// Walls that rub, and what their friction does from tick to tick.
#pragma once

#include <vector>

#include "app/study/experiment.h"
#include "app/study/signals.h"

namespace limpid {

// One wall flat, two in an edge or three in a corner, meeting at kMeet: above, to the right of and
// in front of the tip.
struct RoughWalls {
  int walls = 1;
  double stiffness = 1000;                           // [N/m]
  double friction_static = 0, friction_kinetic = 0;  // [-]
};
inline const Vec3 kMeet(0.2, 0, -0.04);  // [m]
inline const Vec3 kOutward[] = {Vec3::UnitZ(), -Vec3::UnitY(), -Vec3::UnitX()};

Trial rubbing(const std::string& name, const RoughWalls& walls, HandPath hand, const Parameters& p);

// One contact over a tick.
struct Rub {
  double normal = 0;             // the wall's force [N]
  Vec3 friction = Vec3::Zero();  // [N]
  Vec3 moved = Vec3::Zero();     // the tip, along the wall [m]
};

// Each wall's, at every tick but the last; nothing where it does not touch.
std::vector<std::vector<Rub>> rubs_of(const Trial& trial, const RoughWalls& walls,
                                      const Session& session);

// What friction gave over the tick that `now` is of: its work and the change of what its spring
// stores, `before` the tick before [J].
double given_by_friction(const RoughWalls& walls, const Rub& before, const Rub& now);

// How far the tip slipped over the wall in that tick: what it moved besides the spring [m].
double slipped(const RoughWalls& walls, const Rub& before, const Rub& now);

}  // namespace limpid
