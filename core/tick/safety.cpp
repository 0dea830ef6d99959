#include "core/tick/safety.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace limpid {
namespace {

constexpr double kSmooth = 0.005;  // of the velocity that is judged: encoders have steps [s]
constexpr double kForget = 1;      // of the energy put out [s]

// Full force up to the limit, none beyond `gone`.
void fade(Objections& against, ForceState reason, double value, double limit, double gone) {
  if (!(value > limit)) return;
  const double part = std::max(0.0, (gone - value) / (gone - limit));
  if (part >= against.ceiling) return;
  against.ceiling = part;
  against.limited = reason;
}

ForceState fault_of(const DeviceHealth& health) {
  if (health.lost) return ForceState::lost;
  if (health.fault) return ForceState::fault;
  if (!(health.age <= SafetyLimits::kStaleReading)) return ForceState::stale;
  return ForceState::on;
}

}  // namespace

const char* explain(ForceState state) {
  switch (state) {
    case ForceState::on: return "on";
    case ForceState::off: return "not armed";
    case ForceState::no_hand: return "the hand does not hold the device";
    case ForceState::stale: return "the device gave no reading for 5 ms";
    case ForceState::fault: return "the device reports a fault";
    case ForceState::lost: return "the device is not connected";
    case ForceState::too_fast: return "the device moves too fast";
    case ForceState::too_far: return "a joint is out of its range";
    case ForceState::energy: return "the motors put out too much energy";
    case ForceState::diverged: return "the loop became unstable";
    case ForceState::unwatched: return "the window did not answer for 0.2 s";
    case ForceState::stalled: return "the loop stood still for more than 5 ms";
  }
  return "";
}

SafetyLimits allowed(SafetyLimits wanted) {
  const SafetyLimits most;
  for (const SafetyLimitInfo& info : kSafetyLimitInfo) {
    double& value = wanted.*info.field;
    value = std::isnan(value) ? most.*info.field : std::clamp(value, info.least, most.*info.field);
  }
  return wanted;
}

template <int N>
Safety<N>::Safety(const ArmDescription& arm)
    : arm_lower_(Vec<N>::Zero(arm.dof())), arm_upper_(Vec<N>::Zero(arm.dof())) {
  for (int i = 0; i < arm.dof(); ++i) {
    arm_lower_[i] = arm.joints[static_cast<std::size_t>(i)].lower;
    arm_upper_[i] = arm.joints[static_cast<std::size_t>(i)].upper;
  }
  limit({});
  start();
}

template <int N>
void Safety<N>::start() {
  v_ = Vec<N>::Zero(lower_.size());
  energy_ = 0;
}

// A joint without a stop on one side keeps its range as it is.
template <int N>
void Safety<N>::limit(const SafetyLimits& wanted) {
  limits_ = allowed(wanted);
  lower_ = arm_lower_;
  upper_ = arm_upper_;
  for (Eigen::Index i = 0; i < lower_.size(); ++i) {
    const double off = (1 - limits_.range) / 2 * (arm_upper_[i] - arm_lower_[i]);
    if (!(off > 0) || std::isinf(off)) continue;
    lower_[i] += off;
    upper_[i] -= off;
  }
}

template <int N>
Objections Safety<N>::judge(const DeviceHealth& health, bool diverged, const Vec<N>& x,
                            const Vec<N>& v, const Jacobian<N>& J, double put_out, double T) {
  Objections against;
  if (diverged) against.fault = ForceState::diverged;
  if (!health.guarded) return against;
  if (health.gap) v_ = v;
  v_ += std::min(1.0, T / kSmooth) * (v - v_);
  energy_ = std::max(0.0, energy_ * std::max(0.0, 1 - T / kForget) + put_out);
  against.hand = health.hand;
  against.gap = health.gap;
  if (against.fault == ForceState::on) against.fault = fault_of(health);
  if (health.gap && against.fault == ForceState::stale) {
    // Whoever stood still has no new reading yet: that is not the device's silence.
    against.fault = ForceState::on;
    against.hand = false;
  }
  const auto gone = [](double limit) { return SafetyLimits::kFade * limit; };
  fade(against, ForceState::too_fast, v_.cwiseAbs().maxCoeff(), limits_.joint_speed,
       gone(limits_.joint_speed));
  fade(against, ForceState::too_fast, (J * v_).norm(), limits_.tip_speed, gone(limits_.tip_speed));
  fade(against, ForceState::too_far, std::max((x - upper_).maxCoeff(), (lower_ - x).maxCoeff()), 0,
       SafetyLimits::kOverrun);
  fade(against, ForceState::energy, energy_, limits_.energy, gone(limits_.energy));
  fade(against, ForceState::unwatched, health.silence, SafetyLimits::kSilence,
       2 * SafetyLimits::kSilence);
  if (against.fault != ForceState::on) return against;
  if (energy_ > gone(limits_.energy)) against.fault = ForceState::energy;
  if (health.silence >= 2 * SafetyLimits::kSilence) against.fault = ForceState::unwatched;
  return against;
}

// The smallest force at the tip that makes this torque, as far as a force there can.
template <int N>
Vec<N> Safety<N>::within_tip_force(const Vec<N>& tau, const Jacobian<N>& J) const {
  Mat3 A = J * J.transpose();
  A.diagonal().array() += 1e-9 * (A.trace() + 1e-12);  // stretched out, or in a plane
  const Vec3 b = J * tau;
  const double force = A.ldlt().solve(b).norm();
  if (!(force > limits_.tip_force)) return tau;
  return tau * (limits_.tip_force / force);
}

template class Safety<3>;
template class Safety<7>;
template class Safety<kAnyDof>;

}  // namespace limpid
