// Where values lie along an axis, linear or logarithmic.
#pragma once

#include <algorithm>
#include <cmath>

#include "app/plot/autoscale.h"

namespace limpid {

struct AxisMap {
  Limits limits;  // of a logarithmic axis those of the decimal logarithm
  bool log = false;

  // 0 at the low end, 1 at the high one.
  double part(double value) const {
    return ((log ? std::log10(std::max(value, 1e-300)) : value) - limits.low) / limits.span();
  }
  double value(double part) const {
    const double at = limits.low + part * limits.span();
    return log ? std::pow(10, at) : at;
  }
  double low() const { return value(0); }
  double high() const { return value(1); }
};

}  // namespace limpid
