// Limits of a guarded device, and where its force fades.
#pragma once

#include <array>

#include "core/base/field.h"

namespace limpid {

struct SafetyLimits {
  static constexpr double kStaleReading = 0.005;  // [s]
  static constexpr double kFade = 1.5;            // multiple of a limit at which force is gone
  static constexpr double kOverrun = 0.1;  // beyond a joint's range, where force is gone [rad]
  // Bounds of a believable reading. No hand moves a joint so fast: at the end of a lever of 0.1 m,
  // and of a slide, it is 10 m/s, a boxer's fist. No stop yields so far beyond the reported range.
  static constexpr double kFastest = 100;            // [rad/s]
  static constexpr double kOutside = 10 * kOverrun;  // [rad]
  static constexpr double kSlew = 0.02;              // from no torque to the limit [s]
  static constexpr double kGap = 0.005;    // longest time between two ticks; more is a stall [s]
  static constexpr double kSilence = 0.2;  // of the window; at twice this force is gone [s]
  // Stillness of readings under force from which it fades; at twice this it is gone [s].
  static constexpr double kStill = 0.3;
  // Least push, as a share of a joint's limit and of the largest force at the tip [-].
  static constexpr double kPush = 0.05;

  double joint_speed = 15;  // [rad/s]
  double tip_speed = 2;     // [m/s]
  double tip_force = 10;    // [N]
  double energy = 1.5;      // put out by the motors; forgotten within a second [J]
  double range = 1;         // part of each joint's range, about its middle [-]

  friend bool operator==(const SafetyLimits&, const SafetyLimits&) = default;
};

// Limits that can be lowered for a device. Their defaults are the largest values allowed.
inline constexpr auto kSafetyLimits = [] {
  using L = SafetyLimits;
  const auto limit = [](const char* key, const char* caption, double L::*member, double least,
                        const char* unit, const char* meaning) {
    return Field<L>(key, caption, member, {least, L{}.*member, false, unit}, meaning,
                    {least, L{}.*member, true});
  };
  return std::array{
      limit("joint_speed", "joint speed", &L::joint_speed, 0.5, "rad/s",
            "Largest speed of the fastest joint."),
      limit("tip_speed", "tip speed", &L::tip_speed, 0.05, "m/s",
            "Largest speed of the device's tip."),
      limit("tip_force", "tip force", &L::tip_force, 0.1, "N",
            "Largest force of the motors at the tip."),
      limit("energy", "energy in one second", &L::energy, 0.02, "J",
            "Largest energy that the motors may give in one second."),
      limit("range", "part of the range", &L::range, 0.1, "-",
            "Share of each joint's range, around its middle, in which the force is not reduced."),
  };
}();
// Clamps to the allowed range; NaN becomes the default.
SafetyLimits allowed(SafetyLimits wanted);

}  // namespace limpid
