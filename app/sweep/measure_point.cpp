#include "app/sweep/measure_point.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace limpid {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Makes all NaN the same to the bit, on every machine.
double plain(double x) { return std::isnan(x) ? kNone : x; }

bool needs_felt(const SweepPlan& plan) {
  bool felt = plan.boundary && plan.boundary->condition.measure->felt;
  for (const MeasureInfo* measure : plan.measures) felt = felt || measure->felt;
  for (const StopRule& rule : plan.stops) felt = felt || rule.limit.measure->felt;
  return felt;
}

// Search for changes of the condition along the boundary's axis.
class BoundarySearch {
 public:
  BoundarySearch(const SweepPlan& plan, std::uint64_t index, const std::atomic<bool>& stop)
      : plan_(plan), b_(*plan.boundary), index_(index), stop_(stop) {}

  std::optional<std::vector<double>> find() {
    const std::vector<double>& tried = b_.axis.values;
    double lowest = kNone, highest = kNone, changes = 0;
    bool before = met(tried.front());
    for (std::size_t i = 1; i < tried.size(); ++i) {
      const bool now = met(tried[i]);
      if (now != before) {
        highest = bisect(tried[i - 1], tried[i], before);
        if (changes++ == 0) lowest = highest;
      }
      before = now;
    }
    if (interrupted_) return std::nullopt;
    return std::vector{lowest, highest, before ? 1.0 : 0.0, changes, runs_};
  }

 private:
  bool met(double at) {
    if (interrupted_) return false;
    const auto meter = run_point(plan_, run_of(plan_, index_, at), stop_);
    interrupted_ = !meter;
    ++runs_;
    return meter && b_.condition.met(b_.condition.measure->value(*meter));
  }

  double middle(double low, double high) const {
    return b_.axis.logarithmic ? std::sqrt(low * high) : (low + high) / 2;
  }

  bool close(double low, double high) const {
    return b_.axis.logarithmic ? high / low <= 1 + b_.tolerance : high - low <= b_.tolerance;
  }

  double bisect(double low, double high, bool at_low) {
    while (!interrupted_ && !close(low, high)) {
      const double at = middle(low, high);
      if (!(at > low && at < high)) break;  // no number lies between
      (met(at) == at_low ? low : high) = at;
    }
    return middle(low, high);
  }

  const SweepPlan& plan_;
  const SweepBoundary& b_;
  std::uint64_t index_;
  const std::atomic<bool>& stop_;
  bool interrupted_ = false;
  double runs_ = 0;
};

}  // namespace

std::string unit_of(const MeasureInfo& measure, const SweepPlan& plan) {
  std::vector<std::string> units;
  for (const auto& [world, run] : plan.worlds) {
    std::string unit = measure.unit_in(norm_units(slides_of(run->arm)));
    if (std::ranges::find(units, unit) == units.end()) units.push_back(std::move(unit));
  }
  return units.empty() ? measure.unit : fmt::format("{}", fmt::join(units, " or "));
}

std::vector<SweepColumn> measured_columns(const SweepPlan& plan) {
  std::vector<SweepColumn> columns;
  for (const MeasureInfo* m : plan.measures) {
    columns.push_back({m->name, unit_of(*m, plan), m->what});
  }
  if (!plan.boundary) return columns;
  const SweepAxis& axis = plan.boundary->axis;
  const std::string condition = plan.boundary->condition.measure->name;
  return {
      {"boundary", axis.unit, fmt::format("lowest {} at which {} changes", axis.name, condition)},
      {"boundary_last", axis.unit,
       fmt::format("highest {} at which the result changes", axis.name)},
      {"at_top", "yes/no",
       fmt::format("whether the condition {} is met at the highest {}", condition, axis.name)},
      {"changes", "-", "number of changes of the result between the values tried"},
      {"runs", "-", "number of runs made"}};
}

std::optional<RunMeter> run_point(const SweepPlan& plan, const RunPlan& run,
                                  const std::atomic<bool>& stop, const PointSink& also) {
  const std::vector<Object>& objects = run.document.scene.objects;
  const auto wall = std::ranges::find_if(objects, has_shape<Plane>);
  const bool one_wall = std::ranges::count_if(objects, has_shape<Plane>) == 1;
  RunMeter meter(run.arm, run.parameters.tick, run.rows, needs_felt(plan),
                 one_wall ? &*wall : nullptr, count_bodies(run.document.scene));
  const auto must_stop = [&] {
    for (const StopRule& rule : plan.stops) {
      if (meter.seconds() >= rule.after && rule.limit.met(rule.limit.measure->value(meter))) {
        return true;
      }
    }
    return false;
  };
  bool given_up = false;
  simulate(run, {.realtime = false, .stop = &stop}, [&](std::span<const double> row, LaneChanges) {
    meter.add(row);
    given_up = also && !also(row);
    return !given_up && !must_stop();
  });
  if (given_up || stop.load(std::memory_order_relaxed)) return std::nullopt;
  return meter;
}

std::vector<double> measured(const SweepPlan& plan, const RunMeter& meter) {
  if (plan.boundary) return {plain(plan.boundary->condition.measure->value(meter))};
  std::vector<double> values;
  for (const MeasureInfo* m : plan.measures) values.push_back(plain(m->value(meter)));
  return values;
}

std::optional<std::vector<double>> measure_point(const SweepPlan& plan, std::uint64_t index,
                                                 const std::atomic<bool>& stop) {
  try {
    if (plan.boundary) return BoundarySearch(plan, index, stop).find();
    const auto meter = run_point(plan, run_of(plan, index), stop);
    if (!meter) return std::nullopt;
    return measured(plan, *meter);
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(fmt::format("point {}: {}", index, e.what()));
  }
}

}  // namespace limpid
