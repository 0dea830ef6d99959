#include "app/sweep/sweep_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "app/sweep/sweep_map.h"

namespace limpid {

namespace {

constexpr const char *kYesTint = "#B8D8EC", *kNoTint = "#F2C4A8";

std::string with_name(const SweepAxis& axis, std::size_t place) {
  return fmt::format("{} {}{}", axis.name, axis.words.empty() ? "= " : "", value_text(axis, place));
}

struct Mean {
  double sum = 0, count = 0;
  std::uint64_t point = 0;  // the last of its points
  double value() const { return sum / count; }
};
// Means over repeats and samples: [panel][x][y], by places on axes.
using Panels = std::map<std::vector<std::size_t>, std::map<std::array<std::size_t, 2>, Mean>>;

// A grid's axis of numbers, if there is one; else the first that has several values.
std::size_t axis_across(const SweepPlan& plan) {
  if (const auto x = axis_called(plan, plan.figure.x, {})) return *x;
  const auto several = [](const SweepAxis& axis) { return axis.values.size() > 1; };
  const auto found = std::ranges::find_if(plan.axes, several);
  return found == plan.axes.end() ? 0 : static_cast<std::size_t>(found - plan.axes.begin());
}

// The words of an axis where they stand on it; nothing for numbers.
std::vector<std::pair<double, std::string>> word_ticks(const SweepAxis& axis) {
  std::vector<std::pair<double, std::string>> ticks;
  if (axis.words.empty()) return ticks;
  for (std::size_t i = 0; i < axis.values.size(); ++i) {
    ticks.emplace_back(axis_at(axis, i), value_text(axis, i));
  }
  return ticks;
}

class Drawing {
 public:
  Drawing(const SweepPlan& plan, const SweepTable& table)
      : plan_(plan),
        table_(table),
        x_(axis_across(plan)),
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
      panel.x_label = x.words.empty() ? label_of(x.name, x.unit) : x.name;
      panel.x_ticks = word_ticks(x);
      panel.log_x = x.logarithmic;
      panel.x_range = AxisCells(x).all();
      if (plan_.boundary) {
        draw_boundary(panel, values);
      } else if (y_) {
        draw_map(panel, values);
      } else {
        draw_slice(panel, values);
        std::ranges::move(upright_theory(plan_, values.begin()->second.point, x, {low_, high_}),
                          std::back_inserter(panel.series));
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
      const SweepPoint point = point_of(plan_, i);
      std::vector<std::size_t> rest = point.place;
      std::array<std::size_t, 2> at{std::exchange(rest[x_], 0), 0};
      if (y_) at[1] = std::exchange(rest[*y_], 0);
      for (std::size_t a = 0; a < rest.size(); ++a) {
        if (plan_.axes[a].spread != Spread::grid) rest[a] = 0;
      }
      Mean& mean = panels_[rest][at];
      mean.sum += value;
      ++mean.count;
      mean.point = i;
      low_ = std::min(low_, mean.value());
      high_ = std::max(high_, mean.value());
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
    const SweepAxis& x = plan_.axes[x_];
    Series line{"", kProxyInk, Series::Style::line, {}},
        dots{"", kProxyInk, Series::Style::points, {}};
    for (const auto& [at, mean] : values) {
      line.points.push_back({axis_at(x, at[0]), mean.value()});
    }
    dots.points = line.points;
    if (x.spread == Spread::grid && x.words.empty()) panel.series.push_back(std::move(line));
    panel.series.push_back(std::move(dots));
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

  // Adds lines of theory along x, with everything else as at a point of the panel.
  void add_theory(FigurePanel& panel, std::uint64_t point) const {
    const SweepAxis& x = plan_.axes[x_];
    if (!x.words.empty()) return;
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

Figure sweep_figure(const SweepPlan& plan, const SweepTable& table) {
  Figure figure;
  figure.title = plan.title;
  figure.caption = plan.figure.caption;
  if (!plan.axes.empty()) figure.panels = Drawing(plan, table).panels();
  figure.columns = static_cast<int>(std::clamp<std::size_t>(figure.panels.size(), 1, 3));
  return figure;
}

}  // namespace limpid
