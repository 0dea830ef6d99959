// A joint that springs hold, and how it answers what acts along it or about it.
#pragma once

#include <array>
#include <span>

#include "core/touch/body_motion.h"
#include "core/touch/joint_forces.h"

namespace limpid {

// One side of it, in the middle of a tick.
struct JointSide {
  BodyMotion::Answer answer = BodyMotion::Answer::Zero();  // of what stands still: none
  Vec3 lever = Vec3::Zero();                               // of a force along it [m]
  std::array<Vec3, 3> links{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  // levers of its springs
};

// One of the springs that hold it: its force is `stiffness` times the velocity that it is given
// [N s/m], in the directions that it holds.
struct JointHold {
  double stiffness = 0;
  Mat3 directions = Mat3::Identity();  // a projection
};

// What a torque about it, or a force along it, adds to the angular velocity or velocity of one side
// against the other, where the springs that hold it give way to that at once.
Mat3 joint_answer(bool turns, const JointSide& a, const JointSide& b,
                  std::span<const JointHold> holds);

// What damps and rubs in a ball joint, and all that acts in a hinge or a slider whose other half
// moves as well.
struct HeldJoint {
  BodyJoint joint;
  JointPotential potential;

  // From tick to tick. Of a hinge and a slider:
  double place = 0;    // [m] or [rad]
  JointForces forces;  // [N] or [N m]
  // Of a ball:
  Vec3 friction = Vec3::Zero(), anchor = Vec3::Zero();  // [N m], [rad]
  // Of either, in the world.
  Vec3 damping = Vec3::Zero();  // [N] or [N m]

  // Of the tick:
  Vec3 along = Vec3::Zero();       // its axis, in the world
  Mat3 answer = Mat3::Zero();      // see joint_answer()
  Mat3 damped = Mat3::Identity();  // what damping leaves of a force on it [-]

  bool ball() const { return joint.kind == BodyJoint::Kind::ball; }
  bool turns() const { return joint.kind != BodyJoint::Kind::slider; }
  Vec3 force() const { return damping + (ball() ? friction : Vec3(forces.sum() * along)); }
  double stored() const;  // [J]
  // Whether anything acts in a joint besides what holds it.
  static bool needed(const BodyJoint& joint);

  void start(const Mat3& now);
  // Its force anew, where one side moves against the other with this angular velocity or velocity.
  // Returns by how much it changed.
  double sweep(double T, const Vec3& speed);
  // As if its forces had changed by so much: three numbers, along it or in the world. Returns how
  // its whole force did.
  Vec3 add(const Vec3& change);
  std::array<double, 3> numbers() const;
  // The tick moved it like that.
  void finish(double T, const Vec3& speed);
  // It is held where it is, with the friction of the last tick.
  void hold();
  // Its place is that of its halves again, which a tick's own turning leaves by third order; but
  // not where it would store more there. `sine`: of the angle from its place to theirs, or how far.
  void follow(double sine);

  static constexpr std::size_t kNumbers = 14;
  void write(std::span<double, kNumbers> into) const;
  void read(std::span<const double, kNumbers> from);
};

}  // namespace limpid
