// Force at the tip that asks a hand how it holds the device: a sum of sines along x, y and z.
//
// Each sine has a whole number of periods in the time that is measured, and no two have the same
// number, so the answers to each can be told apart. Between these numbers there are others, which
// show the noise: the hand's own motion, and all that encoder steps and friction make of the sines.
// The distances are uneven, else sums and differences of sines would fall on sines again.
#pragma once

#include <array>
#include <cstddef>

#include "core/dynamics/arm_description.h"

namespace limpid {

class GripProbe {
 public:
  static constexpr double kSettle = 1;    // until the tip's motion repeats itself [s]
  static constexpr double kMeasured = 8;  // time that is measured [s]
  static constexpr double kFade = 0.25;   // at either end [s]
  static constexpr double kDuration = kSettle + kMeasured + kFade;  // [s]
  // Periods of each sine in kMeasured: 2 to 25 Hz.
  static constexpr std::array kLines{18,  25,  31,  41,  47,  57,  63,  72,  81,  87,  97,  104,
                                     111, 121, 127, 137, 144, 151, 161, 168, 175, 185, 191, 200};

  // Axis of one of the lines: 0 x, 1 y, 2 z.
  static int axis_of(int line);

  GripProbe() = default;
  // Chooses the force for an arm at its rest pose. It is small; where friction would hide it, it is
  // larger. It never asks more of a motor than that bears for hours.
  explicit GripProbe(const ArmDescription& arm);

  // Root mean square of the force along each axis [N].
  double strength() const { return strength_; }
  // Force at a time since the begin [N]; zero from kDuration on.
  Vec3 at(double time) const;

 private:
  double strength_ = 0;
};

}  // namespace limpid
