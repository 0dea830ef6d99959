// What there is to say against force on a device that must be guarded.
#pragma once

#include <array>

#include "core/dynamics/arm.h"
#include "core/tick/arming.h"

namespace limpid {

// What a device, and whoever watches it, says at a tick.
struct DeviceHealth {
  bool guarded = false;  // the limits hold; else nothing below is judged
  bool hand = true;
  bool fault = false;
  bool lost = false;
  double age = 0;      // of the reading [s]
  bool gap = false;    // the device was without torque, or the loop stood still, before this tick
  double silence = 0;  // since the window last answered [s]
};

struct SafetyLimits {
  static constexpr double kStaleReading = 0.005;  // [s]
  static constexpr double kFade = 1.5;            // force is gone at so many times a limit
  static constexpr double kOverrun = 0.1;  // beyond a joint's range, where force is gone [rad]
  static constexpr double kSlew = 0.02;    // from no torque to the limit [s]
  static constexpr double kGap = 0.005;    // between two ticks; more is a stall [s]
  static constexpr double kSilence = 0.2;  // of the window; at twice of it force is gone [s]

  double joint_speed = 15;  // [rad/s]
  double tip_speed = 2;     // [m/s]
  double tip_force = 10;    // [N]
  double energy = 1.5;      // put out by the motors, forgotten within a second [J]
  double range = 1;         // of each joint's range, about its middle [-]

  friend bool operator==(const SafetyLimits&, const SafetyLimits&) = default;
};

// The limits that can be lowered for a device, for files and panels. What they are by default is
// the most they can be.
struct SafetyLimitInfo {
  const char* key;
  const char* label;
  const char* unit;
  double SafetyLimits::*field;
  double least;
};
inline constexpr std::array<SafetyLimitInfo, 5> kSafetyLimitInfo{{
    {"joint_speed", "joint speed", "rad/s", &SafetyLimits::joint_speed, 0.5},
    {"tip_speed", "tip speed", "m/s", &SafetyLimits::tip_speed, 0.05},
    {"tip_force", "tip force", "N", &SafetyLimits::tip_force, 0.1},
    {"energy", "energy in a second", "J", &SafetyLimits::energy, 0.02},
    {"range", "part of the range", "", &SafetyLimits::range, 0.1},
}};
// Within what can be set; what is no number is as by default.
SafetyLimits allowed(SafetyLimits wanted);

// Judges once a tick. What is dangerous to come back from by itself trips.
template <int N>
class Safety {
 public:
  explicit Safety(const ArmDescription& arm);

  void start();
  void limit(const SafetyLimits& wanted);

  // `v` [rad/s]; `J` of the tip. `put_out`: work of the motors over the last tick of T [J].
  Objections judge(const DeviceHealth& health, bool diverged, const Vec<N>& x, const Vec<N>& v,
                   const Jacobian<N>& J, double put_out, double T);

  // The torque with the force at the tip within its limit.
  Vec<N> within_tip_force(const Vec<N>& tau, const Jacobian<N>& J) const;

 private:
  SafetyLimits limits_;
  Vec<N> arm_lower_, arm_upper_, lower_, upper_;  // [rad]
  Vec<N> v_;                                      // smoothed [rad/s]
  double energy_ = 0;
};

extern template class Safety<3>;
extern template class Safety<7>;
extern template class Safety<kAnyDof>;

}  // namespace limpid
