// Where the values of an axis stand in a map, and what they are called.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/sweep/sweep_plan.h"

namespace limpid {

// From half a step before to half a step after each value; words stand at 0, 1, ...
class AxisCells {
 public:
  explicit AxisCells(const SweepAxis& axis);
  std::pair<double, double> around(double x) const;
  std::pair<double, double> all() const {
    return {around(values_.front()).first, around(values_.back()).second};
  }

 private:
  double between(double a, double b) const;
  // As far on the other side of x as half the way to its neighbour.
  double beyond(double x, double neighbour) const;

  bool log_;
  std::vector<double> values_;  // increasing
};

// The axis with that name; without a name the next grid axis of several numbers besides `other`.
std::optional<std::size_t> axis_called(const SweepPlan& plan, const std::string& name,
                                       std::optional<std::size_t> other);

// Where its value at `place` stands.
double axis_at(const SweepAxis& axis, std::size_t place);

// "stiffness [N/m]"; a yes or no has no unit.
std::string label_of(const std::string& name, const std::string& unit);
// "0.45", or the word.
std::string value_text(const SweepAxis& axis, std::size_t place);

}  // namespace limpid
