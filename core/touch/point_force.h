// A force between points of two bodies, or of a body and the world.
#pragma once

#include <Eigen/LU>

#include "core/touch/bodies.h"

namespace limpid {

struct PointForce {
  Vec3 on_a = Vec3::Zero();  // [N]
  BodyEnd end_a, end_b;      // in the tick

  Vec3 speed(const Bodies& bodies) const {  // of the one point relative to the other [m/s]
    return bodies.velocity(end_a) - bodies.velocity(end_b);
  }
  Mat3 answer(const Bodies& bodies) const { return bodies.answer(end_a) + bodies.answer(end_b); }
  void apply(Bodies& bodies) const { bodies.apply(end_a, end_b, on_a); }
  double set(Bodies& bodies, const Vec3& force) {  // returns the change [N]
    const Vec3 change = force - on_a;
    on_a = force;
    bodies.apply(end_a, end_b, change);
    return change.norm();
  }
  void add(Bodies& bodies, const Vec3& more) {
    on_a += more;
    bodies.apply(end_a, end_b, more);
  }
  // Moves both ends to where these points of the bodies are in the middle of the tick [m].
  void turn(Bodies& bodies, const Vec3& at_a, const Vec3& at_b) {
    const auto lever = [&](const BodyEnd& end, const Vec3& at) {
      return bodies.moves(end.body) ? bodies[end.body].middle(at, bodies.T) : end.lever;
    };
    const BodyMotion::Lever to_a = lever(end_a, at_a), to_b = lever(end_b, at_b);
    bodies.apply(end_a, end_b, -on_a);
    end_a.lever = to_a;
    end_b.lever = to_b;
    apply(bodies);
  }
};

// A spring K and damper B that hold a point of one body at a point of the other, found with their
// own effect: the force is the one in the middle of the tick.
struct HeldPoint {
  double K = 0, B = 0;                         // [N/m, N s/m]
  Vec3 stretch = Vec3::Zero();                 // at the tick's start [m]
  Mat3 W = Mat3::Zero(), give = Mat3::Zero();  // give: force for a velocity of stretching

  double push(double T) const { return K * T / 2 + B; }  // force for a velocity, without its effect
  // `answer`: of the stretching's velocity to the force [m/(N s)].
  void yield(double T, const Mat3& answer) {
    W = answer;
    const double k = push(T);
    give = k * (Mat3::Identity() + k * W).inverse();
  }
  Vec3 force(double T, const Vec3& speed, const Vec3& before) const {
    return -give * (K / push(T) * stretch + speed - W * before);
  }
};

// A force that holds a point, as parts of joints and pulls have it.
struct HeldForce {
  PointForce force;
  HeldPoint point;  // in the tick

  static bool off() { return false; }
  double solve(Bodies& bodies) {
    return force.set(bodies, point.force(bodies.T, force.speed(bodies), force.on_a));
  }
  Vec3 forces() const { return force.on_a; }
  void add(Bodies& bodies, const Vec3& more) { force.add(bodies, more); }
  void hold(const Bodies&) { force.on_a.setZero(); }
  void finish(const Bodies&) {}
};

}  // namespace limpid
