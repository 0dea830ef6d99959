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
  double restitution = 0;                      // [-]
  double parting = 0;                          // speed to part with [m/s]
  Vec3 now = Vec3::Zero();                     // the point after the tick [m]
  Mat3 frame, W;                               // columns: normal, two tangents; W in the frame

  static constexpr bool kWakes = false;
  bool off() const { return false; }
  void prepare(Bodies& bodies);
  double solve(Bodies& bodies);
  Vec3 forces() const { return {force, friction.x(), friction.y()}; }
  void add(Bodies& bodies, const Vec3& more);
  void hold(const Bodies& bodies);
  double made(const Bodies& bodies) const;
  void finish(Bodies& bodies);
  // After the bodies' motion: true if they now part after an impact, with restitution times the
  // speed that they have. part() gives an impulse to this end, in the presence of others; returns
  // the change of speed [m/s].
  bool turns(const Bodies& bodies);
  double part(Bodies& bodies) const;
  static double energy(const BodyContact& contact, const Bodies& bodies);

 private:
  void fade(const Bodies& bodies);
  double apart(const Bodies& bodies) const;  // speed of parting after the tick [m/s]
  double mass(const Bodies& bodies) const;   // that the contact moves [kg]
};

}  // namespace limpid
