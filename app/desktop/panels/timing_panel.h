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

// `quality` of the picture in words; `frame_time`: work for one picture [s].
void draw_timing(const LiveLoop& loop, const std::string& quality, double frame_time);

}  // namespace limpid
