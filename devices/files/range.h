// Which numbers a file may have somewhere.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace limpid {

struct Range {
  double minimum;
  double maximum;
  bool exclusive_minimum = false;
  const char* unit = "";

  // The allowed number nearest to x; `otherwise` in place of what is no number.
  double hold(double x, double otherwise) const {
    if (std::isnan(x)) return otherwise;
    const double least =
        exclusive_minimum ? std::max(minimum, std::numeric_limits<double>::min()) : minimum;
    return std::clamp(x, least, maximum);
  }
};

}  // namespace limpid
