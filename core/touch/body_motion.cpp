#include "core/touch/body_motion.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/math/elementary.h"

namespace limpid {
namespace {

// The spin in the middle of a tick is a fixed point: most turns to it, and the relative change at
// which they end. A body of a kilohertz tick that spins by 300 rad/s takes ten.
constexpr int kMostTurns = 20;
constexpr double kSameSpin = 1e-11;
constexpr double kStraight = 1e-8;  // turn of a tick whose chord is its arc [rad]

Mat3 turn(const Vec3& axis, double angle) {
  const SineCosine at = sine_cosine(angle);
  const Mat3 K = skew(axis);
  return Mat3::Identity() + at.sine * K + (1 - at.cosine) * K * K;
}

// Rotation over a tick by the constant angular velocity of the midpoint rule (Cayley): by 2
// atan(|d|/2) about d.
Mat3 cayley(const Vec3& d) {
  const Mat3 K = skew(d);
  return Mat3::Identity() + (K + 0.5 * K * K) / (1 + 0.25 * d.squaredNorm());
}

// Nearest rotation to a matrix that is one up to rounding: one step of Newton's method.
Mat3 rotation_again(const Mat3& R) { return 1.5 * R - 0.5 * R * (R.transpose() * R); }

}  // namespace

Pose pose_between(const Pose& from, const Pose& to, const Vec3& center, double part) {
  const Eigen::Quaterniond start(from.linear()), end(to.linear());
  const double sign = start.dot(end) < 0 ? -1 : 1;
  Eigen::Quaterniond turned;
  turned.coeffs() = (1 - part) * start.coeffs() + part * sign * end.coeffs();
  Pose between = Pose::Identity();
  between.linear() = turned.normalized().matrix();
  between.translation() =
      (1 - part) * (from * center) + part * (to * center) - between.linear() * center;
  return between;
}

BodyMotion::BodyMotion(const Object& object, const Vec3& gravity)
    : gravity_(gravity), start_(object.pose) {
  const MassProperties own = mass_properties(object);
  m_ = own.mass;
  c_ = own.center;
  I_ = own.inertia;
  if (object.body->joint && object.body->joint->to.empty()) {
    joint_ = *object.body->joint;
    pivot_ = start_ * joint_.point;
    switch (joint_.kind) {
      case BodyJoint::Kind::slider: kind_ = Kind::slider; break;
      case BodyJoint::Kind::hinge: kind_ = Kind::hinge; break;
      case BodyJoint::Kind::ball: kind_ = Kind::ball; break;
    }
  }
  pressed_theta_ = kTheta - (kTheta - 0.5) * object.body->restitution;
  if (on_joint()) potential_ = JointPotential(joint_.force);
  reflected_ = m_;
  if (kind_ == Kind::hinge) {
    const Vec3 axis = start_.linear().transpose() * joint_.axis;
    const Vec3 arm = joint_.axis.cross(start_ * c_ - pivot_);
    reflected_ = axis.dot(I_ * axis) + m_ * arm.squaredNorm();
  } else if (kind_ == Kind::ball) {
    const Mat3 arm = skew(c_ - joint_.point);
    I_ -= m_ * arm * arm;
  }
  inverse_ = I_.inverse();
  add_weight();
  reset();
}

// Adds the weight to the potential: on a joint it depends on the joint's place alone.
void BodyMotion::add_weight() {
  if (kind_ == Kind::slider) potential_.add_weight(m_ * gravity_.dot(joint_.axis));
  if (kind_ != Kind::hinge) return;
  const Vec3 c = start_ * c_ - pivot_;  // at s = 0
  const Vec3 along = joint_.axis * joint_.axis.dot(c);
  potential_.add_weight(-m_ * gravity_.dot(c - along), -m_ * gravity_.dot(joint_.axis.cross(c)));
}

void BodyMotion::reset() {
  pose_ = start_;
  v_.setZero();
  w_.setZero();
  s_ = sd_ = 0;
  place();
  u_.setZero();
  o_.setZero();
  torque_.setZero();
  U_ = 0;
}

// Computes the pose from the joint, or the point where it turns about from the pose.
void BodyMotion::place() {
  if (kind_ == Kind::slider) {
    pose_.linear() = start_.linear();
    pose_.translation() = start_.translation() + s_ * joint_.axis;
  } else if (kind_ == Kind::hinge) {
    const Mat3 R = turn(joint_.axis, s_);
    pose_.linear() = R * start_.linear();
    pose_.translation() = pivot_ + R * (start_.translation() - pivot_);
  }
  p_ = kind_ == Kind::ball ? pivot_ : pose_ * c_;
}

void BodyMotion::begin(double T, bool pressed) {
  theta_ = pressed ? pressed_theta_ : 0.5;
  spin_ = around_ = spin();
  if (on_joint()) {
    const double M = reflected_ / (theta_ * T);
    a_ = 1 / (M + joint_.damping);
    U_ = a_ * M * sd_;
    S_v_ = joint_.axis;
    S_w_.setZero();
    if (kind_ == Kind::hinge) {
      S_w_ = joint_.axis;
      S_v_ = joint_.axis.cross(p_ - pivot_ + 0.5 * T * sd_ * joint_.axis.cross(p_ - pivot_));
    }
    u_ = S_v_ * U_;
    o_ = S_w_ * U_;
    return;
  }
  im_ = kind_ == Kind::free ? theta_ * T / m_ : 0;
  u_ = kind_ == Kind::free ? Vec3(v_ + theta_ * T * gravity_) : Vec3(Vec3::Zero());
  begin_turning(T);
}

// Finds the mean spin `own` in the body's frame. With I w the angular momentum, all there,
//     I (w' - w)/T = (I own) x own + (1 - T/2 own x) torque,   own = (w + w')/2
// keeps energy and angular momentum but for rounding: the last term turns the torque into the
// middle of the tick. The gyroscopic torque and that of the weight W are functions of `own`; W
// pulls in the middle of the arm's two places, so it gives what the centre of mass falls. Other
// torques are not known yet: the last tick's are turned in place of them, which needs no energy.
void BodyMotion::begin_turning(double T) {
  const Mat3& R = pose_.linear();
  const bool hangs = kind_ == Kind::ball;
  const Vec3 arm = hangs ? Vec3(c_ - joint_.point) : Vec3(Vec3::Zero());
  const Vec3 W = hangs ? Vec3(m_ * (R.transpose() * gravity_)) : Vec3(Vec3::Zero());
  Vec3 own = w_ + 0.5 * T * (inverse_ * ((I_ * w_).cross(w_) + arm.cross(W)));
  Mat3 A;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    const Vec3 pull = set_impedance(own, torque_, T);
    A = impedance_.inverse().eval();
    const Vec3 before = own;
    own = A * pull;
    if ((own - before).squaredNorm() <= kSameSpin * kSameSpin * own.squaredNorm()) break;
  }
  own_ = own;
  o_ = R * own;
  Ai_ = R * A * R.transpose();
}

