#include "devices/virtual_arm.h"

#include <algorithm>
#include <cmath>

#include "core/math/subnormals.h"

namespace limpid {
namespace {

constexpr int kShare = 5;                // substeps that share a look
constexpr double kFar = 0.05;            // looks this far apart say nothing of what comes [rad]
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
  for (Look& look : looks_) {
    look.x = x;
    look.v = v;
    look.angles = arm_.angles(x);
  }
  look(true, std::nullopt);
}

template <int N>
Reading<N> VirtualArm<N>::read(double encoder_step) const {
  Reading<N> reading{x_, x_, v_};
  if (encoder_step > 0) {
    reading.measured = (x_ / encoder_step).array().round().matrix() * encoder_step;
  }
  return reading;
}

template <int N>
typename VirtualArm<N>::Drive VirtualArm<N>::drive(const Parameters& p, const Vec<N>& torque,
                                                   const HandInput& hand) const {
  Drive d{p.tick / p.substeps,
          hand.grip * p.hand_stiffness,
          hand.grip * p.hand_damping,
          hand.grip * p.hand_mass_at_tip,
          target_,
          (hand.target - target_) / p.tick,
          torque,
          resolve<N>(p.damping, damping_),
          resolve<N>(p.friction, friction_),
          false,
          p.springy,
          p.weighs ? std::optional(gravity_of(p.down, gravity_)) : std::nullopt};
  d.rubs = d.friction.maxCoeff() > 0;
  if (!hand.torque.empty()) d.torque += Eigen::Map<const Vec<N>>(hand.torque.data(), torque.size());
  return d;
}

// What the arm is like at both places.
template <int N>
void VirtualArm<N>::look(bool drift, const std::optional<Vec3>& gravity) {
  const Look &one = looks_[0], &two = looks_[1];
  const int last = arm_.dof() - 1;
  const VecOf<N, Pair> v = paired<N>(one.v, two.v);
  typename Arm<N>::template FramesOf<Pair> frames;
  typename Arm<N>::template Bodies<Pair> bodies;
  MatOf<N, Pair> M;
  VecOf<N, Pair> Cv;
  JacobianOf<N, Pair> J;
  arm_.frames(
      {paired<N>(one.angles.sin, two.angles.sin), paired<N>(one.angles.cos, two.angles.cos)},
      frames);
  arm_.inertia(frames, bodies, M);
  arm_.bias(frames, bodies, v, Cv);
  const Vec3Of<Pair> tip = arm_.tip(frames);
  arm_.point_jacobian(frames, last, tip, J);
  Vec3Of<Pair> Jdot_v = Vec3Of<Pair>::Zero();
  if (drift) Jdot_v = arm_.point_drift(frames, last, tip, v);
  for (int i = 0; i < 2; ++i) {
    Look& look = looks_[static_cast<std::size_t>(i)];
    take(M, i, look.M);
    take(Cv, i, look.Cv);
    if (gravity) {
      typename Arm<N>::Frames own;
      arm_.take(frames, i, own);
      look.Cv += arm_.weight(own, *gravity);
    }
    take(tip, i, look.tip);
    take(J, i, look.J);
    take(Jdot_v, i, look.drift);
  }
}

template <int N>
VirtualArm<N>::Stride::Stride(const Drive& drive, const Look& at, const Vec<N>& x, const Vec<N>& v)
    : d(drive), look(at), A(at.M), torque(drive.torque - at.Cv) {
  const double h = d.h;
  along_rate = d.grip + h / 2 * d.stiffness;
  answer = d.grip / 2 + h / 4 * d.stiffness + d.mass / h;
  A *= 1 / h;
  for (Eigen::Index j = 0; j < A.cols(); ++j) {
    const Vec3 held = answer * look.J.col(j);
    for (Eigen::Index i = j; i < A.rows(); ++i) A(i, j) += look.J.col(i).dot(held);
    A(j, j) += d.damping[j] / 2;
  }
  A_factor.compute(A);
  tip = look.tip + look.J * (x - look.x);
  tip_rate = look.J * v;
}

// What friction, springs and stops add to A and b around the middle of a substep; false: nothing.
template <int N>
[[gnu::always_inline]] inline bool VirtualArm<N>::resist(const Stride& stride, const Vec<N>& x,
                                                         const Vec<N>& v, Mat<N>& A,
                                                         Vec<N>& b) const {
  const Drive& d = stride.d;
  const Vec<N> middle = x + d.h / 2 * v;
  bool free = !d.rubs && !d.springy;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    free = free && middle[i] >= lower_[i] && middle[i] <= upper_[i];
  }
  if (free) return false;
  A = stride.A;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double beyond =
        std::max(middle[i] - upper_[i], 0.0) + std::min(middle[i] - lower_[i], 0.0);
    double damping = 0, stiffness = 0;
    if (d.friction[i] > 0) damping = d.friction[i] / std::max(std::abs(v[i]), kStictionSpeed);
    if (d.springy) {
      b[i] -= spring_[i] * middle[i] + offset_[i];
      A(i, i) += d.h / 4 * spring_[i];
    }
    if (beyond != 0) {
      stiffness = effort_[i] / kStopDepth;
      damping += std::sqrt(stiffness * stride.look.M(i, i));
    }
    b[i] -= stiffness * beyond + damping * v[i];
    A(i, i) += damping / 2 + d.h / 4 * stiffness;
  }
  return true;
}

