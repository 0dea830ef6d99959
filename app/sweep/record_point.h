// A point of a sweep, run again and recorded as a session.
#pragma once

#include <filesystem>
#include <functional>

#include "app/sweep/measure_point.h"

namespace limpid {

struct RecordedPoint {
  std::vector<double> values;  // as measured() gives them
  Summary summary;
};

// File of a point's session beside the table in `dir`; `at`: the value on a boundary's axis.
std::filesystem::path point_file(const std::filesystem::path& dir, std::uint64_t index,
                                 std::optional<double> at);

// Repeats exactly the sweep's run and records it in `out`; nothing, and no file, if `stop` was set
// meanwhile. `part` receives the share done, 0 to 1. Errors: FileError; std::runtime_error naming
// the point.
std::optional<RecordedPoint> record_point(const SweepPlan& plan, std::uint64_t index,
                                          std::optional<double> at,
                                          const std::filesystem::path& out,
                                          const std::atomic<bool>& stop,
                                          const std::function<void(double part)>& part = {});

// Differences of values measured again from the table's row, in words; empty if they are equal to
// the last bit.
std::string differences(const SweepPlan& plan, const std::vector<double>& again,
                        std::span<const double> row);

}  // namespace limpid
