// Measuring one point of a sweep.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/sweep/sweep_plan.h"

namespace limpid {

// A column of measured values in a sweep's table.
struct SweepColumn {
  std::string name, unit, what;
};
// The plan's measures, or the columns of its boundary. boundary and boundary_last: the lowest and
// highest change along the axis, NaN without any. at_top: whether the condition holds at the axis'
// upper end. changes, runs: their numbers.
std::vector<SweepColumn> measured_columns(const SweepPlan& plan);

// Receives each row of a run; returns false to give it up.
using PointSink = std::function<bool(std::span<const double> row)>;
// Runs `run` as a point of the plan, to its end or until a rule stops it. Nothing if `stop` was set
// meanwhile or the sink returned false.
std::optional<RunMeter> run_point(const SweepPlan& plan, const RunPlan& run,
                                  const std::atomic<bool>& stop, const PointSink& also = {});
// Values of the plan's measures for a run; with a boundary only that of its condition.
std::vector<double> measured(const SweepPlan& plan, const RunMeter& meter);

// Values of measured_columns(); nothing if `stop` was set meanwhile. The same on every machine of a
// kind, whatever else was run. Errors: std::runtime_error naming the point.
std::optional<std::vector<double>> measure_point(const SweepPlan& plan, std::uint64_t index,
                                                 const std::atomic<bool>& stop);

}  // namespace limpid
