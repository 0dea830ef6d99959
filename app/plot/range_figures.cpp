#include "app/plot/range_figures.h"

#include <cmath>
#include <limits>

namespace limpid {

RangeFigures figures_between(const History& history, int channel, double start, double stop) {
  RangeFigures found;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double sum = 0, squares = 0, low = kInfinity, high = -kInfinity;
  for (SampleIndex row = history.lower_bound(start);
       row < history.end() && history.time(row) <= stop; ++row) {
    const auto value = static_cast<double>(history.value(channel, row));
    if (!std::isfinite(value)) continue;
    ++found.count;
    sum += value;
    squares += value * value;
    low = value < low ? value : low;
    high = value > high ? value : high;
  }
  if (found.count == 0) {
    found.mean = found.rms = found.low = found.high = std::numeric_limits<double>::quiet_NaN();
    return found;
  }
  const auto count = static_cast<double>(found.count);
  found.mean = sum / count;
  found.rms = std::sqrt(squares / count);
  found.low = low;
  found.high = high;
  return found;
}

}  // namespace limpid
