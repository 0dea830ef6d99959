// How well the device in the loop keeps time, and what that costs in stiffness.
#pragma once

#include <span>

#include "app/live/device_pace.h"
#include "app/run/tip_limits.h"

namespace limpid {

class DeviceTiming {
 public:
  // Draws into the ImGui window that is open. `x`: the arm's pose [rad].
  void draw(const DevicePace& pace, const ArmDescription& arm, const Parameters& p,
            const Scene& scene, std::span<const double> x);

 private:
  void draw_cost(const DevicePace::Figures& pace, const ArmDescription& arm,
                 const Parameters& p) const;

  TipLimits now_, prompt_;  // as it is, and without its delay
  double due_ = 0;          // when to reckon again [s of ImGui's time]
};

}  // namespace limpid
