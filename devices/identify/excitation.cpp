#include "devices/identify/excitation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace limpid {
namespace {

using std::numbers::pi;

constexpr double kFollow = 2 * pi * 5;  // bandwidth on the guessed inertia [rad/s]
constexpr double kZeta = 0.7;
constexpr double kSmooth = 0.004;   // time constant of the velocity's filter [s]
constexpr double kIntegral = 2;     // integral gain on the error [1/s]
constexpr double kEnvelope = 1;     // fade in and out of each part [s]
constexpr double kFade = 0.5;       // fade at the end [s]
constexpr double kApproach = 0.4;   // speed towards the middle [rad/s]
constexpr double kPatience = 0.6;   // longest time that a joint may not follow [s]
constexpr double kSweep = 1.0 / 3;  // periods a second [Hz]

// Weight from 0 to 1 and back within a part of this length, smooth.
double envelope(double t, double length) {
  const double edge = std::min({1.0, t / kEnvelope, (length - t) / kEnvelope});
  return edge > 0 ? 0.5 - 0.5 * std::cos(pi * edge) : 0;
}

}  // namespace

const char* explain(ExcitationEnd end) {
  switch (end) {
    case ExcitationEnd::running: return "running";
    case ExcitationEnd::complete: return "complete";
    case ExcitationEnd::cancelled: return "cancelled";
    case ExcitationEnd::not_well: return "the device no longer answered correctly";
    case ExcitationEnd::let_go: return "the hand released the device's hand switch";
    case ExcitationEnd::limit: return "a safety limit was reached";
    case ExcitationEnd::held: return "a joint did not follow: something holds the device";
  }
  return "";
}

Excitation::Excitation(const ArmDescription& arm, const DeviceTraits& traits,
                       const ExcitationPlan& plan)
    : arm_(arm), plan_(plan), safety_(arm), motors_(arm.dof()) {
  const int n = arm.dof();
  if (!traits.pushes) throw std::invalid_argument(fmt::format("{} has no motors", traits.name));
  if (std::ranges::find(traits.effort, 0.0) != traits.effort.end()) {
    throw std::invalid_argument(
        fmt::format("{} has a joint without a motor; only a device with a motor at every joint can "
                    "be identified",
                    traits.name));
  }
  if (traits.dof != n) {
    throw std::invalid_argument(fmt::format("{} has {} joints, but the arm '{}' has {}",
                                            traits.name, traits.dof, arm.name, n));
  }
  safety_.limit(plan.limits);
  const Vector zero = Vector::Zero(n);
  start_ = x_ = v_ = wish_ = sum_ = away_ = torque_ = zero;
  middle_ = rest_pose(arm);
  amplitude_ = limit_ = zero;
  for (int j = 0; j < n; ++j) {
    const Joint& joint = arm.joints[static_cast<std::size_t>(j)];
    const double half = plan.range * (joint.upper - joint.lower) / 2;
    // The middle is a pose at rest, which may not be the middle of the range.
    const double room = 0.9 * std::min(middle_[j] - joint.lower, joint.upper - middle_[j]);
    amplitude_[j] = std::min({plan.amplitude, half, room});
    limit_[j] = plan.torque * std::min(joint.effort, traits.effort[static_cast<std::size_t>(j)]);
    auto& tones = frequency_[static_cast<std::size_t>(j)];
    auto& share = share_[static_cast<std::size_t>(j)];
    // Each joint has tones of its own. High ones are small, as accelerations matter.
    double sum = 0;
    for (int m = 0; m < kTones; ++m) {
      const auto M = static_cast<std::size_t>(m);
      tones[M] = (0.23 + 0.61 * m) * (1 + 0.083 * (j % 7));
      share[M] = 1 / std::sqrt(1 + tones[M] * tones[M]);
      sum += share[M];
    }
    for (double& s : share) s *= 1.6 / sum;  // phases differ: the peak is well below the sum
  }
  Arm<kAnyDof>::Frames f;
  Mat<kAnyDof> M;
  Jacobian<kAnyDof> J;
  arm_.frames(middle_, f);
  arm_.inertia(f, M);
  arm_.point_jacobian(f, n - 1, arm_.tip(f), J);
  for (double& a : amplitude_) a = std::isfinite(a) ? a : plan.amplitude;
  moderate(J);
  stiffness_ = kFollow * kFollow * M.diagonal();
  damping_ = 2 * kZeta * kFollow * M.diagonal();
  duration_ = n * plan.sweep + plan.shake + kFade;  // begin() adds the approach
}

// Limits amplitudes so that joints and tip stay well below their greatest speed. The peak of so
// many tones is about two and a half times their root mean square.
void Excitation::moderate(const Jacobian<kAnyDof>& J) {
  constexpr double kPeak = 2.5, kPart = 0.75;
  double tip2 = 0, joint = 0;
  for (Eigen::Index j = 0; j < amplitude_.size(); ++j) {
    double rate2 = 0;
    for (std::size_t m = 0; m < kTones; ++m) {
      const auto i = static_cast<std::size_t>(j);
      rate2 += 0.5 * std::pow(2 * pi * frequency_[i][m] * share_[i][m] * amplitude_[j], 2);
    }
    tip2 += J.col(j).squaredNorm() * rate2;
    joint = std::max(joint, std::sqrt(rate2));
  }
  const double tip = kPeak * std::sqrt(tip2);
  amplitude_ *= std::min({1.0, kPart * plan_.limits.tip_speed / tip,
                          kPart * plan_.limits.joint_speed / (kPeak * joint)});
}

