// Forces along a joint with the world that is the body's only coordinate: springs, detents, tables,
// stops and friction.
#pragma once

#include <array>

#include "core/touch/bodies.h"
#include "core/touch/joint_forces.h"

namespace limpid {

struct WorldJoint {
  int a = 0;
  JointForces along;
  static constexpr int b = BodyContact::kStill;

  static constexpr bool kWakes = false;
  bool off() const { return false; }
  void prepare(Bodies& bodies);
  double solve(Bodies& bodies);
  Vec3 forces() const { return {along.potential, along.stop, along.friction}; }
  void add(Bodies& bodies, const Vec3& more);
  void hold(const Bodies& bodies) {
    along.potential = along.stop = along.hit.speed = 0;
    along.friction = -along.anchor * stiffness(bodies);
  }
  double made(const Bodies& bodies) const;
  void finish(Bodies& bodies);
  double energy(const Bodies& bodies) const;

  std::array<double, 4> numbers() const {
    return {along.potential, along.stop, along.friction, along.anchor};
  }
  void read(const double* from) { along = {from[0], from[1], from[2], from[3], {}}; }

 private:
  double stiffness(const Bodies& bodies) const { return bodies[a].of_joint().stop_stiffness; }
};

}  // namespace limpid
