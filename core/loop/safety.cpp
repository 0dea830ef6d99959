#include "core/loop/safety.h"

#include <algorithm>
#include <cmath>

namespace limpid {
namespace {

constexpr double kSmooth = 0.005;  // of the velocity that is judged: encoders have steps [s]
constexpr double kForget = 1;      // of the energy put out [s]

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
  }
  return "";
}

template <int N>
Safety<N>::Safety(const ArmDescription& arm)
    : lower_(Vec<N>::Zero(arm.dof())), upper_(Vec<N>::Zero(arm.dof())) {
  for (int i = 0; i < arm.dof(); ++i) {
    lower_[i] = arm.joints[static_cast<std::size_t>(i)].lower;
    upper_[i] = arm.joints[static_cast<std::size_t>(i)].upper;
  }
  start();
}

template <int N>
void Safety<N>::start() {
  v_ = Vec<N>::Zero(lower_.size());
  state_ = ForceState::off;
  ceiling_ = energy_ = 0;
}

template <int N>
void Safety<N>::trip(ForceState reason) {
  ceiling_ = 0;
  state_ = reason;
  tripped_ = reason;
}

// Full force up to the limit, none beyond `gone`.
template <int N>
void Safety<N>::fade(ForceState reason, double value, double limit, double gone) {
  if (!(value > limit)) return;
  const double part = std::max(0.0, (gone - value) / (gone - limit));
  if (part >= ceiling_) return;
  ceiling_ = part;
  state_ = reason;
}

template <int N>
void Safety<N>::judge(const DeviceHealth& health, bool wanted, bool diverged, const Vec<N>& x,
                      const Vec<N>& v, const Jacobian<N>& J, double put_out, double T) {
  v_ += std::min(1.0, T / kSmooth) * (v - v_);
  energy_ = std::max(0.0, energy_ * (1 - T / kForget) + put_out);
  if (!wanted) tripped_ = ForceState::on;
  ceiling_ = 1;
  state_ = ForceState::on;
  if (diverged) return trip(ForceState::diverged);
  if (!health.real) {
    if (!wanted) ceiling_ = 0, state_ = ForceState::off;
    return;
  }
  if (health.lost) return trip(ForceState::lost);
  if (health.fault) return trip(ForceState::fault);
  if (!(health.age <= SafetyLimits::kStaleReading)) return trip(ForceState::stale);
  if (tripped_ != ForceState::on) return trip(tripped_);
  if (!wanted || !health.hand) {
    ceiling_ = 0;
    state_ = wanted ? ForceState::no_hand : ForceState::off;
    return;
  }
  const auto gone = [](double limit) { return SafetyLimits::kFade * limit; };
  fade(ForceState::too_fast, v_.cwiseAbs().maxCoeff(), limits.joint_speed,
       gone(limits.joint_speed));
  fade(ForceState::too_fast, (J * v_).norm(), limits.tip_speed, gone(limits.tip_speed));
  fade(ForceState::too_far, std::max((x - upper_).maxCoeff(), (lower_ - x).maxCoeff()), 0,
       limits.overrun);
  fade(ForceState::energy, energy_, limits.energy, gone(limits.energy));
  if (energy_ > gone(limits.energy)) trip(ForceState::energy);
}

// The smallest force at the tip that makes this torque, as far as a force there can.
template <int N>
Vec<N> Safety<N>::within_tip_force(const Vec<N>& tau, const Jacobian<N>& J) const {
  Mat3 A = J * J.transpose();
  A.diagonal().array() += 1e-9 * (A.trace() + 1e-12);  // stretched out, or in a plane
  const Vec3 b = J * tau;
  const double force = A.ldlt().solve(b).norm();
  if (!(force > limits.tip_force)) return tau;
  return tau * (limits.tip_force / force);
}

template class Safety<3>;
template class Safety<kAnyDof>;

}  // namespace limpid