void Excitation::finish(ExcitationEnd end) noexcept {
  if (end_ != ExcitationEnd::running) return;
  end_ = end;
  torque_.setZero();
}

void Excitation::begin(const Vector& x) noexcept {
  start_ = x_ = x;
  approach_ = std::max(1.5, (middle_ - start_).cwiseAbs().maxCoeff() / kApproach);
  duration_ += approach_;
  started_ = true;
}

// Sum of a joint's tones at time t, from -1 to 1.
double Excitation::reach(Eigen::Index joint, double t) const noexcept {
  const auto j = static_cast<std::size_t>(joint);
  double sum = 0;
  for (std::size_t m = 0; m < kTones; ++m) {
    const double phase = pi * static_cast<double>(m * m) / kTones;  // Schroeder's phases
    sum += share_[j][m] * std::sin(2 * pi * frequency_[j][m] * t - phase);
  }
  return std::clamp(sum, -1.0, 1.0);
}

Excitation::Vector Excitation::wanted(double time) noexcept {
  const Eigen::Index n = middle_.size();
  stage_ = ExcitationStage::approach;
  if (time < approach_) {
    const double part = 0.5 - 0.5 * std::cos(pi * time / approach_);
    return start_ + part * (middle_ - start_);
  }
  Vector r = middle_;
  double t = time - approach_;
  const double sweeps = static_cast<double>(n) * plan_.sweep;
  if (t < sweeps) {
    stage_ = ExcitationStage::sweep;
    joint_ = static_cast<int>(t / plan_.sweep);
    t -= joint_ * plan_.sweep;
    r[joint_] += amplitude_[joint_] * envelope(t, plan_.sweep) * std::sin(2 * pi * kSweep * t);
    return r;
  }
  t -= sweeps;
  stage_ = t < plan_.shake ? ExcitationStage::shake : ExcitationStage::fade;
  const double part = envelope(t, plan_.shake);
  for (Eigen::Index j = 0; j < n; ++j) r[j] += part * amplitude_[j] * reach(j, t);
  return r;
}

bool Excitation::follows(const Vector& error, const Vector& torque, double T) noexcept {
  for (Eigen::Index j = 0; j < error.size(); ++j) {
    const bool astray =
        std::abs(error[j]) > 0.8 * amplitude_[j] + 0.05 || std::abs(torque[j]) >= limit_[j];
    away_[j] = astray ? away_[j] + T : 0;
    if (away_[j] <= kPatience) continue;
    joint_ = static_cast<int>(j);
    return false;
  }
  return true;
}

std::span<const double> Excitation::step(const Tick& in) noexcept {
  const auto n = static_cast<std::size_t>(middle_.size());
  const std::span<const double> answer(torque_.data(), n);
  if (end_ != ExcitationEnd::running) return answer;
  const Vector x = Eigen::Map<const Vector>(in.x.data(), middle_.size());
  const bool first = !started_;
  if (first) begin(x);
  const double put_out = torque_.dot(x - x_);
  v_ += in.T / (kSmooth + in.T) * ((x - x_) / in.T - v_);
  x_ = x;

  const Vector before = wish_;
  wish_ = wanted(time_);
  const Vector rate =
      first ? Vector(Vector::Zero(middle_.size())) : Vector((wish_ - before) / in.T);
  const Vector error = wish_ - x;
  sum_ =
      (sum_ + in.T * kIntegral * stiffness_.cwiseProduct(error)).cwiseMin(limit_).cwiseMax(-limit_);
  Vector torque = stiffness_.cwiseProduct(error) + damping_.cwiseProduct(rate - v_) + sum_;
  const double left = duration_ - time_;
  if (stage_ == ExcitationStage::fade) torque *= std::clamp(left / kFade, 0.0, 1.0);

  Arm<kAnyDof>::Frames f;
  Jacobian<kAnyDof> J;
  arm_.frames(x, f);
  arm_.point_jacobian(f, arm_.dof() - 1, arm_.tip(f), J);
  // Joints stand still where a sweep turns round, by friction and coarse encoders. follows()
  // therefore judges them by their distance from the path, and Safety is told of no torque.
  const Vector none = Vector::Zero(x.size());
  const Objections against =
      safety_.judge(in.health, !torque.allFinite(), {x, v_, J, none, put_out, in.T});
  gate_.step(first ? ForceRequest::arm : ForceRequest::as_it_is, against, in.T);
  torque_ = motors_.pass(torque, {limit_, J, safety_.tip_force()}, gate_.gain(), in.T,
                         SafetyLimits::kSlew);

  // An open switch cuts the device's torque, which also looks like a gap.
  if (!in.health.hand) finish(ExcitationEnd::let_go);
  if (against.fault != ForceState::on || against.gap) finish(ExcitationEnd::not_well);
  if (against.ceiling < 1) finish(ExcitationEnd::limit);
  if (!follows(error, torque, in.T)) finish(ExcitationEnd::held);
  time_ += in.T;
  if (left <= 0) finish(ExcitationEnd::complete);
  return answer;
}

}  // namespace limpid