// A substep whose middle is at t from the tick's start. All is taken there as v would have it; dv,
// which is returned, then corrects: x_mid = x + h/2 v + h/4 dv, v_mid = v + dv/2.
template <int N>
[[gnu::always_inline]] inline Vec<N> VirtualArm<N>::step(Stride& stride, double t, Vec<N>& x,
                                                         Vec<N>& v) const {
  const Drive& d = stride.d;
  const Jacobian<N>& J = stride.look.J;
  Vec3 force = d.stiffness * (d.target + t * d.target_rate - stride.tip) + d.grip * d.target_rate -
               stride.along_rate * stride.tip_rate;
  if (d.mass > 0) force -= d.mass * stride.look.drift;
  Vec<N> b = stride.torque - d.damping.cwiseProduct(v);
  b.noalias() += J.transpose() * force;
  Mat<N> A;
  const Vec<N> dv =
      resist(stride, x, v, A, b) ? solve_symmetric<N>(A, b) : stride.A_factor.solve(b);
  const Vec3 move = J * dv;
  stride.force += force - stride.answer * move;
  stride.tip += d.h * (stride.tip_rate + 0.5 * move);
  stride.tip_rate += move;
  x += d.h * (v + 0.5 * dv);
  v += dv;
  return dv;
}

// Looks at where the arm will be on average over so many substeps from s on, and over as many after
// them. It gets there in two big steps, by what the last two looks would have become.
template <int N>
void VirtualArm<N>::look_ahead(const Drive& d, int s, int share) {
  Drive big = d;
  big.h = share * d.h;
  Look before = looks_[1];
  // From the middle of the last share to that of the next two, in shares.
  const bool near = (before.x - looks_[0].x).cwiseAbs().maxCoeff() < kFar;
  const double on = near ? 1.5 : 0;
  before.M += on * (before.M - looks_[0].M);
  before.Cv += on * (before.Cv - looks_[0].Cv);
  before.J += on * (before.J - looks_[0].J);
  Stride stride(big, before, x_, v_);
  Vec<N> x = x_, v = v_;
  for (int i = 0; i < 2; ++i) {
    Look& look = looks_[static_cast<std::size_t>(i)];
    look.x = x;
    look.v = v;
    const Vec<N> dv = step(stride, (s + (i + 0.5) * share) * d.h, x, v);
    look.x += big.h / 2 * (look.v + dv / 3);
    look.v += dv / 2;
    look.angles = arm_.turned(before.angles, look.x - before.x);
  }
  look(d.mass > 0, d.gravity);
}

template <int N>
void VirtualArm<N>::live(const Parameters& p, const Vec<N>& torque, const HandInput& hand) {
  const NoSubnormals fast_at_rest;
  const Drive d = drive(p, torque, hand);
  looks_[1].angles = arm_.angles(looks_[1].x);  // anew each tick: turned ones drift
  hand_torque_.setZero();
  for (int s = 0; s < p.substeps;) {
    const int share = std::min(kShare, (p.substeps - s + 1) / 2);
    look_ahead(d, s, share);
    for (const Look& look : looks_) {
      const int next = std::min(s + share, p.substeps);
      Stride stride(d, look, x_, v_);
      for (; s < next; ++s) step(stride, (s + 0.5) * d.h, x_, v_);
      hand_torque_.noalias() += look.J.transpose() * stride.force;
    }
  }
  hand_torque_ /= p.substeps;
  if (!hand.torque.empty()) {
    hand_torque_ += Eigen::Map<const Vec<N>>(hand.torque.data(), x_.size());
  }
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
template class VirtualDevice<7>;
template class VirtualDevice<kAnyDof>;
template class VirtualArm<3>;
template class VirtualArm<7>;
template class VirtualArm<kAnyDof>;

}  // namespace limpid
