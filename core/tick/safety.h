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
  // Of readings while the motors push; at twice of it force is gone [s].
  static constexpr double kStill = 0.3;
  // What is less of a joint's limit, and of the most force at the tip, is no push [-].
  static constexpr double kPush = 0.05;

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

// What a device did over a tick, and under which torque.
template <int N>
struct DrivenTick {
  const Vec<N>& x;       // where it is after it, as measured [rad]
  const Vec<N>& v;       // [rad/s]
  const Jacobian<N>& J;  // of the tip
  const Vec<N>& tau;     // that the motors held [N m]
  double put_out;        // their work [J]
  double T;              // [s]
};

// Judges once a tick. What is dangerous to come back from by itself trips.
//
// Readings that come but stand still, as those of an encoder with a broken wire or of a service
// that repeats itself, look like a device that is held still. A device that is well shows it: its
// force is faded out as if its readings were frozen, and as soon as any of them moves, the force
// comes back. Where a hand holds it against a wall that takes a few milliseconds, as the hand moves
// on when the wall yields. Where nothing has moved when the force is gone, it trips, and arming
// helps no sooner than something has moved.
template <int N>
class Safety {
 public:
  explicit Safety(const ArmDescription& arm);

  void start();
  void limit(const SafetyLimits& wanted);

  Objections judge(const DeviceHealth& health, bool diverged, const DrivenTick<N>& last);

  double tip_force() const { return limits_.tip_force; }  // that the tip may have [N]

 private:
  void watch_readings(const DrivenTick<N>& last);
  bool pushed(const DrivenTick<N>& last) const;

  SafetyLimits limits_;
  Vec<N> arm_lower_, arm_upper_, lower_, upper_;  // [rad]
  Vec<N> arm_effort_;                             // [N m]
  Vec<N> v_;                                      // smoothed [rad/s]
  Vec<N> x_;                                      // the last reading [rad]
  double energy_ = 0;
  double still_ = 0;  // how long the motors have pushed since a reading last moved [s]
};

extern template class Safety<3>;
extern template class Safety<7>;
extern template class Safety<kAnyDof>;

}  // namespace limpid
