// Spring and damper with a length between points of two bodies, or of a body and the world.
#pragma once

#include <array>

#include "core/touch/point_force.h"

namespace limpid {

struct SpringLink {
  BodySpring spring;
  int a = 0, b = BodyContact::kStill;
  Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();  // in their objects' frames, or the world's [m]
  bool broken = false;
  PointForce force;
  Vec3 apart = Vec3::Zero();  // from b to a at the tick's start, in the tick as all below [m]
  Mat3 W = Mat3::Zero();      // response of the ends' velocity to the force [m/(N s)]

  static constexpr bool kWakes = true;
  bool off() const { return broken; }
  void prepare(Bodies& bodies);
  double solve(Bodies& bodies);
  // Takes the places of both ends by the spins found so far; returns by how much their way over the
  // tick changes [m].
  double turn(Bodies& bodies);
  Vec3 forces() const { return force.on_a; }
  void add(Bodies& bodies, const Vec3& more) { force.add(bodies, more); }
  void hold(const Bodies&) { force.on_a.setZero(); }
  double made(const Bodies& bodies) const;
  void finish(const Bodies& bodies);
  double energy(const Bodies& bodies) const;

  std::array<double, 4> numbers() const {
    return {force.on_a.x(), force.on_a.y(), force.on_a.z(), broken ? 1.0 : 0.0};
  }
  void read(const double* from) {
    force.on_a = Eigen::Map<const Vec3>(from);
    broken = from[3] != 0;
  }

 private:
  struct Pull {
    Vec3 force = Vec3::Zero();
    Mat3 slope = Mat3::Zero();  // by the velocity, where it is not negative [N s/m]
  };
  Pull pull(const Vec3& speed, double T) const;
};

}  // namespace limpid
