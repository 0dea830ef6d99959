// Right motions of bodies: closed forms, and an integration of Euler's equations and of impacts.
#pragma once

#include <array>

#include "core/math/sizes.h"

namespace limpid {

inline constexpr double kStandardGravity = 9.81;  // [m/s^2]

// Principal moments of solids about their centres [kg m^2], along x, y and z; cylinder and capsule
// lie along z. `length` of a capsule is that between the centres of its half balls [m].
Vec3 ball_moments(double mass, double radius);
Vec3 box_moments(double mass, const Vec3& size);
Vec3 cylinder_moments(double mass, double radius, double length);
Vec3 capsule_moments(double mass, double radius, double length);

// Accelerations down a slope [m/s^2]: of a block under Coulomb's friction, and of a round body that
// rolls without slipping, with moment I about its axis. Slopes in [rad].
double sliding(double slope, double friction);
double rolling(double slope, double mass, double radius, double I);
// Slope from which on a block tips over its lower edge [rad].
double tipping(double width, double height);

// Period of a pendulum [s], by the complete elliptic integral. I: about the pivot [kg m^2].
double pendulum_period(double mass, double to_center, double I, double amplitude);

// Rate at which the axis of a top goes round where the axis is level [rad/s].
double precession(double mass, double to_center, double I, double spin);

// Way of a mass that a damper alone brakes [m], and of one at rest that a spring draws towards
// `rest` against a damper so strong that it does not swing [m].
double braked_way(double mass, double damping, double speed, double time);
double drawn_way(double mass, double damping, double stiffness, double rest, double time);

// Angular velocity of a free body, along its own principal axes with moments I, by the classical
// Runge-Kutta method in steps of `step` [s].
class FreeSpin {
 public:
  FreeSpin(const Vec3& I, const Vec3& spin, double step) : I_(I), w_(spin), step_(step) {}
  // Goes on until the spin about the first axis changes its sign for the n-th time from now, at
  // most for `longest` [s]. Returns the time from the start [s]; NaN if there is none.
  double turned_over(int n, double longest);
  const Vec3& spin() const { return w_; }

 private:
  Vec3 change(const Vec3& w) const;
  Vec3 I_, w_;
  double step_, time_ = 0;
};

// Two balls on a line before a wall on the right of both, all with the same restitution.
struct BallsAndWall {
  std::array<double, 2> mass{}, speed{};  // left and right [kg, m/s]
  double restitution = 1;

  // Impact of both, where the left one is faster.
  void meet();
  // All impacts until none follows.
  void meet_to_the_end();
  double energy() const;    // [J]
  double momentum() const;  // [N s]
};

}  // namespace limpid
