#include "app/study/sweep_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "app/study/sweep_map.h"

namespace limpid {

namespace {

constexpr const char* kQuarterInk[] = {"#440154", "#31688E", "#35B779", "#D9A400"};

// Values along an upright.
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

// Quarter of all values that each value is in.
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

constexpr const char *kYesTint = "#B8D8EC", *kNoTint = "#F2C4A8";

std::string with_name(const SweepAxis& axis, std::size_t place) {
  return fmt::format("{} {}{}", axis.name, axis.words.empty() ? "= " : "", value_text(axis, place));
}

struct Mean {
  double sum = 0, count = 0;
  std::uint64_t point = 0;  // number of a point among them
  double value() const { return sum / count; }
};
// Means over repeats and samples: [panel][x][y], by places on the axes.
using Panels = std::map<std::vector<std::size_t>, std::map<std::array<std::size_t, 2>, Mean>>;

class Drawing {
 public:
  Drawing(const SweepPlan& plan, const SweepTable& table)
      : plan_(plan),
        table_(table),
        x_(*axis_called(plan, plan.figure.x, {})),
        y_(plan.boundary ? std::nullopt : axis_called(plan, plan.figure.y, x_)) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      if (table.columns[c].name == plan.figure.measure) column_ = c;
    }
    collect();
  }

  std::vector<FigurePanel> panels() const {
    std::vector<FigurePanel> all;
    const std::size_t step = (panels_.size() + kMostPanels - 1) / kMostPanels;
    std::size_t i = 0;
    for (const auto& [places, values] : panels_) {
      if (i++ % step != 0) continue;
      FigurePanel& panel = all.emplace_back();
      const SweepAxis& x = plan_.axes[x_];
      panel.title = title(places);
      panel.x_label = label_of(x.name, x.unit);
      panel.log_x = x.logarithmic;
      panel.x_range = AxisCells(x).all();
      if (plan_.boundary) {
        draw_boundary(panel, values);
      } else if (y_) {
        draw_map(panel, values);
      } else {
        draw_slice(panel, values);
      }
    }
    return all;
  }

 private:
  const SweepColumn& measured() const { return table_.columns[column_]; }
  bool yes_no() const { return measured().unit == "yes/no" && plan_.repeats * plan_.samples == 1; }

  void collect() {
    for (std::uint64_t i = 0; i < table_.points(); ++i) {
      const double value = table_.at(i, column_);
      if (!table_.done[i] || std::isnan(value)) continue;
      const SweepPoint point = point_of(plan_, table_.rows.point(i));
      std::vector<std::size_t> rest = point.place;
      std::array<std::size_t, 2> at{std::exchange(rest[x_], 0), 0};
      if (y_) at[1] = std::exchange(rest[*y_], 0);
      for (std::size_t a = 0; a < rest.size(); ++a) {
        if (plan_.axes[a].spread != Spread::grid) rest[a] = 0;
      }
      Mean& mean = panels_[rest][at];
      mean.sum += value;
      ++mean.count;
      mean.point = table_.rows.point(i);
      low_ = std::min(low_, mean.value());
      high_ = std::max(high_, mean.value());
    }
    if (plan_.refine) y_ ? fill_panels() : keep_coarse_panels();
  }

  // Drops panels at finer steps, which have little but the refined points.
  void keep_coarse_panels() {
    std::erase_if(panels_, [&](const auto& panel) {
      return std::ranges::any_of(plan_.refine->axes, [&](std::size_t a) {
        return panel.first[a] % (std::size_t{1} << plan_.refine->depth) != 0;
      });
    });
  }

  // Fills places without a point from the corners of their cell.
  void fill_panels() {
    keep_coarse_panels();
    for (auto& [places, values] : panels_) {
      std::vector<std::size_t> at = places;
      for (at[x_] = 0; at[x_] < plan_.axes[x_].values.size(); ++at[x_]) {
        for (at[*y_] = 0; at[*y_] < plan_.axes[*y_].values.size(); ++at[*y_]) {
          const std::array<std::size_t, 2> key{at[x_], at[*y_]};
          if (values.contains(key)) continue;
          if (const auto value = table_.inferred(at, 0, column_)) {
            values[key] = {*value, 1, values.begin()->second.point};
          }
        }
      }
    }
  }

