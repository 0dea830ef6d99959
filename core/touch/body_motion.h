// Motion of one body over a tick: the midpoint rule, weighted towards the end of the tick.
#pragma once

#include <span>

#include "core/touch/joint_potential.h"
#include "core/touch/mass_properties.h"
#include "core/touch/scene.h"

namespace limpid {

// Pose of an object a part of the way from one pose to another; its centre of mass, in its frame,
// goes straight.
Pose pose_between(const Pose& from, const Pose& to, const Vec3& center, double part);

// [v]x, the matrix of the cross product with v.
inline Mat3 skew(const Vec3& v) {
  Mat3 S;
  S << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return S;
}

// A free body, or one on a joint with the world. A free body turns about its centre of mass, one on
// a ball joint about the joint's point, which stays.
class BodyMotion {
 public:
  // A point of the body, seen from where it turns about, in the middle of a tick [m].
  using Lever = Vec3;

  BodyMotion(const Object& object, const Vec3& gravity);  // [m/s^2]

  void reset();  // to its start, at rest

  // Weight of the tick's end for a body that is pressed, or was a moment ago; otherwise 1/2. At 1/2
  // energy is kept, but a stiff contact of a light body then alternates. With restitution energy is
  // kept, so the weight is nearer to 1/2.
  static constexpr double kTheta = 0.6;

  // Begins a tick of T [s]: computes the mean velocity under weight alone, and the response to
  // forces.
  void begin(double T, bool pressed);
  double theta() const { return theta_; }  // weight of the tick's end
  Lever lever(const Vec3& point, double T) const;
  // The same by the mean spin that the forces so far lead to: the middle of both places.
  Lever middle(const Vec3& point, double T) const;
  // The angle by which it turns in the tick, times the one by which that differs from what levers
  // and response were found with [rad^2].
  double turns_otherwise(double T) const;
  // Finds the response anew, by the mean spin and the torques of the forces so far. Once they no
  // longer change, the angular momentum is kept as well as the energy.
  void turn_again(double T);
  // Lever of the point where a round part of the body rolls: the part turns about its centre [m]
  // and the axis, zero for a ball, and the point does not turn along.
  Lever rolling(const Vec3& point, const Vec3& center, const Vec3& axis, double T) const;
  // Mean velocity over the tick of the body's point there [m/s].
  Vec3 velocity(const Lever& at) const { return u_ + o_.cross(at); }
  // Response of that velocity to a force there [m/(N s)].
  Mat3 answer(const Lever& at) const;
  // Applies a force there [N].
  void push(const Lever& at, const Vec3& force) {
    if (!on_joint()) {
      u_ += im_ * force;
      o_ += Ai_ * at.cross(force);
    } else {
      push_joint((S_v_ + S_w_.cross(at)).dot(force));
    }
  }
  // Mean angular velocity [rad/s]; twist() applies a torque [N m].
  const Vec3& turning() const { return o_; }
  void twist(const Vec3& torque);
  // Response of the centre's velocity and of the angular velocity to a force at the centre of mass
  // and a torque, SI.
  using Answer = Eigen::Matrix<double, 6, 6>;
  Answer answer() const;
  // For a body on a joint: response to a generalized force along it [N] or [N m].
  bool on_joint() const { return kind_ == Kind::slider || kind_ == Kind::hinge; }
  void push_joint(double force);
  double joint_speed() const { return U_; }
  void set_joint_speed(double speed);  // after forces along the joint
  double joint_answer() const { return a_; }
  double joint() const { return s_; }        // [m] or [rad]
  double joint_rate() const { return sd_; }  // between ticks [m/s] or [rad/s]
  const BodyJoint& of_joint() const { return joint_; }
  // Potential along the joint: weight, springs, detents.
  const JointPotential& potential() const { return potential_; }
  // Ends the tick.
  void finish(double T);
  // Bodies of mechanisms turn at most by this angle in a tick [rad].
  static constexpr double kMostTurn = 1;
  bool limit_spin(double T);  // true: it would have turned further
  void halt();                // at rest from now on
  // Between ticks: velocity of the body's point there [m/s], its response along a unit n to an
  // impulse there [1/kg], and such an impulse [N s].
  Vec3 speed_at(const Vec3& point) const { return speed() + spin().cross(point - center()); }
  double yields(const Vec3& point, const Vec3& n) const;
  void strike(const Vec3& point, const Vec3& impulse);
  // For a body without a joint: takes it back to a part of its way from a pose, before the weight
  // of the time that is left [s]; lets it fly on for some time [s]. What else pushed it, it keeps.
  void go_back(const Pose& start, double part, double left);
  void fly(double time);
  // Sets the speed of the centre [m/s] and the spin [rad/s], as far as its joint lets it.
  void set_speed(const Vec3& speed, const Vec3& spin);
  void slow_down(double by) {  // multiplies all velocities
    v_ *= by;
    w_ *= by;
    sd_ *= by;
  }

