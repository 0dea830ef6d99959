#include "app/sweep/sweep_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "app/run/analysis.h"

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

namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
constexpr double kDecades = 1000;  // larger ratios are coloured on a logarithmic scale
constexpr double kRoom = 0.05;     // above and below a curve, as a share of its height

bool sampled(const SweepAxis& axis) { return axis.spread != Spread::grid; }

// Whether a column has values of the boundary's axis.
bool along_boundary(const SweepPlan& plan, std::size_t column) {
  return plan.boundary && column < 2;
}

class Making {
 public:
  Making(const OpenedSweep& sweep, const MapChoice& choice)
      : sweep_(sweep), plan_(*sweep.plan), x_(plan_.axes[choice.x]) {
    map_.choice = choice;
    if (choice.y) y_ = &plan_.axes[*choice.y];
    over_samples_ = sampled(x_) || (y_ != nullptr && sampled(*y_));
    if (y_ == nullptr) {
      map_.kind = SweepMap::Kind::curve;
    } else if (over_samples_) {
      map_.kind = SweepMap::Kind::dots;
    }
    const std::uint64_t together = plan_.repeats * (over_samples_ ? 1 : plan_.samples);
    map_.yes_no = sweep.table.columns[choice.column].unit == "yes/no" && together == 1;
  }

  SweepMap make() {
    collect();
    ranges();
    if (map_.kind == SweepMap::Kind::cells && map_.yes_no) add_changes();
    if (map_.kind == SweepMap::Kind::curve && plan_.boundary && map_.choice.column == 0) {
      add_last_change();
    }
    const bool over_eta = y_ != nullptr ? y_->key == "coupling.eta"
                                        : along_boundary(plan_, map_.choice.column) &&
                                              plan_.boundary->axis.key == "coupling.eta";
    if (over_eta && !plan_.worlds.empty() && !map_.spots.empty()) {
      for (const std::string& line : plan_.figure.theory) {
        map_.lines.push_back(theory_line(plan_, map_.spots.front().point, x_, line));
      }
    }
    if (map_.kind == SweepMap::Kind::curve && !plan_.boundary && !map_.spots.empty()) {
      std::ranges::move(upright_theory(plan_, map_.spots.front().point, x_, map_.y_range),
                        std::back_inserter(map_.lines));
    }
    return std::move(map_);
  }

 private:
  // Places on a grid's axis from its lowest value up; a single one on a sampled axis.
  static std::vector<std::size_t> upwards(const SweepAxis* axis) {
    if (axis == nullptr || sampled(*axis)) return {0};
    std::vector<std::size_t> places(axis->values.size());
    std::iota(places.begin(), places.end(), std::size_t{0});
    std::ranges::stable_sort(places, {}, [&](std::size_t i) { return axis_at(*axis, i); });
    return places;
  }

  void collect() {
    map_.rows = upwards(y_).size();
    std::vector<std::size_t> place = map_.choice.place;
    for (const std::size_t ix : upwards(&x_)) {
      if (!sampled(x_)) place[map_.choice.x] = ix;
      for (const std::size_t iy : upwards(y_)) {
        if (y_ != nullptr && !sampled(*y_)) place[*map_.choice.y] = iy;
        if (!over_samples_) {
          add_spot(place, 0, plan_.samples);
        } else {
          for (std::uint64_t s = 0; s < plan_.samples; ++s) add_spot(place, s, s + 1);
        }
      }
    }
  }

