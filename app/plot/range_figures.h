// Figures of a stretch of time, channel by channel.
#pragma once

#include <cstddef>

#include "app/plot/history.h"

namespace limpid {

// Figures of a channel's rows from start to stop [s on the history's axis] that are numbers, in the
// channel's unit. Without any such row all but the count are not numbers.
struct RangeFigures {
  std::size_t count = 0;
  double mean = 0;
  double rms = 0;  // the root of the mean square
  double low = 0, high = 0;
};
RangeFigures figures_between(const History& history, int channel, double start, double stop);

}  // namespace limpid
