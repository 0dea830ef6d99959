// Pull on a body from outside: a spring and damper from a point of it to where the pull goes. Its
// stiffness grows with the body's mass; its force is at most 2.5 times the weight.
#pragma once

#include "core/touch/point_force.h"

namespace limpid {

struct PullLink {
  explicit PullLink(const BodyPull& from) : pull(from), a(from.body) {}

  BodyPull pull;
  int a, b = BodyContact::kStill;
  PointForce force;
  HeldPoint point;  // in the tick

  static constexpr bool kWakes = false;
  bool off() const { return false; }
  void prepare(Bodies& bodies);
  double solve(Bodies& bodies) {
    return force.set(bodies, point.force(bodies.T, force.speed(bodies), force.on_a));
  }
  Vec3 forces() const { return force.on_a; }
  void add(Bodies& bodies, const Vec3& more) { force.add(bodies, more); }
  void hold(const Bodies&) {}
  void finish(const Bodies&) {}
  // Energy that it gives over the tick [J].
  double work(const Bodies& bodies) const {
    return bodies.T * force.on_a.dot(bodies.velocity(force.end_a));
  }
};

}  // namespace limpid
