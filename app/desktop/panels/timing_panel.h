// How well the loop and its device keep time, what that costs in stiffness, and what a picture
// costs.
#pragma once

#include <span>
#include <string>

#include "app/live/device_pace.h"
#include "app/live/live_loop.h"
#include "app/run/tip_limits.h"

namespace limpid {

// What becomes of late ticks, for people. With motors they are given up at once, else caught up as
// far as that goes.
struct LateTicks {
  const char* missed;
  const char* slipped;
  const char* after_a_slip;
};
LateTicks late_ticks(bool motors);

// Shares of times on a logarithmic axis from 1 us to 100 ms, both axes logarithmic; above `late`
// [s] they are red.
void draw_time_histogram(const LatencyHistogram& histogram, double late, const char* help);

// `quality` of the picture in words; `frame_time`: work for one picture [s].
void draw_timing(const LiveLoop& loop, const std::string& quality, double frame_time);

// Of the device in the loop, and what its pace costs.
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