  // Adds the mean over all repeats of samples `from` to `to`.
  void add_spot(const std::vector<std::size_t>& place, std::uint64_t from, std::uint64_t to) {
    MapSpot spot;
    spot.point = number_of(plan_, place, from, 0);
    double sum = 0, finite = 0;
    for (std::uint64_t s = from; s < to; ++s) {
      for (std::uint64_t r = 0; r < plan_.repeats; ++r) {
        const std::uint64_t point = number_of(plan_, place, s, r);
        if (!sweep_.table.done[point]) continue;
        ++spot.count;
        const double value = sweep_.table.at(point, map_.choice.column);
        if (!std::isfinite(value)) continue;
        sum += value;
        ++finite;
      }
    }
    const double value = finite > 0 ? sum / finite : kNoValue;
    spot.x = axis_at(x_, sampled(x_) ? from : place[map_.choice.x]);
    spot.y = y_ == nullptr ? value : axis_at(*y_, sampled(*y_) ? from : place[*map_.choice.y]);
    spot.cell = {spot.x, spot.x, spot.y, spot.y, value};
    if (map_.kind == SweepMap::Kind::cells) {
      std::tie(spot.cell.x_low, spot.cell.x_high) = wide_.around(spot.x);
      std::tie(spot.cell.y_low, spot.cell.y_high) = high().around(spot.y);
    }
    map_.spots.push_back(spot);
  }

  const AxisCells& high() {
    if (!high_) high_.emplace(*y_);
    return *high_;
  }

  void ranges() {
    const auto [low, highest] = sweep_.ranges[map_.choice.column];
    map_.value_range = {low, highest > low ? highest : low + 1};
    if (map_.yes_no) map_.value_range = {0, 1};
    map_.log_values = !map_.yes_no && low > 0 && highest > kDecades * low;
    map_.x_range = wide_.all();
    if (y_ != nullptr) {
      map_.y_range = high().all();
    } else if (along_boundary(plan_, map_.choice.column)) {
      map_.y_range = {plan_.boundary->axis.values.front(), plan_.boundary->axis.values.back()};
    } else {
      const double room = kRoom * (map_.value_range.second - map_.value_range.first);
      map_.y_range = {map_.value_range.first - room, map_.value_range.second + room};
    }
  }

  const MapSpot& spot(std::size_t ix, std::size_t iy, std::size_t rows) const {
    return map_.spots[ix * rows + iy];
  }

  // Draws edges between cells that differ.
  void add_changes() {
    const std::size_t rows = y_->values.size(), columns = x_.values.size();
    Series line{"changes", kNeutralInk, Series::Style::line, {}};
    const auto differ = [](const MapSpot& a, const MapSpot& b) {
      return a.there() && b.there() && a.cell.value != b.cell.value;
    };
    const auto add = [&](double x1, double y1, double x2, double y2) {
      line.points.insert(line.points.end(), {{x1, y1}, {x2, y2}, {kNoValue, kNoValue}});
    };
    for (std::size_t ix = 0; ix < columns; ++ix) {
      for (std::size_t iy = 0; iy < rows; ++iy) {
        const MapSpot& here = spot(ix, iy, rows);
        const FigureCell& c = here.cell;
        if (ix + 1 < columns && differ(here, spot(ix + 1, iy, rows))) {
          add(c.x_high, c.y_low, c.x_high, c.y_high);
        }
        if (iy + 1 < rows && differ(here, spot(ix, iy + 1, rows))) {
          add(c.x_low, c.y_high, c.x_high, c.y_high);
        }
      }
    }
    if (!line.points.empty()) map_.lines.push_back(std::move(line));
  }

  // Draws the highest change if a boundary is crossed more than once.
  void add_last_change() {
    Series line{"highest change", kProxyInk, Series::Style::dashed, {}};
    bool other = false;
    for (const MapSpot& each : map_.spots) {
      if (!sweep_.table.done[each.point]) continue;
      const double last = sweep_.table.at(each.point, 1);
      line.points.push_back({each.x, last});
      other = other || (std::isfinite(last) && last != sweep_.table.at(each.point, 0));
    }
    if (other) map_.lines.push_back(std::move(line));
  }

  const OpenedSweep& sweep_;
  const SweepPlan& plan_;
  const SweepAxis& x_;
  const SweepAxis* y_ = nullptr;
  AxisCells wide_{x_};
  std::optional<AxisCells> high_;
  bool over_samples_ = false;
  SweepMap map_;
};

constexpr int kTheoryPoints = 80;
constexpr const char* kTheoryInk[] = {kNeutralInk, kHandInk, kEnergyInk};

Series series_of_theory(const std::string& line) {
  const auto which = std::ranges::find(kTheories, line) - std::begin(kTheories);
  return {theory_label(line),
          kTheoryInk[which],
          which == 0 ? Series::Style::dashed : Series::Style::line,
          {}};
}

}  // namespace

