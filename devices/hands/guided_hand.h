// A hand led by a device with six axes and no force, as a SpaceMouse.
#pragma once

#include <algorithm>
#include <cmath>

#include "devices/device.h"

namespace limpid {

// The cap's deflection is a speed: where the hand wants the tip moves on as long as it is pushed.
// Little near the middle, so that it can be led finely.
class GuidedHand {
 public:
  void reset(const Vec3& at) { goal_ = at; }

  // One tick of length T [s]. True while the cap is off its rest.
  bool step(const DeviceReading& reading, double T) {
    // Of the cap x points right, y to the user, z down; of the arm x points away, y left, z up.
    const Vec3 push(-axis(reading.x[1]), -axis(reading.x[0]), -axis(reading.x[2]));
    goal_ += kFastest * T * push;
    return push.squaredNorm() > 0;
  }
  const Vec3& goal() const { return goal_; }
  // No further than this from where the tip is: the hand does not wander off [m].
  void stay_near(const Vec3& tip, double distance) {
    const Vec3 out = goal_ - tip;
    if (out.norm() > distance) goal_ = tip + distance / out.norm() * out;
  }

 private:
  static constexpr double kRest = 0.06;     // of the full deflection
  static constexpr double kFastest = 0.25;  // [m/s]

  static double axis(double deflection) {
    const double part = std::clamp((std::abs(deflection) - kRest) / (1 - kRest), 0.0, 1.0);
    return std::copysign(part * part, deflection);
  }

  Vec3 goal_ = Vec3::Zero();
};

}  // namespace limpid
