// A hand that shakes or presses the built-in arm sideways at its tip.
#pragma once

#include <string>

#include "app/study/experiment.h"
#include "app/study/signals.h"

namespace limpid {

struct FeltSetting {
  CouplingKind kind = CouplingKind::proposed;
  double eta = 1;
  double wall = 0;  // beside the tip [N/m], 0: free space
};

// Only the first joint turns, so that everything is scalar.
class SidewaysBench {
 public:
  static constexpr int kJoint = 0;
  static constexpr double kArm = 0.19;                    // of the tip about its axis [m]
  static constexpr double kTick = 0.001;                  // [s]
  static constexpr double kPeriod = 2, kSettle = 2;       // of the shaking [s]
  static constexpr double kLowest = 0.5, kHighest = 200;  // [Hz]
  static constexpr double kSpeed = 2e-3;                  // at each frequency [m/s]
  // Soft, and undamped in free space: a damper would answer to the steps in the target's rate from
  // tick to tick. At a wall the hand must damp, or the proposed coupling is unstable.
  static constexpr double kGrip = 100;       // [N/m]
  static constexpr double kGripDamping = 2;  // [N s/m]
  static constexpr double kPress = 1;        // mean force at a wall [N]

  explicit SidewaysBench(std::uint64_t seed)
      : seed_(seed), shaking_(multisine(1 / kPeriod, kLowest, kHighest, 40, kSpeed, seed)) {}

  const Multisine& shaking() const { return shaking_; }
  // The rows from settled() on last one period of the shaking, and one row more.
  Trial shaken(const FeltSetting& setting) const;
  static std::size_t settled();
  // Presses the wall and stays.
  Trial pressed(const FeltSetting& setting) const;

 private:
  std::uint64_t seed_;
  Multisine shaking_;
};

}  // namespace limpid
