// A point of a sweep again, as a session.
#pragma once

#include <filesystem>
#include <functional>

#include "app/study/measure_point.h"

namespace limpid {

struct RecordedPoint {
  std::vector<double> values;  // as measured()
  Summary summary;
};

// Where a sweep's table in `dir` keeps that session; of a boundary's point: with its axis at `at`.
std::filesystem::path point_file(const std::filesystem::path& dir, std::uint64_t index,
                                 std::optional<double> at);

// The very run that the sweep made, recorded in `out`; nothing, and no file, if `stop` was set
// meanwhile. `part`, 0 to 1, hears how far it is. Errors: FileError; std::runtime_error naming the
// point.
std::optional<RecordedPoint> record_point(const SweepPlan& plan, std::uint64_t index,
                                          std::optional<double> at,
                                          const std::filesystem::path& out,
                                          const std::atomic<bool>& stop,
                                          const std::function<void(double part)>& part = {});

// How what was measured again differs from the table's row, in words; empty: to the last bit it
// does not.
std::string differences(const SweepPlan& plan, const std::vector<double>& again,
                        std::span<const double> row);

}  // namespace limpid
