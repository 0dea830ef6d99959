// Value axes of plots: limits that follow the data without fidgeting, mapping, labels.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "app/plot/plot_spec.h"

namespace limpid {

struct Limits {
  double low = 0;
  double high = 1;

  double span() const { return high - low; }
  friend bool operator==(const Limits&, const Limits&) = default;
};

// Limits that grow at once where data would be cut off. They shrink only after the data has left
// much of the axis unused for a while, and glide to round numbers.
class Autoscale {
 public:
  // `data`: what has to be visible; `smallest_span` > 0: the axis never shows less than that;
  // `elapsed` [s] since the last call. Returns the limits to draw with.
  Limits update(const Limits& data, double smallest_span, double elapsed);

  // The next update() jumps to the data.
  void reset() { shown_.reset(); }

 private:
  std::optional<Limits> shown_;
  Limits target_;
  double unused_for_ = 0;  // [s]
};

// Mapping of values to places along an axis, linear or logarithmic.
struct AxisMap {
  Limits limits;  // for a logarithmic axis: of the decimal logarithm
  bool log = false;

  // Returns 0 at the low end, 1 at the high one.
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

// A line of a value axis, and its label.
struct AxisPlace {
  double value;       // in the channels' unit
  std::string label;  // empty: a line of the grid alone
};

// Returns at most about `most` labels, from the low end to the high one.
std::vector<AxisPlace> axis_places(const PlotAxis& axis, const AxisMap& map, double most);

// Returns the factor of the labels and their unit.
std::string unit_text(const PlotAxis& axis, const AxisMap& map);

}  // namespace limpid
