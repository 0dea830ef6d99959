// Pull on a body from outside: a spring and damper from a point of it to where the pull goes. Its
// stiffness grows with the body's mass; its force is at most 7.6 times the weight, so that it opens
// a latch.
#pragma once

#include <algorithm>

#include "core/touch/point_force.h"

namespace limpid {

struct PullLink : HeldForce {
  explicit PullLink(const BodyPull& from) : pull(from), a(from.body) {}

  BodyPull pull;
  int a, b = BodyContact::kStill;

  static constexpr bool kWakes = false;
  static constexpr double kSwing = 25;      // frequency of the spring, critically damped [rad/s]
  static constexpr double kLongest = 0.12;  // distance beyond which the pull grows no more [m]

  // Returns the force on a body of this mass that stands still, `away` from the target [N].
  static double force_of(double mass, double away) {
    return mass * kSwing * kSwing * std::min(away, kLongest);
  }

  void prepare(Bodies& bodies);
  static double made(const Bodies&) { return 0; }  // what it gives comes from outside
  // Energy that it gives over the tick [J].
  double work(const Bodies& bodies) const {
    return bodies.T * force.on_a.dot(bodies.velocity(force.end_a));
  }
};

}  // namespace limpid