  const Pose& pose() const { return pose_; }  // of its object
  // Return the pose, and the point where the body turns about, after some time at its present
  // velocities [s].
  Pose ahead(double time) const;
  Vec3 turns_at(double time) const;
  const Vec3& turns_at() const { return p_; }  // the point where it turns about [m]
  Vec3 center() const { return kind_ == Kind::ball ? Vec3(pose_ * c_) : p_; }  // of mass [m]
  Vec3 speed() const;  // of the centre [m/s]
  Vec3 spin() const;   // [rad/s], world
  double mass() const { return m_; }
  double kinetic() const;
  double kinetic_after() const;  // of the velocities that finish() will leave [J]
  // Energy that the tick brings beyond the work of forces: of the weight on a ball joint, which is
  // known for the motion under weight alone [J].
  double made(double T) const;
  double weight_energy() const;  // without a slider or a hinge; relative to the origin [J]
  bool finite() const { return p_.allFinite() && pose_.matrix().allFinite(); }

  // All changing state, as numbers.
  static constexpr int kNumbers = 23;
  void write(std::span<double, kNumbers> into) const;
  void read(std::span<const double, kNumbers> from);
  // True if both have the same start and joint.
  bool alike(const BodyMotion& other) const;

 private:
  enum class Kind : std::uint8_t { free, ball, slider, hinge };
  void add_weight();
  void place();
  void begin_turning(double T);
  Vec3 set_impedance(const Vec3& own, const Vec3& torque, double T);
  // The point where it turns about, in the object's frame [m].
  const Vec3& turns_about() const { return kind_ == Kind::ball ? joint_.point : c_; }

  Kind kind_ = Kind::free;
  Vec3 gravity_;
  double m_ = 0;
  Vec3 c_;            // centre of mass in the object's frame [m]
  Mat3 I_, inverse_;  // where it turns about, along the object's axes [kg m^2]
  Pose start_;
  BodyJoint joint_;
  JointPotential potential_;
  double reflected_ = 0;       // inertia along the joint [kg] or [kg m^2]
  Vec3 pivot_ = Vec3::Zero();  // of a hinge or a ball joint [m]

  Pose pose_;              // of the object
  Vec3 p_, v_, w_;         // where it turns about [m], its velocity [m/s], spin in the body's frame
  double s_ = 0, sd_ = 0;  // of the joint
  Vec3 torque_;            // on it over the last tick but for the weight, in its frame [N m]
  double pressed_theta_ = kTheta;
  double theta_ = 0.5;

  // State of the tick.
  Vec3 u_, o_;     // mean velocities, world
  Vec3 spin_;      // at the start, world
  Vec3 around_;    // spin that levers and response were found with, world
  double im_ = 0;  // theta T / m
  Mat3 Ai_;
  Vec3 own_;        // mean spin under weight alone, in the body's frame
  Mat3 impedance_;  // torque for a change of it
  Vec3 S_v_, S_w_;  // velocity at the centre and angular velocity for unit joint speed
  double U_ = 0, a_ = 0;
};

}  // namespace limpid
