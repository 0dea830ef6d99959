// The axes of a sweep's plan.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/sweep/sweep_plan.h"
#include "devices/files/toml_reader.h"

namespace limpid {

// Points in the unit cube: `count` values in [0, 1) for each of `dimensions`, [dimension][sample].
// The same seed gives the same points everywhere.
using UnitSamples = std::vector<std::vector<double>>;

UnitSamples random_samples(std::size_t dimensions, std::size_t count, std::uint64_t seed);
// Latin hypercube: each dimension has one value in every interval of 1 / count.
UnitSamples latin_samples(std::size_t dimensions, std::size_t count, std::uint64_t seed);
// Sobol's sequence from its second point on, shifted by the seed round the cube (Cranley and
// Patterson).
UnitSamples sobol_samples(std::size_t dimensions, std::size_t count, std::uint64_t seed);

// Interval of a sampled axis.
struct AxisRange {
  double from = 0, to = 0;
};
struct ReadAxis {
  SweepAxis axis;
  AxisRange range;  // of a sampled axis
};
// Returns the field of an axis' key: a parameter's, a body's, the scene's or the random arm's; null
// if no axis has that key.
const FieldInfo* axis_field(const std::string& key);

// Returns the axis' name in plain words: the caption of what its key sets, unless the plan has a
// name of its own for it.
std::string words_of_axis(const SweepAxis& axis);

// Reads [[axis]]; sampled axes get their values from sample(). Errors: FileError.
ReadAxis read_axis(const TomlTable& table, const Parameters& base);

// Gives the sampled axes their values.
void sample(std::vector<ReadAxis>& axes, std::uint64_t samples, std::uint64_t seed);

// `count` values from one end to the other, both included.
std::vector<double> spread(const AxisRange& range, std::uint64_t count, bool logarithmic);

// Reads measure, above, below. Errors: FileError.
SweepLimit read_limit(const TomlTable& table);

}  // namespace limpid
