// Limits of a value axis that follow the data without fidgeting.
#pragma once

#include <optional>

namespace limpid {

struct Limits {
  double low = 0;
  double high = 1;

  double span() const { return high - low; }
  friend bool operator==(const Limits&, const Limits&) = default;
};

// Grows at once where data would be cut off, shrinks only after the data has left much of the axis
// unused for a while, and glides to round limits.
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

}  // namespace limpid
