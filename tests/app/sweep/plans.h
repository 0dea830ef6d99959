// Plans for tests, and the files they make.
#pragma once

#include <algorithm>
#include <atomic>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "app/sweep/measure_point.h"
#include "app/sweep/sweep_plan.h"
#include "app/sweep/sweep_work.h"
#include "tests/support/temp_dir.h"

namespace limpid::test {

inline SweepPlan sweep_plan(const TempDir& dir, const std::string& text) {
  const std::filesystem::path file = dir / "plan.toml";
  std::ofstream(file) << text;
  return read_sweep_plan(file);
}

inline std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Runs the first `blocks` blocks of a sweep; returns the file of its table.
inline std::filesystem::path swept(const SweepPlan& plan, const std::filesystem::path& out,
                                   std::uint64_t blocks = 1000) {
  const SweepFolder folder(plan, out);
  SweepBook book(plan, folder, false);
  const std::atomic<bool> stop{false};
  for (std::uint64_t b = 0; b < std::min(blocks, blocks_of(plan)); ++b) {
    const SweepBlock block = block_of(plan, b);
    std::vector<double> values;
    for (std::uint64_t i = 0; i < block.size; ++i) {
      const auto one = measure_point(plan, block.first + i, stop);
      values.insert(values.end(), one->begin(), one->end());
    }
    book.take(b, values);
  }
  book.write();
  return folder.table();
}

// Bytes of the table from all existing blocks; `complete` tells whether these are all.
inline std::string gathered(const SweepPlan& plan, const std::filesystem::path& out,
                            bool& complete) {
  const SweepFolder folder(plan, out);
  SweepBook book(plan, folder, false);
  book.gather();
  book.write();
  complete = book.complete();
  return bytes_of(folder.table());
}

// Blocks of one point: three laws, two grips, three etas.
inline const std::string kGrips = R"(title = "Grips"
scene = "free.toml"
hand = { at = [0.19, 0, 0], jump = [1e-4, 0, 0] }
seconds = 0.02
measure = ["human_rms", "stable"]
block = 1
axis = [
  { key = "coupling.kind", values = ["standard", "proposed", "predictive"] },
  { key = "hand.stiffness", values = [1000, 100], scale = "log" },
  { key = "coupling.eta", from = 0.4, to = 1, count = 3 },
]
[figure]
x = "stiffness"
theory = ["pr"]
)";

// A fast plan: a few ticks a point.
inline const std::string kShort = R"(title = "Short"
scene = "free.toml"
hand = { at = [0.19, 0, 0], jump = [1e-4, 0, 0] }
seconds = 0.02
measure = ["human_rms", "energy", "stable"]
block = 4
axis = [
  { key = "coupling.kind", values = ["standard", "proposed", "predictive"] },
  { key = "coupling.eta", from = 0.4, to = 1, count = 7 },
]
)";

}  // namespace limpid::test
