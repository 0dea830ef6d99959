#include "app/sweep/parallel_coordinates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limpid {
namespace {

constexpr const char* kQuarterInk[] = {"#440154", "#31688E", "#35B779", "#D9A400"};

// Values along one upright.
struct Upright {
  std::string name;
  std::vector<double> values;
  bool logarithmic = false;
  double low = 0, high = 1;

  void fit() {
    low = std::ranges::min(values);
    high = std::ranges::max(values);
  }
  double height(std::size_t i) const {
    if (!(high > low)) return 0.5;
    return logarithmic ? std::log(values[i] / low) / std::log(high / low)
                       : (values[i] - low) / (high - low);
  }
  std::string label() const { return fmt::format("{}\\n{:.2g} to {:.2g}", name, low, high); }
};

std::size_t measure_shown(const SweepPlan& plan, const SweepTable& table) {
  const auto found = std::ranges::find(table.columns, plan.figure.measure, &SweepColumn::name);
  return found == table.columns.end() ? 0 : static_cast<std::size_t>(found - table.columns.begin());
}

// Which of four equal parts of all values each is in.
std::vector<std::size_t> quarters(const std::vector<double>& values) {
  std::vector<double> sorted = values;
  std::ranges::sort(sorted);
  std::vector<std::size_t> part;
  for (const double x : values) {
    const auto below = std::ranges::lower_bound(sorted, x) - sorted.begin();
    part.push_back(std::min<std::size_t>(3, 4 * static_cast<std::size_t>(below) / values.size()));
  }
  return part;
}

}  // namespace

FigurePanel parallel_coordinates(const SweepPlan& plan, const SweepTable& table) {
  const std::size_t column = measure_shown(plan, table);
  std::vector<std::uint64_t> points;
  for (std::uint64_t i = 0; i < table.points(); ++i) {
    if (table.done[i] && std::isfinite(table.at(i, column))) points.push_back(i);
  }
  FigurePanel panel{.title = table.columns[column].name};
  if (points.empty()) return panel;
  const std::size_t step = (points.size() + kMostLines - 1) / kMostLines;
  std::vector<Upright> uprights(plan.axes.size() + 1);
  for (std::size_t k = 0; k < points.size(); k += step) {
    const SweepPoint point = point_of(plan, table.rows.point(points[k]));
    for (std::size_t a = 0; a < plan.axes.size(); ++a)
      uprights[a].values.push_back(point.values[a]);
    uprights.back().values.push_back(table.at(points[k], column));
  }
  for (std::size_t a = 0; a < plan.axes.size(); ++a) {
    uprights[a].name = plan.axes[a].name;
    uprights[a].logarithmic = plan.axes[a].logarithmic;
  }
  uprights.back().name = table.columns[column].name;
  for (std::size_t a = 0; a < uprights.size(); ++a) {
    uprights[a].fit();
    panel.x_ticks.emplace_back(static_cast<double>(a), uprights[a].label());
  }
  const bool yes_no = table.columns[column].unit == "yes/no";
  const std::vector<double>& measured = uprights.back().values;
  const std::vector<std::size_t> part = quarters(measured);
  constexpr double kGap = std::numeric_limits<double>::quiet_NaN();
  constexpr const char* kQuarter[] = {"lowest quarter", "second", "third", "highest quarter"};
  for (std::size_t q = 0; q < (yes_no ? 2 : 4); ++q) {
    Series& series = panel.series.emplace_back();
    series.label = yes_no ? (q == 0 ? "not " : "") + table.columns[column].name : kQuarter[q];
    series.color = yes_no ? (q == 0 ? kContactInk : kProxyInk) : kQuarterInk[q];
    for (std::size_t i = 0; i < measured.size(); ++i) {
      if (q != (yes_no ? (measured[i] == 1 ? 1 : 0) : part[i])) continue;
      for (std::size_t a = 0; a < uprights.size(); ++a) {
        series.points.push_back({static_cast<double>(a), uprights[a].height(i)});
      }
      series.points.push_back({kGap, kGap});
    }
  }
  panel.x_range = {-0.2, static_cast<double>(uprights.size()) - 0.8};
  panel.y_range = {-0.02, 1.02};
  panel.y_label = "from the lowest to the highest value";
  return panel;
}

}  // namespace limpid
