// Runs without a window, as `limpid run --record` does them.
#pragma once

#include <vector>

#include "tests/bench/bench.h"

namespace limpid::bench {

// Runs the built-in arm on its table: simulated alone, recorded, and the file written alone.
// Measures the processor time of the process for a tick of 1 ms. Errors: std::runtime_error if the
// folder for temporary files cannot be written.
std::vector<Line> recorded_runs(const Line& unit);

}  // namespace limpid::bench
