#include "core/touch/held_joint.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace limpid {
namespace {

using Mat63 = Eigen::Matrix<double, 6, 3>;

// Force at the centre of mass and torque, for a unit force at a lever along each axis.
Mat63 force_at(const Vec3& lever) {
  Mat63 J;
  J << Mat3::Identity(), skew(lever);
  return J;
}

Mat63 torque() {
  Mat63 J;
  J << Mat3::Zero(), Mat3::Identity();
  return J;
}

Mat3 symmetric(const Mat3& A) { return 0.5 * (A + A.transpose()); }

}  // namespace

// The response is W - G^T M^-1 G. M, without the springs' forces, is the response of the springs to
// each other, G theirs to the force, W the joint's to it.
JointAnswer joint_answer(bool turns, const JointSide& a, const JointSide& b,
                         std::span<const JointHold> holds) {
  const auto n = static_cast<int>(holds.size());
  JointAnswer::Mat9 M = JointAnswer::Mat9::Identity();
  JointAnswer::Mat93 G = JointAnswer::Mat93::Zero();
  Mat3 W = Mat3::Zero();
  for (int i = 0; i < n; ++i) {
    M.block<3, 3>(3 * i, 3 * i) /= holds[static_cast<std::size_t>(i)].stiffness;
  }
  for (const JointSide* side : {&a, &b}) {
    const Mat63 own = turns ? torque() : force_at(side->lever);
    const Mat63 moved = side->answer * own;
    W += own.transpose() * moved;
    for (int i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const Mat63 here = force_at(side->links[at]) * holds[at].directions;
      G.block<3, 3>(3 * i, 0) += here.transpose() * moved;
      for (int j = 0; j < n; ++j) {
        const auto other = static_cast<std::size_t>(j);
        const Mat63 from = side->answer * force_at(side->links[other]) * holds[other].directions;
        M.block<3, 3>(3 * i, 3 * j) += here.transpose() * from;
      }
    }
  }
  // Rotating bodies make M slightly unsymmetric; the sweeps correct the error.
  const Eigen::LLT<JointAnswer::Mat9> factor(0.5 * (M + M.transpose()));
  JointAnswer answer;
  answer.give = factor.solve(JointAnswer::Mat9::Identity());
  answer.yield = answer.give * G;
  answer.response = symmetric(symmetric(W) - G.transpose() * answer.yield);
  return answer;
}

bool HeldJoint::needed(const BodyJoint& joint) {
  return joint.damping != 0 || joint.friction != 0 || std::isfinite(joint.low) ||
         std::isfinite(joint.high) || !(joint.force == JointForce{});
}

double HeldJoint::stored() const {
  if (ball()) return 0.5 * joint.stop_stiffness * anchor.squaredNorm();
  return limpid::stored(joint, potential, place, forces.anchor);
}

void HeldJoint::start(const Mat3& now) {
  answer = now;
  turns_less = false;
  if (ball()) {
    damped = (Mat3::Identity() + joint.damping * answer).inverse();
  } else {
    damped = Mat3::Identity() / (1 + joint.damping * along.dot(answer * along));
    damping = along * along.dot(damping);
  }
}

double HeldJoint::sweep(double T, const Vec3& speed) {
  const Vec3 before = damping;
  if (ball()) {
    const Vec3 rubbed = friction;
    const Vec3 free = damped * (speed - answer * (friction + damping));
    const Mat3 W = damped * answer;
    friction = friction_torque(joint.stop_stiffness, joint.friction, anchor, T, free, W);
    damping = -joint.damping * (free + W * friction);
    return (friction - rubbed).norm() + (damping - before).norm();
  }
  const double w = along.dot(answer * along), left = damped(0, 0), before_it = forces.sum();
  const double undamped = along.dot(speed) - w * along.dot(damping);
  AlongJoint now{place, left * undamped, left * w};
  const double change = sweep_joint(joint, potential, T, now, forces);
  damping = -joint.damping * now.speed * along;
  turns_less = turns() && T * std::abs(now.speed) > BodyMotion::kMostTurn;
  if (turns_less) {
    const double most = std::copysign(BodyMotion::kMostTurn / T, now.speed);
    if (potential.any()) potential.over_a_tick(place, T * most, 0, forces.potential);
    damping = (most - undamped - w * (forces.sum() - before_it)) / w * along;
  }
  return change + (damping - before).norm();
}

Vec3 HeldJoint::add(const Vec3& change) {
  Vec3 all = change;
  if (ball()) {
    friction += change;
  } else {
    forces.potential += change[0];
    forces.stop += change[1];
    forces.friction += change[2];
    all = change.sum() * along;
  }
  Vec3 left = damped * all;
  damping += left - all;
  return left;
}

Vec3 HeldJoint::numbers() const {
  return ball() ? friction : Vec3(forces.potential, forces.stop, forces.friction);
}

double HeldJoint::made(double T, const Vec3& speed) const {
  if (ball()) {
    const double K = joint.stop_stiffness;
    return T * force().dot(speed) + 0.5 * (friction.squaredNorm() / K - K * anchor.squaredNorm());
  }
  return T * damping.dot(speed) +
         limpid::made(joint, potential, T, {place, along.dot(speed), 0}, forces);
}

void HeldJoint::finish(double T, const Vec3& speed) {
  anchor = -friction / joint.stop_stiffness;
  forces.anchor = -forces.friction / joint.stop_stiffness;
  if (ball()) return;
  const double way = T * along.dot(speed);
  forces.hit.finish(joint, place, way);
  place += way;
}

void HeldJoint::hold() {
  friction = -joint.stop_stiffness * anchor;
  damping.setZero();
  forces.potential = forces.stop = forces.hit.speed = 0;
  forces.friction = -joint.stop_stiffness * forces.anchor;
}

void HeldJoint::follow(double sine) {
  const double there = place + sine;
  if (limpid::stored(joint, potential, there, 0) <= limpid::stored(joint, potential, place, 0)) {
    place = there;
  }
}

std::array<double, HeldJoint::kNumbers> HeldJoint::kept() const {
  std::array<double, kNumbers> all{place, forces.potential, forces.stop, forces.friction,
                                   forces.anchor};
  double* to = all.data() + 5;
  for (const Vec3* v : {&friction, &anchor, &damping}) to = std::copy_n(v->data(), 3, to);
  return all;
}

void HeldJoint::read(const double* from) {
  place = from[0];
  forces = {from[1], from[2], from[3], from[4], {}};
  friction = Vec3(from[5], from[6], from[7]);
  anchor = Vec3(from[8], from[9], from[10]);
  damping = Vec3(from[11], from[12], from[13]);
}

}  // namespace limpid