  std::string title(const std::vector<std::size_t>& places) const {
    std::string text;
    for (std::size_t a = 0; a < places.size(); ++a) {
      const SweepAxis& axis = plan_.axes[a];
      if (a == x_ || a == y_ || axis.spread != Spread::grid || axis.values.size() < 2) continue;
      text += (text.empty() ? "" : ", ") + with_name(axis, places[a]);
    }
    return text.empty() ? measured().name : text;
  }

  void draw_map(FigurePanel& panel, const Panels::mapped_type& values) const {
    const SweepAxis &x = plan_.axes[x_], &y = plan_.axes[*y_];
    const AxisCells wide(x), high(y);
    panel.y_label = label_of(y.name, y.unit);
    panel.log_y = y.logarithmic;
    panel.y_range = high.all();
    std::vector<Series> maps(2);
    for (Series& map : maps) map.style = Series::Style::cells;
    for (const auto& [at, mean] : values) {
      const auto [left, right] = wide.around(x.values[at[0]]);
      const auto [bottom, top] = high.around(y.values[at[1]]);
      const bool no = yes_no() && mean.value() != 1;
      maps[no ? 1 : 0].cells.push_back({left, right, bottom, top, mean.value()});
    }
    maps[0].label = label_of(measured().name, measured().unit);
    if (yes_no()) {
      maps[0].color = kYesTint;
      maps[1].label = "not " + measured().name;
      maps[1].color = kNoTint;
    } else {
      maps.pop_back();
      panel.value_range = {low_, high_ > low_ ? high_ : low_ + 1};
    }
    panel.series = std::move(maps);
    if (y.key == "coupling.eta") add_theory(panel, values.begin()->second.point);
  }

  void draw_slice(FigurePanel& panel, const Panels::mapped_type& values) const {
    panel.y_label = label_of(measured().name, measured().unit);
    Series line{"", kProxyInk, Series::Style::line, {}},
        dots{"", kProxyInk, Series::Style::points, {}};
    for (const auto& [at, mean] : values) {
      line.points.push_back({plan_.axes[x_].values[at[0]], mean.value()});
    }
    dots.points = line.points;
    panel.series = {line, dots};
  }

  void draw_boundary(FigurePanel& panel, const Panels::mapped_type& values) const {
    draw_slice(panel, values);
    const SweepAxis& axis = plan_.boundary->axis;
    panel.y_label = label_of(axis.name, axis.unit);
    panel.log_y = axis.logarithmic;
    panel.y_range = {axis.values.front(), axis.values.back()};
    panel.series[0].label = fmt::format("{} changes", plan_.boundary->condition.measure->name);
    if (axis.key == "coupling.eta") add_theory(panel, values.begin()->second.point);
  }

  // Adds lines of theory along x, with all other settings of a point of the panel.
  void add_theory(FigurePanel& panel, std::uint64_t point) const {
    const SweepAxis& x = plan_.axes[x_];
    for (const std::string& line : plan_.figure.theory) {
      panel.series.push_back(theory_line(plan_, point, x, line));
    }
  }

  const SweepPlan& plan_;
  const SweepTable& table_;
  std::size_t x_;
  std::optional<std::size_t> y_;
  std::size_t column_ = 0;
  Panels panels_;
  double low_ = HUGE_VAL, high_ = -HUGE_VAL;
};

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

Figure sweep_figure(const SweepPlan& plan, const SweepTable& table) {
  Figure figure;
  figure.title = plan.title;
  figure.caption = plan.figure.caption;
  if (axis_called(plan, plan.figure.x, {})) {
    figure.panels = Drawing(plan, table).panels();
  } else if (!plan.axes.empty()) {
    figure.panels = {parallel_coordinates(plan, table)};
  }
  figure.columns = static_cast<int>(std::clamp<std::size_t>(figure.panels.size(), 1, 3));
  return figure;
}

}  // namespace limpid
