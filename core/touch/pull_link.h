// Pull on a body from outside: a spring and damper from a point of it to where the pull goes. Its
// stiffness grows with the body's mass; its force is at most 2.5 times the weight.
#pragma once

#include "core/touch/point_force.h"

namespace limpid {

struct PullLink : HeldForce {
  explicit PullLink(const BodyPull& from) : pull(from), a(from.body) {}

  BodyPull pull;
  int a, b = BodyContact::kStill;

  static constexpr bool kWakes = false;
  void prepare(Bodies& bodies);
  static double made(const Bodies&) { return 0; }  // what it gives comes from outside
  // Energy that it gives over the tick [J].
  double work(const Bodies& bodies) const {
    return bodies.T * force.on_a.dot(bodies.velocity(force.end_a));
  }
};

}  // namespace limpid
