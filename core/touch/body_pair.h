// Contact of a body with another one or with a fixed object: a spring that pushes, and friction.
#pragma once

#include "core/touch/bodies.h"
#include "core/touch/wall_force.h"

namespace limpid {

struct BodyPair {
  explicit BodyPair(BodyContact& at) : contact(&at), a(at.a), b(at.b) {}

  BodyContact* contact;
  int a, b;
  double force = 0;                            // along the normal, on a [N]
  Vec2 friction = Vec2::Zero();                // along the tangents, on a [N]
  Vec2 anchor = Vec2::Zero();                  // stretch of friction's spring [m]
  BodyEnd end_a, end_b;                        // in the tick, as all below
  double K = 0, B = 0, depth = 0, radius = 0;  // radius: of friction's disc, over the force [-]
  Mat3 frame, W;                               // columns: normal, two tangents; W in the frame

  static constexpr bool kWakes = false;
  bool off() const { return false; }
  void prepare(Bodies& bodies);
  double solve(Bodies& bodies);
  Vec3 forces() const { return {force, friction.x(), friction.y()}; }
  void add(Bodies& bodies, const Vec3& more);
  void hold(const Bodies& bodies);
  void finish(const Bodies& bodies);
  static double energy(const BodyContact& contact, const Bodies& bodies);
};

}  // namespace limpid
