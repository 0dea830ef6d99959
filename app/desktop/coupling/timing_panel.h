// Panel of timing: lateness of loop and device, its cost in stiffness, and the cost of a picture.
#pragma once

#include <span>
#include <string>

#include "app/live/device_pace.h"
#include "app/live/live_loop.h"
#include "app/run/tip_limits.h"

namespace limpid {

// Words for late ticks. With motors they are dropped at once, else caught up as far as possible.
struct LateTicks {
  const char* missed;
  const char* slipped;
  const char* after_a_slip;
};
LateTicks late_ticks(bool motors);

// Draws shares of times, 1 us to 100 ms, both axes logarithmic; red above `late` [s].
void draw_time_histogram(const LatencyHistogram& histogram, double late, const char* help);

// Draws the loop's timing. `quality` of the picture in words; `frame_time`: work for one picture
// [s].
void draw_timing(const LiveLoop& loop, const std::string& quality, double frame_time);

// Timing of the device in the loop, and the cost of its pace.
class DeviceTiming {
 public:
  // Draws into the open ImGui window. `x`: the arm's pose [rad].
  void draw(const DevicePace& pace, const ArmDescription& arm, const Parameters& p,
            const Scene& scene, std::span<const double> x);

 private:
  void draw_cost(const DevicePace::Figures& pace, const ArmDescription& arm,
                 const Parameters& p) const;

  TipLimits now_, prompt_;  // at the device's pace, and without its delay
  double due_ = 0;          // when they are computed again [s of ImGui's time]
};

}  // namespace limpid
