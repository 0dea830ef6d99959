// How one body moves over a tick: the midpoint rule, weighted towards the end of the tick.
#pragma once

#include <span>

#include "core/touch/joint_potential.h"
#include "core/touch/mass_properties.h"
#include "core/touch/scene.h"

namespace limpid {

// [v]x: the matrix that makes the cross product with v.
inline Mat3 skew(const Vec3& v) {
  Mat3 S;
  S << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return S;
}

// Free, or on a slider or a hinge. A ball joint is a free body that a row holds (BodyWorld).
class BodyMotion {
 public:
  // Where a body's point is, seen from its centre of mass, in the middle of a tick [m].
  using Lever = Vec3;

  BodyMotion(const Object& object, const Vec3& gravity);  // [m/s^2]

  void reset();  // to where it starts, at rest

  // Weight of the tick's end where something pushed at the last tick, 1/2 at least: at 1/2 energy
  // is kept, but a stiff contact of a light body then alternates. What bounces keeps energy, and
  // has as much less of it.
  static constexpr double kTheta = 0.6;

  // The mean velocity that it has over the tick when nothing but its weight acts, and what a force
  // adds to it. T [s].
  void begin(double T, bool pushed);
  Lever lever(const Vec3& point, double T) const;
  // Of the body's point there, mean over the tick [m/s].
  Vec3 velocity(const Lever& at) const { return u_ + o_.cross(at); }
  // What a force there adds to it [m/(N s)].
  Mat3 answer(const Lever& at) const;
  // A force acts there [N].
  void push(const Lever& at, const Vec3& force) {
    if (kind_ == Kind::free) {
      u_ += im_ * force;
      o_ += Ai_ * at.cross(force);
    } else {
      push_joint((S_v_ + S_w_.cross(at)).dot(force));
    }
  }
  // Its mean angular velocity [rad/s], and a torque acts on it [N m].
  const Vec3& turning() const { return o_; }
  void twist(const Vec3& torque);
  // What a force at its centre of mass and a torque add to the centre's velocity and to its angular
  // velocity, SI.
  using Answer = Eigen::Matrix<double, 6, 6>;
  Answer answer() const;
  // And one along its joint [N] or [N m].
  bool on_joint() const { return kind_ != Kind::free; }
  void push_joint(double force);
  double joint_speed() const { return U_; }
  void set_joint_speed(double speed);  // what forces along the joint made of it
  double joint_answer() const { return a_; }
  double joint() const { return s_; }  // [m] or [rad]
  const BodyJoint& of_joint() const { return joint_; }
  // What depends on the joint's place alone: weight, springs, detents.
  const JointPotential& potential() const { return potential_; }
  // The tick is over.
  void finish(double T);
  void halt();  // at rest from now on

  const Pose& pose() const { return pose_; }  // of its object
  const Vec3& center() const { return p_; }   // of mass [m]
  Vec3 speed() const;                         // of the centre [m/s]
  Vec3 spin() const;                          // [rad/s], world
  double mass() const { return m_; }
  double kinetic() const;
  double weight_energy() const;  // of a free body, against the origin [J]
  bool finite() const { return p_.allFinite() && pose_.matrix().allFinite(); }

  // All that changes, as numbers.
  static constexpr int kNumbers = 20;
  void write(std::span<double, kNumbers> into) const;
  void read(std::span<const double, kNumbers> from);
  // It starts in the same place, on the same joint.
  bool alike(const BodyMotion& other) const;

 private:
  enum class Kind : std::uint8_t { free, slider, hinge };
  void add_weight();
  void place();

  Kind kind_ = Kind::free;
  Vec3 gravity_;
  double m_ = 0;
  Vec3 c_;            // centre of mass in the object's frame [m]
  Mat3 I_, inverse_;  // about it, along the object's axes [kg m^2]
  Pose start_;
  BodyJoint joint_;
  JointPotential potential_;
  double reflected_ = 0;       // inertia along the joint [kg] or [kg m^2]
  Vec3 pivot_ = Vec3::Zero();  // of a hinge [m]

  Pose pose_;                       // of the object
  Vec3 p_, v_, w_;                  // centre [m], its velocity [m/s], angular velocity in its frame
  double s_ = 0, sd_ = 0;           // of the joint
  double bouncing_theta_ = kTheta;  // where something pushed
  double theta_ = 0.5;

  // Of the tick:
  Vec3 u_, o_;     // mean velocities, world
  Vec3 spin_;      // at the start, world
  double im_ = 0;  // theta T / m
  Mat3 Ai_;
  Vec3 S_v_, S_w_;  // of the joint, at the centre
  double U_ = 0, a_ = 0;
};

}  // namespace limpid
