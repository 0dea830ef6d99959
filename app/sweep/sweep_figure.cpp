#include "app/sweep/sweep_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "app/sweep/parallel_coordinates.h"
#include "app/sweep/theory.h"

namespace limpid {
namespace {

constexpr std::size_t kMostSlices = std::size(kFamilyInk);
constexpr int kTheoryPoints = 80;
constexpr const char *kYesTint = "#B8D8EC", *kNoTint = "#F2C4A8";
constexpr const char* kTheoryInk[] = {kNeutralInk, kHandInk, kEnergyInk};

// The axis with that name, else the next grid axis of numbers after `after`.
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

std::string label_of(const std::string& name, const std::string& unit) {
  return unit == "yes/no" ? name : fmt::format("{} [{}]", name, unit);
}

std::string value_text(const SweepAxis& axis, std::size_t place) {
  if (axis.words.empty()) return fmt::format("{} = {:.4g}", axis.name, axis.values[place]);
  return fmt::format("{} {}", axis.name, axis.words[static_cast<std::size_t>(axis.values[place])]);
}

// From half a step before to half a step after each value, of an axis that increases.
class Cells {
 public:
  explicit Cells(const SweepAxis& axis) : log_(axis.logarithmic), values_(axis.values) {
    std::ranges::sort(values_);
  }
  std::pair<double, double> around(double x) const {
    const auto i = static_cast<std::size_t>(std::ranges::lower_bound(values_, x) - values_.begin());
    const std::size_t last = values_.size() - 1;
    if (last == 0) return {x - 0.5, x + 0.5};
    const double low = i > 0 ? between(values_[i - 1], x) : beyond(x, values_[1]);
    const double high = i < last ? between(x, values_[i + 1]) : beyond(x, values_[last - 1]);
    return {low, high};
  }
  std::pair<double, double> all() const {
    return {around(values_.front()).first, around(values_.back()).second};
  }

 private:
  double between(double a, double b) const { return log_ ? std::sqrt(a * b) : (a + b) / 2; }
  // As far on the other side of x as half the way to its neighbour.
  double beyond(double x, double neighbour) const {
    return log_ ? x * std::sqrt(x / neighbour) : x + (x - neighbour) / 2;
  }
  bool log_;
  std::vector<double> values_;
};

struct Mean {
  double sum = 0, count = 0;
  std::uint64_t point = 0;  // one of them
  double value() const { return sum / count; }
};
// Over repeats and samples: [panel][x][y], the places of axes.
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
      panel.x_range = Cells(x).all();
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
      text += (text.empty() ? "" : ", ") + value_text(axis, places[a]);
    }
    return text.empty() ? measured().name : text;
  }

  void draw_map(FigurePanel& panel, const Panels::mapped_type& values) const {
    const SweepAxis &x = plan_.axes[x_], &y = plan_.axes[*y_];
    const Cells wide(x), high(y);
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

  // Along x, everything else as it is at a point of the panel.
  void add_theory(FigurePanel& panel, std::uint64_t point) const {
    const SweepAxis& x = plan_.axes[x_];
    const auto* key = find_parameter(x.key);
    const Cells wide(x);
    const auto [from, to] = wide.all();
    for (const std::string& line : plan_.figure.theory) {
      const auto which = std::ranges::find(kTheories, line) - std::begin(kTheories);
      Series series{theory_label(line),
                    kTheoryInk[which],
                    which == 0 ? Series::Style::dashed : Series::Style::line,
                    {}};
      RunPlan run = run_of(plan_, point);
      for (int i = 0; i <= kTheoryPoints; ++i) {
        const double part = static_cast<double>(i) / kTheoryPoints;
        const double at =
            x.logarithmic ? from * std::pow(to / from, part) : from + (to - from) * part;
        if (key != nullptr) set_parameter_number(run.parameters, *key, at);
        series.points.push_back({at, eta_limit(line, run)});
      }
      panel.series.push_back(series);
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
  if (axis_called(plan, plan.figure.x, {})) {
    figure.panels = Drawing(plan, table).panels();
  } else if (!plan.axes.empty()) {
    figure.panels = {parallel_coordinates(plan, table)};
  }
  figure.columns = static_cast<int>(std::clamp<std::size_t>(figure.panels.size(), 1, 3));
  return figure;
}

}  // namespace limpid
