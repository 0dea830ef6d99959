// Smallest and largest of some values.
#pragma once

#include <algorithm>
#include <limits>

namespace limpid {

struct Extent {
  float low = std::numeric_limits<float>::infinity();
  float high = -std::numeric_limits<float>::infinity();

  bool empty() const { return low > high; }

  // Not a number changes nothing: the order of the comparison matters.
  void include(float value) {
    low = value < low ? value : low;
    high = value > high ? value : high;
  }
  void include(const Extent& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }

  friend bool operator==(const Extent&, const Extent&) = default;
};

}  // namespace limpid