// Sets the impedance around a mean spin `own` and a torque, both in the body's frame; returns the
// torque without others.
Vec3 BodyMotion::set_impedance(const Vec3& own, const Vec3& torque, double T) {
  const Mat3& R = pose_.linear();
  impedance_ = I_ / (theta_ * T) - skew(I_ * own + 0.5 * T * torque);
  Vec3 pull = I_ * w_ / (theta_ * T);
  if (kind_ != Kind::ball) return pull;
  const Vec3 arm = c_ - joint_.point, W = m_ * (R.transpose() * gravity_);
  const Mat3 half = 0.5 * T * skew(own);
  const Vec3 middle = (Mat3::Identity() - half).inverse() * arm;  // half of both places
  const Vec3 weight = middle.cross(W);
  const Mat3 to_middle = Mat3::Identity() - half;
  const Mat3 more = 0.5 * T * (to_middle * skew(W) * skew(middle) + skew(weight));  // by the spin
  impedance_ -= more;
  pull += to_middle * weight - more * own;
  return pull;
}

double BodyMotion::turns_otherwise(double T) const {
  return on_joint() ? 0 : T * T * o_.norm() * (o_ - around_).norm();
}

void BodyMotion::turn_again(double T) {
  const Mat3& R = pose_.linear();
  const Vec3 own = R.transpose() * o_, torque = impedance_ * (own - own_);
  const Vec3 pull = set_impedance(own, torque, T);
  const Mat3 A = impedance_.inverse();
  own_ = A * pull;
  o_ = R * (own_ + A * torque);
  Ai_ = R * A * R.transpose();
  around_ = o_;
}

BodyMotion::Lever BodyMotion::lever(const Vec3& point, double T) const {
  const Vec3 arm = point - p_;
  return arm + 0.5 * T * spin_.cross(arm);
}

// The mean m of an arm's two places in the tick fulfils m = arm + h x m. A hinge turns its points
// by an angle, along a chord.
BodyMotion::Lever BodyMotion::middle(const Vec3& point, double T) const {
  if (kind_ == Kind::hinge) {
    const double angle = T * U_;
    const SineCosine half = sine_cosine(angle / 2);
    const bool bent = std::abs(angle) > kStraight;
    const double along = bent ? 2 * half.sine * half.cosine / angle : 1;
    const double inwards = bent ? 2 * half.sine * half.sine / angle : angle / 2;
    const Vec3 r = point - pivot_, c = p_ - pivot_;
    return along * r + inwards * joint_.axis.cross(r) - c - 0.5 * T * sd_ * joint_.axis.cross(c);
  }
  const Vec3 arm = point - p_, h = 0.5 * T * o_;
  return (arm + h.cross(arm) + h * h.dot(arm)) / (1 + h.squaredNorm());
}

