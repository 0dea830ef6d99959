// Runs without a window, as `limpid run --record` does them.
#pragma once

#include <vector>

#include "tests/bench/bench.h"

namespace limpid::bench {

// The built-in arm on its table: simulated alone, recorded, and the file written alone; processor
// time of the whole process for a tick of 1 ms. Errors: std::runtime_error where the folder for
// temporary files takes none.
std::vector<Line> recorded_runs(const Line& unit);

}  // namespace limpid::bench
