// The axes of a sweep's plan.
#pragma once

#include "app/sweep/sweep_plan.h"
#include "devices/files/toml_reader.h"

namespace limpid {

// Of [[axis]]; sampled ones are without values until all are known. Errors: FileError.
struct AxisRange {
  double from = 0, to = 0;
};
struct ReadAxis {
  SweepAxis axis;
  AxisRange range;  // of a sampled one
};
ReadAxis read_axis(const TomlTable& table, const Parameters& base);

// Gives the sampled ones their values.
void sample(std::vector<ReadAxis>& axes, std::uint64_t samples, std::uint64_t seed);

// `count` values from one end to the other, both included.
std::vector<double> spread(const AxisRange& range, std::uint64_t count, bool logarithmic);

// measure, above, below. Errors: FileError.
SweepLimit read_limit(const TomlTable& table);

}  // namespace limpid
