// What a device that must be guarded may do, and when its force fades.
#pragma once

#include <array>

namespace limpid {

struct SafetyLimits {
  static constexpr double kStaleReading = 0.005;  // [s]
  static constexpr double kFade = 1.5;            // force is gone at so many times a limit
  static constexpr double kOverrun = 0.1;  // beyond a joint's range, where force is gone [rad]
  // Beyond these a reading is wrong. No hand moves a joint so fast: at the end of a lever of 0.1 m,
  // and of a slide, it is 10 m/s, a boxer's fist. No stop gives way so far beyond the range that
  // the device says it has.
  static constexpr double kFastest = 100;            // [rad/s]
  static constexpr double kOutside = 10 * kOverrun;  // [rad]
  static constexpr double kSlew = 0.02;              // from no torque to the limit [s]
  static constexpr double kGap = 0.005;              // between two ticks; more is a stall [s]
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

}  // namespace limpid
