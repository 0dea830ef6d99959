// Motion of one body over a tick: the midpoint rule, weighted towards the end of the tick.
#pragma once

#include <span>

#include "core/touch/joint_potential.h"
#include "core/touch/mass_properties.h"
#include "core/touch/scene.h"

namespace limpid {

// [v]x, the matrix of the cross product with v.
inline Mat3 skew(const Vec3& v) {
  Mat3 S;
  S << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return S;
}

// A free body, or one on a slider or a hinge. A body on a ball joint is a free body held by a row
// (BodyWorld).
class BodyMotion {
 public:
  // A point of the body, seen from its centre of mass, in the middle of a tick [m].
  using Lever = Vec3;

  BodyMotion(const Object& object, const Vec3& gravity);  // [m/s^2]

  void reset();  // to its start, at rest

  // Weight of the tick's end after a tick with contact forces; otherwise 1/2. At 1/2 energy is
  // kept, but a stiff contact of a light body then alternates. With restitution energy is kept, so
  // the weight is nearer to 1/2.
  static constexpr double kTheta = 0.6;

  // Begins a tick of T [s]: computes the mean velocity under weight alone, and the response to
  // forces.
  void begin(double T, bool pushed);
  Lever lever(const Vec3& point, double T) const;
  // Mean velocity over the tick of the body's point there [m/s].
  Vec3 velocity(const Lever& at) const { return u_ + o_.cross(at); }
  // Response of that velocity to a force there [m/(N s)].
  Mat3 answer(const Lever& at) const;
  // Applies a force there [N].
  void push(const Lever& at, const Vec3& force) {
    if (kind_ == Kind::free) {
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
  bool on_joint() const { return kind_ != Kind::free; }
  void push_joint(double force);
  double joint_speed() const { return U_; }
  void set_joint_speed(double speed);  // after forces along the joint
  double joint_answer() const { return a_; }
  double joint() const { return s_; }  // [m] or [rad]
  const BodyJoint& of_joint() const { return joint_; }
  // Potential along the joint: weight, springs, detents.
  const JointPotential& potential() const { return potential_; }
  // Ends the tick.
  void finish(double T);
  void halt();  // at rest from now on

  const Pose& pose() const { return pose_; }  // of its object
  const Vec3& center() const { return p_; }   // centre of mass [m]
  Vec3 speed() const;                         // of the centre [m/s]
  Vec3 spin() const;                          // [rad/s], world
  double mass() const { return m_; }
  double kinetic() const;
  double weight_energy() const;  // of a free body, relative to the origin [J]
  bool finite() const { return p_.allFinite() && pose_.matrix().allFinite(); }

  // All changing state, as numbers.
  static constexpr int kNumbers = 20;
  void write(std::span<double, kNumbers> into) const;
  void read(std::span<const double, kNumbers> from);
  // True if both have the same start and joint.
  bool alike(const BodyMotion& other) const;

 private:
  enum class Kind : std::uint8_t { free, slider, hinge };
  void add_weight();
  void place();

  Kind kind_ = Kind::free;
  Vec3 gravity_;
  double m_ = 0;
  Vec3 c_;            // centre of mass in the object's frame [m]
  Mat3 I_, inverse_;  // about the centre, along the object's axes [kg m^2]
  Pose start_;
  BodyJoint joint_;
  JointPotential potential_;
  double reflected_ = 0;       // inertia along the joint [kg] or [kg m^2]
  Vec3 pivot_ = Vec3::Zero();  // of a hinge [m]

  Pose pose_;                       // of the object
  Vec3 p_, v_, w_;                  // centre [m], its velocity [m/s], angular velocity in its frame
  double s_ = 0, sd_ = 0;           // of the joint
  double bouncing_theta_ = kTheta;  // theta_ after a tick with contact forces
  double theta_ = 0.5;

  // State of the tick.
  Vec3 u_, o_;     // mean velocities, world
  Vec3 spin_;      // at the start, world
  double im_ = 0;  // theta T / m
  Mat3 Ai_;
  Vec3 S_v_, S_w_;  // velocity at the centre and angular velocity for unit joint speed
  double U_ = 0, a_ = 0;
};

}  // namespace limpid
