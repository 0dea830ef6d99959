#include "app/sweep/axis_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace limpid {

AxisCells::AxisCells(const SweepAxis& axis) : log_(axis.logarithmic) {
  for (std::size_t i = 0; i < axis.values.size(); ++i) values_.push_back(axis_at(axis, i));
  std::ranges::sort(values_);
}

std::pair<double, double> AxisCells::around(double x) const {
  const auto i = static_cast<std::size_t>(std::ranges::lower_bound(values_, x) - values_.begin());
  const std::size_t last = values_.size() - 1;
  if (last == 0) return {x - 0.5, x + 0.5};
  const double low = i > 0 ? between(values_[i - 1], x) : beyond(x, values_[1]);
  const double high = i < last ? between(x, values_[i + 1]) : beyond(x, values_[last - 1]);
  return {low, high};
}

double AxisCells::between(double a, double b) const {
  return log_ ? std::sqrt(a * b) : (a + b) / 2;
}

double AxisCells::beyond(double x, double neighbour) const {
  return log_ ? x * std::sqrt(x / neighbour) : x + (x - neighbour) / 2;
}

std::optional<std::size_t> axis_called(const SweepPlan& plan, const std::string& name,
                                       std::optional<std::size_t> other) {
  for (std::size_t a = 0; a < plan.axes.size(); ++a) {
    const SweepAxis& axis = plan.axes[a];
    if (!name.empty() ? axis.name == name
                      : axis.words.empty() && axis.spread == Spread::grid &&
                            axis.values.size() > 1 && a != other) {
      return a;
    }
  }
  return std::nullopt;
}

double axis_at(const SweepAxis& axis, std::size_t place) {
  return axis.words.empty() ? axis.values[place] : static_cast<double>(place);
}

std::string label_of(const std::string& name, const std::string& unit) {
  return unit == "yes/no" ? name : fmt::format("{} [{}]", name, unit);
}

std::string value_text(const SweepAxis& axis, std::size_t place) {
  const double value = axis.values[place];
  if (!axis.words.empty()) return axis.words[static_cast<std::size_t>(value)];
  const double size = std::abs(value);
  return size >= 1000 && size < 1e7 ? fmt::format("{:.0f}", value) : fmt::format("{:.4g}", value);
}

}  // namespace limpid
