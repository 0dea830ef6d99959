// What comes of one point of a sweep.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/study/sweep_plan.h"

namespace limpid {

struct SweepColumn {
  std::string name, unit, what;
};
// The plan's measures, or those of its boundary: boundary and boundary_last, the lowest and the
// highest change along the axis, not a number without any; at_top, whether the condition is met at
// the axis' upper end; changes; runs.
std::vector<SweepColumn> measured_columns(const SweepPlan& plan);

// Runs it as a point of the plan, to its end or to where a rule stops it, and hands each row on;
// nothing if `stop` was set meanwhile, or the sink gave up.
using PointSink = std::function<bool(std::span<const double> row)>;
std::optional<RunMeter> run_point(const SweepPlan& plan, const RunPlan& run,
                                  const std::atomic<bool>& stop, const PointSink& also = {});
// What a run gives of the plan's measures; of a boundary's condition alone, where there is one.
std::vector<double> measured(const SweepPlan& plan, const RunMeter& meter);

// A value for each of them; nothing if `stop` was set meanwhile. The same on every machine of a
// kind, whatever else was run. Errors: std::runtime_error naming the point.
std::optional<std::vector<double>> measure_point(const SweepPlan& plan, std::uint64_t index,
                                                 const std::atomic<bool>& stop);

}  // namespace limpid