MapChoice first_choice(const SweepPlan& plan, const SweepTable& table) {
  MapChoice choice;
  const auto shown = std::ranges::find(table.columns, plan.figure.measure, &SweepColumn::name);
  if (shown != table.columns.end()) {
    choice.column = static_cast<std::size_t>(shown - table.columns.begin());
  }
  choice.place.assign(plan.axes.size(), 0);
  if (const auto x = axis_called(plan, plan.figure.x, {})) choice.x = *x;
  choice.y = axis_called(plan, plan.figure.y, choice.x);
  for (std::size_t a = 0; a < plan.axes.size() && !choice.y; ++a) {
    if (a != choice.x && plan.axes[a].values.size() > 1) choice.y = a;
  }
  return mended(plan, choice);
}

MapChoice mended(const SweepPlan& plan, MapChoice choice) {
  const std::size_t axes = plan.axes.size();
  choice.x = std::min(choice.x, axes - 1);
  if (plan.boundary || axes < 2) choice.y.reset();
  if (choice.y && (*choice.y >= axes || *choice.y == choice.x)) choice.y = choice.x == 0 ? 1 : 0;
  choice.place.resize(axes, 0);
  for (std::size_t a = 0; a < axes; ++a) {
    choice.place[a] = std::min(choice.place[a], plan.axes[a].values.size() - 1);
  }
  return choice;
}

SweepMap make_map(const OpenedSweep& sweep, const MapChoice& choice) {
  return Making(sweep, mended(*sweep.plan, choice)).make();
}

std::string theory_label(const std::string& line) {
  if (line == "pr") return "PR (25)";
  return line == "routh" ? "Routh, locked" : "Routh, proxy on its spring";
}

double eta_limit(const std::string& line, const RunPlan& run) {
  const Parameters& p = run.parameters;
  const Eigen::VectorXd x = rest_at(run.arm, run.hand.position.front()).x1;
  if (line == "pr") return analyze(run.arm, x, p, std::nullopt).eta_min;
  const ArmAt arm = arm_at(run.arm, x);
  const Eigen::MatrixXd M_L = (1 + p.inertia_ratio) * arm.M, JJ = arm.J.transpose() * arm.J;
  const Eigen::VectorXd b_d = device_damping(run.arm, p);
  const Eigen::MatrixXd K_h = p.hand_stiffness * JJ, B_h = p.hand_damping * JJ;
  if (line == "routh") {
    return eta_min_grip(M_L, b_d + p.b_v * gain_weights(p, b_d), p.alpha, K_h, B_h);
  }
  return eta_min_compliant(M_L, b_d, p, K_h, B_h);
}

std::vector<Series> upright_theory(const SweepPlan& plan, std::uint64_t point, const SweepAxis& x,
                                   std::pair<double, double> heights) {
  std::vector<Series> lines;
  if (x.key != "coupling.eta" || plan.worlds.empty()) return lines;
  const auto [from, to] = AxisCells(x).all();
  for (const std::string& line : plan.figure.theory) {
    const double at = eta_limit(line, run_of(plan, point));
    if (!(at >= from && at <= to)) continue;
    Series& series = lines.emplace_back(series_of_theory(line));
    series.points = {{at, heights.first}, {at, heights.second}};
  }
  return lines;
}

Series theory_line(const SweepPlan& plan, std::uint64_t point, const SweepAxis& x,
                   const std::string& line) {
  Series series = series_of_theory(line);
  const auto* key = find_parameter(x.key);
  const auto [from, to] = AxisCells(x).all();
  RunPlan run = run_of(plan, point);
  for (int i = 0; i <= kTheoryPoints; ++i) {
    const double part = static_cast<double>(i) / kTheoryPoints;
    const double at = x.logarithmic ? from * std::pow(to / from, part) : from + (to - from) * part;
    if (key != nullptr) set_parameter_number(run.parameters, *key, at);
    series.points.push_back({at, eta_limit(line, run)});
  }
  return series;
}

}  // namespace limpid