BodyMotion::Lever BodyMotion::rolling(const Vec3& point, const Vec3& center, const Vec3& axis,
                                      double T) const {
  const Vec3 arm = point - center;
  const Vec3 turns = axis.isZero(0) ? axis : Vec3(spin_ - axis * axis.dot(spin_));
  return lever(center, T) + arm + 0.5 * T * turns.cross(arm);
}

double BodyMotion::yields(const Vec3& point, const Vec3& n) const {
  const Vec3 arm = point - p_;
  if (on_joint()) {
    const bool slides = kind_ == Kind::slider;
    const Vec3 moved = slides ? joint_.axis : Vec3(joint_.axis.cross(point - pivot_));
    const double along = moved.dot(n);
    return along * along / reflected_;
  }
  const Vec3 turned = pose_.linear().transpose() * arm.cross(n);
  return (kind_ == Kind::free ? 1 / m_ : 0) + turned.dot(inverse_ * turned);
}

void BodyMotion::strike(const Vec3& point, const Vec3& impulse) {
  if (kind_ == Kind::slider) {
    sd_ += joint_.axis.dot(impulse) / reflected_;
  } else if (kind_ == Kind::hinge) {
    sd_ += joint_.axis.cross(point - pivot_).dot(impulse) / reflected_;
  } else {
    if (kind_ == Kind::free) v_ += impulse / m_;
    w_ += inverse_ * (pose_.linear().transpose() * (point - p_).cross(impulse));
  }
}

void BodyMotion::go_back(const Pose& start, double part, double left) {
  pose_ = pose_between(start, pose_, c_, part);
  p_ = pose_ * c_;
  v_ -= left * gravity_;
}

// Without a torque, the spin in the body's frame is held, and its energy with it.
void BodyMotion::fly(double time) {
  p_ += time * (v_ + 0.5 * time * gravity_);
  v_ += time * gravity_;
  pose_.linear() = rotation_again(pose_.linear() * cayley(time * w_));
  pose_.translation() = p_ - pose_.linear() * c_;
}

Vec3 BodyMotion::turns_at(double time) const {
  return kind_ == Kind::ball ? p_ : Vec3(p_ + time * speed());
}

Pose BodyMotion::ahead(double time) const {
  Pose there = pose_;
  if (kind_ != Kind::slider)
    there.linear() = rotation_again(cayley(time * spin()) * pose_.linear());
  there.translation() = turns_at(time) - there.linear() * turns_about();
  return there;
}

void BodyMotion::set_speed(const Vec3& speed, const Vec3& spin) {
  sd_ = joint_.axis.dot(kind_ == Kind::slider ? speed : spin);
  if (kind_ == Kind::free) v_ = speed;
  if (!on_joint()) w_ = pose_.linear().transpose() * spin;
}

Mat3 BodyMotion::answer(const Lever& at) const {
  if (on_joint()) {
    const Vec3 j = S_v_ + S_w_.cross(at);
    return a_ * j * j.transpose();
  }
  // Computes im - [at]x Ai [at]x without the zeros of [at]x. Number by number, here and where it is
  // used: a processor waits when it reads two at once just after writing them one by one.
  const double x = at.x(), y = at.y(), z = at.z();
  double K[3][3];
  for (int j = 0; j < 3; ++j) {
    K[0][j] = y * Ai_(2, j) - z * Ai_(1, j);
    K[1][j] = z * Ai_(0, j) - x * Ai_(2, j);
    K[2][j] = x * Ai_(1, j) - y * Ai_(0, j);
  }
  Mat3 W;
  for (int i = 0; i < 3; ++i) {
    W(i, 0) = y * K[i][2] - z * K[i][1];
    W(i, 1) = z * K[i][0] - x * K[i][2];
    W(i, 2) = x * K[i][1] - y * K[i][0];
    W(i, i) += im_;
  }
  return W;
}

void BodyMotion::twist(const Vec3& torque) {
  if (on_joint()) {
    push_joint(S_w_.dot(torque));
    return;
  }
  o_ += Ai_ * torque;
}

