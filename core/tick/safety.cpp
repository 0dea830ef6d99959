#include "core/tick/safety.h"

#include <algorithm>
#include <cmath>

#include "core/tick/motor_stage.h"

namespace limpid {
namespace {

constexpr double kSmooth = 0.005;  // filter of the judged velocity: encoders have steps [s]
constexpr double kForget = 1;      // time constant of forgetting the energy put out [s]

// Full force up to `limit`, none beyond `gone`, and none for a value that is no number.
void fade(Objections& against, ForceState reason, double value, double limit, double gone) {
  if (value <= limit) return;
  const double part = std::max(0.0, (gone - value) / (gone - limit));
  if (part >= against.ceiling) return;
  against.ceiling = part;
  against.limited = reason;
}

ForceState fault_of(const DeviceHealth& health) {
  if (health.lost) return ForceState::lost;
  if (health.fault) return ForceState::fault;
  if (health.wrong) return ForceState::wrong;
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
    case ForceState::energy: return "the motors gave too much energy";
    case ForceState::diverged: return "the loop became unstable";
    case ForceState::unwatched: return "the window did not answer for 0.2 s";
    case ForceState::stalled: return "the loop has just started, or stopped for more than 5 ms";
    case ForceState::frozen:
      return "the readings do not change while the motors push: move the device";
    case ForceState::wrong: return "the device reported an impossible position";
  }
  return "";
}

SafetyLimits allowed(SafetyLimits wanted) {
  hold_fields(kSafetyLimits, wanted);
  return wanted;
}

template <int N>
Safety<N>::Safety(const ArmDescription& arm)
    : arm_lower_(of_joints<N>(arm, &Joint::lower)),
      arm_upper_(of_joints<N>(arm, &Joint::upper)),
      arm_effort_(of_joints<N>(arm, &Joint::effort)),
      x_(Vec<N>::Zero(arm.dof())) {
  limit({});
  start();
}

template <int N>
void Safety<N>::start() {
  v_ = Vec<N>::Zero(lower_.size());
  energy_ = 0;
}

// Sets the limits; a joint without a stop on one side keeps its range.
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
bool Safety<N>::pushed(const DrivenTick<N>& last) const {
  constexpr double kLeastForce = SafetyLimits::kPush * SafetyLimits{}.tip_force;  // [N]
  return (last.tau.cwiseAbs().array() > SafetyLimits::kPush * arm_effort_.array()).any() ||
         limpid::tip_force<N>(last.tau, last.J) > kLeastForce;
}

// Counts the time of pushing without movement, however little torque is left; any movement sets it
// to zero.
template <int N>
void Safety<N>::watch_readings(const DrivenTick<N>& last) {
  if (last.x != x_) {
    still_ = 0;
    x_ = last.x;
  } else if (still_ > SafetyLimits::kStill || pushed(last)) {
    still_ += last.T;
  }
}

template <int N>
Objections Safety<N>::judge(const DeviceHealth& health, bool diverged, const DrivenTick<N>& last) {
  Objections against;
  if (diverged) against.fault = ForceState::diverged;
  if (!health.guarded) return against;
  if (health.gap) v_ = last.v;
  v_ += std::min(1.0, last.T / kSmooth) * (last.v - v_);
  energy_ = std::max(0.0, energy_ * std::max(0.0, 1 - last.T / kForget) + last.put_out);
  watch_readings(last);
  against.hand = health.hand;
  against.gap = health.gap;
  if (against.fault == ForceState::on) against.fault = fault_of(health);
  if (health.gap && against.fault == ForceState::stale) {
    // A loop that stood still has no new reading yet: that is not the device's silence.
    against.fault = ForceState::on;
    against.hand = false;
  }
  const auto gone = [](double limit) { return SafetyLimits::kFade * limit; };
  fade(against, ForceState::too_fast, v_.cwiseAbs().maxCoeff(), limits_.joint_speed,
       gone(limits_.joint_speed));
  fade(against, ForceState::too_fast, (last.J * v_).norm(), limits_.tip_speed,
       gone(limits_.tip_speed));
  fade(against, ForceState::too_far,
       std::max((last.x - upper_).maxCoeff(), (lower_ - last.x).maxCoeff()), 0,
       SafetyLimits::kOverrun);
  fade(against, ForceState::energy, energy_, limits_.energy, gone(limits_.energy));
  fade(against, ForceState::unwatched, health.silence, SafetyLimits::kSilence,
       2 * SafetyLimits::kSilence);
  fade(against, ForceState::frozen, still_, SafetyLimits::kStill, 2 * SafetyLimits::kStill);
  if (against.fault != ForceState::on) return against;
  if (energy_ > gone(limits_.energy)) against.fault = ForceState::energy;
  if (still_ >= 2 * SafetyLimits::kStill) against.fault = ForceState::frozen;
  if (health.silence >= 2 * SafetyLimits::kSilence) against.fault = ForceState::unwatched;
  return against;
}

template class Safety<3>;
template class Safety<7>;
template class Safety<kAnyDof>;

}  // namespace limpid
