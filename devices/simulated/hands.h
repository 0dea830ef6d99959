// Hands that hold the arm: one moved by the mouse, one led by a device without force.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/elementary.h"
#include "devices/device.h"

namespace limpid {

// A hand led by a device with six axes and no force, as a SpaceMouse. The cap's deflection is a
// speed: where the hand wants the tip moves on as long as the cap is pushed, slowly near the middle
// for fine motions.
class GuidedHand {
 public:
  void reset(const Vec3& at) { goal_ = at; }

  // Takes one tick of length T [s]. True while the cap is off its rest.
  bool step(const DeviceReading& reading, double T) {
    // The cap's x points right, y to the user, z down; the arm's x points away, y left, z up.
    const Vec3 push(-axis(reading.x[1]), -axis(reading.x[0]), -axis(reading.x[2]));
    goal_ += kFastest * T * push;
    return push.squaredNorm() > 0;
  }
  const Vec3& goal() const { return goal_; }
  // Keeps the goal within `distance` of the tip, so that the hand does not wander off [m].
  void stay_near(const Vec3& tip, double distance) {
    const Vec3 out = goal_ - tip;
    if (out.norm() > distance) goal_ = tip + distance / out.norm() * out;
  }

 private:
  static constexpr double kRest = 0.06;     // part of the full deflection
  static constexpr double kFastest = 0.25;  // [m/s]

  static double axis(double deflection) {
    const double part = std::clamp((std::abs(deflection) - kRest) / (1 - kRest), 0.0, 1.0);
    return std::copysign(part * part, deflection);
  }

  Vec3 goal_ = Vec3::Zero();
};

// A hand moved by the mouse, whose 60 to 125 events a second become a smooth path at the tick rate.
// The target follows the mouse as a critically damped second-order system of a hand's bandwidth,
// stepped exactly. The grip closes and opens within a twentieth of a second. The hand pulls with a
// few newtons at most: its target stays that near to the tip. A hand that has let go stays with the
// tip, so that it takes hold again there.
class MouseHand {
 public:
  void reset(const Vec3& at) {
    target_ = at;
    rate_.setZero();
    grip_ = 0;
  }

  // Takes one tick of length T [s]. `goal` is where the mouse wants the tip, `tip` where it is [m];
  // `stiffness` is the grip's [N/m].
  HandInput step(bool grab, const Vec3& goal, const Vec3& tip, double stiffness, double T) {
    grip_ = std::clamp(grip_ + (grab ? T : -T) / kGripTime, 0.0, 1.0);
    if (grip_ == 0) {
      target_ = tip;
      rate_.setZero();
    } else if (grab) {
      // x(t) = goal + (c0 + c1 t) exp(-w t)
      const Vec3 c0 = target_ - goal;
      const Vec3 c1 = rate_ + kBandwidth * c0;
      const double decay = exponential(-kBandwidth * T);
      target_ = goal + (c0 + c1 * T) * decay;
      rate_ = (c1 - kBandwidth * (c0 + c1 * T)) * decay;
      const double stretch = (target_ - tip).norm();
      const double longest = kStrength / stiffness;
      if (stretch > longest) target_ = tip + (target_ - tip) * (longest / stretch);
    }
    return {target_, grip_};
  }

 private:
  static constexpr double kBandwidth = 2 * 3.14159265358979323846 * 8;  // [rad/s]
  static constexpr double kGripTime = 0.05;                             // [s]
  static constexpr double kStrength = 3;                                // [N]

  Vec3 target_ = Vec3::Zero();
  Vec3 rate_ = Vec3::Zero();
  double grip_ = 0;
};

}  // namespace limpid
