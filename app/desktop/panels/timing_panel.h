// How well the loop keeps time, and what a picture costs.
#pragma once

#include <string>

#include "app/live/live_loop.h"

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

}  // namespace limpid
