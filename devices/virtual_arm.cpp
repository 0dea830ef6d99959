#include "devices/virtual_arm.h"

#include <algorithm>
#include <cmath>

#include "core/math/solve.h"
#include "core/math/subnormals.h"

namespace limpid {
namespace {

// Substeps that share one look at where the arm is and how heavy, at their middle: it moves by
// less than a milliradian meanwhile, and the error is of its square.
constexpr int kShare = 2;
constexpr double kStictionSpeed = 1e-3;  // below it friction is a damper [rad/s]
constexpr double kStopDepth = 0.01;      // a stop gives by this at the motor's limit [rad]

}  // namespace

template <int N>
VirtualArm<N>::VirtualArm(const ArmDescription& arm)
    : arm_(arm),
      damping_(of_joints<N>(arm, &Joint::damping)),
      friction_(of_joints<N>(arm, &Joint::friction)),
      effort_(of_joints<N>(arm, &Joint::effort)),
      lower_(of_joints<N>(arm, &Joint::lower)),
      upper_(of_joints<N>(arm, &Joint::upper)),
      spring_(of_joints<N>(arm, &Joint::spring)),
      offset_(of_joints<N>(arm, &Joint::offset)),
      gravity_(arm.gravity) {
  const int n = arm.dof();
  place(Vec<N>::Zero(n), Vec<N>::Zero(n), Vec3::Zero());
}

template <int N>
void VirtualArm<N>::place(const Vec<N>& x, const Vec<N>& v, const Vec3& target) {
  x_ = x;
  v_ = v;
  target_ = target;
  hand_torque_ = Vec<N>::Zero(x.size());
}

template <int N>
Reading<N> VirtualArm<N>::read(double encoder_step) const {
  Reading<N> reading{x_, x_, v_};
  if (encoder_step > 0) {
    reading.measured = (x_ / encoder_step).array().round().matrix() * encoder_step;
  }
  return reading;
}

// The joints' own resistance around the middle of a substep: damping, friction, springs, stops.
template <int N>
typename VirtualArm<N>::Resistance VirtualArm<N>::resistance(const Vec<N>& b_d,
                                                             const Vec<N>& friction, bool springy,
                                                             const Vec<N>& x_mid) const {
  Resistance r{Vec<N>::Zero(x_.size()), b_d, Vec<N>::Zero(x_.size())};
  if (springy) {
    r.stiffness = spring_;
    r.torque = -spring_.cwiseProduct(x_mid) - offset_;
  }
  for (Eigen::Index i = 0; i < x_.size(); ++i) {
    if (friction[i] > 0) r.damping[i] += friction[i] / std::max(std::abs(v_[i]), kStictionSpeed);
    const double beyond = std::max(x_mid[i] - upper_[i], 0.0) + std::min(x_mid[i] - lower_[i], 0.0);
    if (beyond != 0) {
      const double stop = effort_[i] / kStopDepth;
      r.stiffness[i] += stop;
      r.torque[i] -= stop * beyond;
      r.damping[i] += std::sqrt(stop * M_(i, i));
    }
  }
  return r;
}

template <int N>
void VirtualArm<N>::live(const Parameters& p, const Vec<N>& torque, const HandInput& hand) {
  const NoSubnormals fast_at_rest;
  const double h = p.tick / p.substeps;
  const double k_h = hand.grip * p.hand_stiffness;
  const double b_h = hand.grip * p.hand_damping;
  const double mass = hand.grip * p.hand_mass_at_tip;
  const Vec<N> b_d = resolve<N>(p.damping, damping_);
  const Vec<N> friction = resolve<N>(p.friction, friction_);
  const Vec3 target_rate = (hand.target - target_) / p.tick;
  const double grip_damping = h / 2 * b_h + h * h / 4 * k_h;  // of the substep's midpoint
  const Vec<N> x_start = x_;
  Vec<N> pushed = Vec<N>::Zero(x_.size());
  if (!hand.torque.empty()) pushed = Eigen::Map<const Vec<N>>(hand.torque.data(), x_.size());
  Vec<N> x_model = x_;
  Vec<N> dv = Vec<N>::Zero(x_.size());
  Vec3 tip_model = Vec3::Zero(), drift = Vec3::Zero();
  const typename Arm<N>::Angles start = arm_.angles(x_start);
  hand_torque_.setZero();
  for (int s = 0; s < p.substeps; ++s) {
    if (s % kShare == 0) {
      const int ahead = std::min(kShare, p.substeps - s);
      x_model = x_ + ahead * h / 2 * v_;
      arm_.frames(arm_.turned(start, x_model - x_start), frames_);
      arm_.inertia_bias(frames_, v_ + 0.5 * ahead * dv, M_, Cv_);
      if (p.weighs) Cv_ += arm_.weight(frames_, gravity_of(p.down, gravity_));
      tip_model = arm_.tip(frames_);
      arm_.point_jacobian(frames_, arm_.dof() - 1, tip_model, J_);
      if (mass > 0) {
        drift = arm_.point_drift(frames_, arm_.dof() - 1, tip_model, v_ + 0.5 * ahead * dv);
      }
    }
    // Everything at the middle of the substep as v would have it; dv then corrects:
    // x_mid = x + h/2 v + h/4 dv, v_mid = v + dv/2.
    const Vec<N> x_mid = x_ + h / 2 * v_;
    const Vec3 tip = tip_model + J_ * (x_mid - x_model);
    const Vec3 target = target_ + (s + 0.5) * h * target_rate;
    const Vec3 pull = k_h * (target - tip) + b_h * (target_rate - J_ * v_) - mass * drift;
    const Resistance r = resistance(b_d, friction, p.springy, x_mid);

    // A is symmetric: its lower triangle is enough.
    Mat<N> A = M_;
    for (Eigen::Index j = 0; j < A.cols(); ++j) {
      const Vec3 pulled = (grip_damping + mass) * J_.col(j);
      for (Eigen::Index i = j; i < A.rows(); ++i) A(i, j) += J_.col(i).dot(pulled);
      A(j, j) += h / 2 * r.damping[j] + h * h / 4 * r.stiffness[j];
    }
    Vec<N> b = torque + pushed - Cv_ + r.torque - r.damping.cwiseProduct(v_);
    b.noalias() += J_.transpose() * pull;
    b *= h;
    dv = solve_symmetric<N>(A, b);

    const Vec3 force = pull - (b_h / 2 + h / 4 * k_h + mass / h) * (J_ * dv);
    hand_torque_.noalias() += J_.transpose() * force;
    x_ += h * (v_ + 0.5 * dv);
    v_ += dv;
  }
  hand_torque_ = hand_torque_ / p.substeps + pushed;
  target_ = hand.target;
}

template <int N>
VirtualDevice<N>::VirtualDevice(const ArmDescription& description) : arm(description) {
  traits_.name = description.name;
  traits_.id = "virtual";
  traits_.dof = description.dof();
  traits_.pushes = true;
  traits_.guarded = false;
  traits_.rate = 1 / p_.tick;
  for (const Joint& joint : description.joints) {
    traits_.lower.push_back(joint.lower);
    traits_.upper.push_back(joint.upper);
    traits_.resolution.push_back(0);
    traits_.effort.push_back(joint.effort);
  }
  sent_.fill(Vec<N>::Zero(traits_.dof));
  acted_ = sent_[0];
}

template <int N>
void VirtualDevice<N>::place(std::span<const double> x, std::span<const double> v,
                             const Vec3& target) noexcept {
  const Eigen::Index n = traits_.dof;
  arm.place(Eigen::Map<const Vec<N>>(x.data(), n), Eigen::Map<const Vec<N>>(v.data(), n), target);
  sent_.fill(Vec<N>::Zero(n));
  acted_ = sent_[0];
}

template <int N>
std::optional<DeviceTruth> VirtualDevice<N>::truth() const noexcept {
  const auto joints = [](const Vec<N>& values) {
    return std::span(values.data(), static_cast<std::size_t>(values.size()));
  };
  return DeviceTruth{joints(arm.x()), joints(arm.v()), joints(arm.hand_torque()), joints(acted_)};
}

template <int N>
bool VirtualDevice<N>::read(DeviceReading& newest) noexcept {
  const Reading<N> reading = arm.read(p_.encoder_step);
  std::copy_n(reading.measured.data(), reading.measured.size(), newest.x.begin());
  newest.count = ++count_;
  newest.age = 0;
  return true;
}

template <int N>
void VirtualDevice<N>::write(std::span<const double> torque) noexcept {
  Vec<N> tau = Vec<N>::Zero(traits_.dof);
  if (!torque.empty()) tau = Eigen::Map<const Vec<N>>(torque.data(), traits_.dof);
  std::rotate(sent_.begin(), sent_.end() - 1, sent_.end());
  sent_.front() = tau;
  acted_ = sent_[static_cast<std::size_t>(p_.device_delay)];
  arm.live(p_, acted_, hand_);
}

template class VirtualDevice<3>;
template class VirtualDevice<kAnyDof>;
template class VirtualArm<3>;
template class VirtualArm<kAnyDof>;

}  // namespace limpid
