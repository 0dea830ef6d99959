// A joint held by springs, and its response to forces along it or torques about it.
#pragma once

#include <array>
#include <cmath>
#include <span>

#include "core/touch/body_motion.h"
#include "core/touch/joint_forces.h"

namespace limpid {

// A side of the joint, in the middle of a tick.
struct JointSide {
  BodyMotion::Answer answer = BodyMotion::Answer::Zero();  // zero for a fixed side
  Vec3 lever = Vec3::Zero();                               // lever of a force along the joint [m]
  std::array<Vec3, 3> links{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  // levers of the springs
};

// A spring that holds the joint: its force is `stiffness` times the velocity of stretching [N s/m],
// in the directions that it holds.
struct JointHold {
  double stiffness = 0;
  Mat3 directions = Mat3::Identity();  // a projection
};

// A joint's force along it, or its torque about it, together with the springs that hold it.
struct JointAnswer {
  static constexpr int kMostHolds = 3;
  using Numbers = Eigen::Matrix<double, 3 * kMostHolds, 1>;  // three of each spring
  using Mat9 = Eigen::Matrix<double, 3 * kMostHolds, 3 * kMostHolds>;
  using Mat93 = Eigen::Matrix<double, 3 * kMostHolds, 3>;

  // Response of the sides' relative velocity to the force, or of their angular velocity to the
  // torque. The springs yield at once, with forces of -yield times it.
  Mat3 response = Mat3::Zero();
  Mat93 yield = Mat93::Zero();
  // Forces of the springs are -give times what is left of their velocities.
  Mat9 give = Mat9::Zero();
};
JointAnswer joint_answer(bool turns, const JointSide& a, const JointSide& b,
                         std::span<const JointHold> holds);

// Forces of a joint between two sides: damping and friction in a ball joint; all forces in a hinge
// or a slider whose other side moves as well.
struct HeldJoint {
  BodyJoint joint;
  JointPotential potential;

  // State from tick to tick. Hinge and slider:
  double place = 0;    // [m] or [rad]
  JointForces forces;  // [N] or [N m]
  // Ball:
  Vec3 friction = Vec3::Zero(), anchor = Vec3::Zero();  // [N m], [rad]
  // Either, in the world:
  Vec3 damping = Vec3::Zero();  // [N] or [N m]

  // State of the tick.
  Vec3 along = Vec3::Zero();       // axis, in the world
  Mat3 answer = Mat3::Zero();      // see joint_answer()
  Mat3 damped = Mat3::Identity();  // part of a force on it that damping leaves [-]
  bool turns_less = false;         // than its forces would have it: by kMostTurn

  bool ball() const { return joint.kind == BodyJoint::Kind::ball; }
  bool has_stops() const { return std::isfinite(joint.low) || std::isfinite(joint.high); }
  bool turns() const { return joint.kind != BodyJoint::Kind::slider; }
  Vec3 force() const { return damping + (ball() ? friction : Vec3(forces.sum() * along)); }
  double stored() const;  // [J]
  // True if the joint has forces besides those that hold it.
  static bool needed(const BodyJoint& joint);

  void start(const Mat3& now);
  // Updates the force for the sides' relative angular velocity or velocity `speed`. Returns its
  // change.
  double sweep(double T, const Vec3& speed);
  // Changes the forces by three numbers, along the joint or in the world. Returns the change of the
  // whole force.
  Vec3 add(const Vec3& change);
  Vec3 numbers() const;                            // of the forces
  double made(double T, const Vec3& speed) const;  // see made() of a joint
  bool presses() const { return ball() ? !friction.isZero(0) : forces.presses(); }
  // Begins a tick of T before any solve, with the sides' relative velocity or angular velocity at
  // its start and their theta.
  void meet(double T, const Vec3& rate, double theta) {
    forces.hit.begin(joint, place, along.dot(rate), theta, forces.stop, T);
  }
  // Ends a tick of T in which the sides moved with `speed`.
  void finish(double T, const Vec3& speed);
  // Holds the joint for a tick, with the friction of the last one.
  void hold();
  // Sets the place to the sides' own, which a tick's rotation misses by third order; unless it
  // would store more energy there. `sine`: of the angle from its place to theirs, or the distance.
  void follow(double sine);

  static constexpr std::size_t kNumbers = 14;
  std::array<double, kNumbers> kept() const;
  void read(const double* from);
};

}  // namespace limpid