BodyMotion::Answer BodyMotion::answer() const {
  Answer all = Answer::Zero();
  if (on_joint()) {
    Eigen::Matrix<double, 6, 1> j;
    j << S_v_, S_w_;
    all = a_ * j * j.transpose();
    return all;
  }
  all.topLeftCorner<3, 3>() = im_ * Mat3::Identity();
  all.bottomRightCorner<3, 3>() = Ai_;
  return all;
}

void BodyMotion::push_joint(double force) { set_joint_speed(U_ + a_ * force); }

void BodyMotion::set_joint_speed(double speed) {
  U_ = speed;
  u_ = S_v_ * U_;
  o_ = S_w_ * U_;
}

void BodyMotion::finish(double T) {
  if (on_joint()) {
    s_ += T * U_;
    sd_ += (U_ - sd_) / theta_;
    place();
    return;
  }
  const Mat3 R = pose_.linear();
  const Vec3 own = R.transpose() * o_;
  const Mat3 turned = cayley(T * own);
  torque_ = turned.transpose() * (impedance_ * (own - own_));
  p_ += T * u_;
  pose_.linear() = rotation_again(R * turned);
  pose_.translation() = p_ - pose_.linear() * turns_about();
  v_ += (u_ - v_) / theta_;
  w_ += (own - w_) / theta_;
}

bool BodyMotion::limit_spin(double T) {
  const double turn = T * w_.norm();
  if (!(turn > kMostTurn)) return false;
  w_ *= kMostTurn / turn;
  return true;
}

void BodyMotion::halt() {
  v_.setZero();
  w_.setZero();
  u_.setZero();
  o_.setZero();
  own_.setZero();
  torque_.setZero();
  sd_ = U_ = 0;
}

Vec3 BodyMotion::speed() const {
  if (kind_ == Kind::slider) return sd_ * joint_.axis;
  if (kind_ == Kind::hinge) return sd_ * joint_.axis.cross(p_ - pivot_);
  if (kind_ == Kind::ball) return spin().cross(center() - pivot_);
  return v_;
}

Vec3 BodyMotion::spin() const {
  if (kind_ == Kind::slider) return Vec3::Zero();
  if (kind_ == Kind::hinge) return sd_ * joint_.axis;
  return pose_.linear() * w_;
}

double BodyMotion::kinetic() const {
  if (on_joint()) return 0.5 * reflected_ * sd_ * sd_;
  return 0.5 * m_ * v_.squaredNorm() + 0.5 * w_.dot(I_ * w_);
}

double BodyMotion::kinetic_after() const {
  if (on_joint()) {
    const double after = sd_ + (U_ - sd_) / theta_;
    return 0.5 * reflected_ * after * after;
  }
  const Vec3 w = w_ + (pose_.linear().transpose() * o_ - w_) / theta_;
  return 0.5 * m_ * (v_ + (u_ - v_) / theta_).squaredNorm() + 0.5 * w.dot(I_ * w);
}

double BodyMotion::made(double T) const {
  if (kind_ != Kind::ball) return 0;
  const Vec3 own = pose_.linear().transpose() * o_;
  const Vec3 arm = c_ - joint_.point, there = cayley(T * own) * arm;
  const double fallen = m_ * gravity_.dot(pose_.linear() * (there - arm));
  const double work = T * own.dot(impedance_ * (own - own_));
  return std::max(0.0, kinetic_after() - kinetic() - fallen - work);
}

double BodyMotion::weight_energy() const {
  return on_joint() ? 0 : -m_ * gravity_.dot(center());  // else in the potential
}

void BodyMotion::write(std::span<double, kNumbers> into) const {
  const Mat3 R = pose_.linear();  // contiguous numbers, unlike those in a pose
  auto* to = into.data();
  to = std::copy_n(p_.data(), 3, to);
  to = std::copy_n(R.data(), 9, to);
  to = std::copy_n(v_.data(), 3, to);
  to = std::copy_n(w_.data(), 3, to);
  *to++ = s_;
  *to++ = sd_;
  std::copy_n(torque_.data(), 3, to);
}

void BodyMotion::read(std::span<const double, kNumbers> from) {
  const auto* at = from.data();
  p_ = Vec3(at[0], at[1], at[2]);
  pose_.linear() = Eigen::Map<const Mat3>(at + 3);
  pose_.translation() = p_ - pose_.linear() * turns_about();
  v_ = Vec3(at[12], at[13], at[14]);
  w_ = Vec3(at[15], at[16], at[17]);
  s_ = at[18];
  sd_ = at[19];
  torque_ = Vec3(at[20], at[21], at[22]);
  if (on_joint()) place();
}

bool BodyMotion::alike(const BodyMotion& other) const {
  return kind_ == other.kind_ && joint_.axis == other.joint_.axis && pivot_ == other.pivot_ &&
         start_.matrix() == other.start_.matrix();
}

}  // namespace limpid
