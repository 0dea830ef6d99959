#include "tests/bench/recorded_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <filesystem>

#include "app/base/folders.h"
#include "app/run/recorder.h"
#include "app/run/replay.h"
#include "app/run/simulate.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/urdf_file.h"

namespace limpid::bench {
namespace {

constexpr std::uint64_t kRows = 20000;
constexpr int kTimes = 7;

RunPlan touching_the_table() {
  RunPlan plan;
  plan.arm = read_urdf(default_device());
  plan.document = read_scene(default_scene(), plan.arm);
  plan.hand = read_hand(default_hand());
  plan.rows = kRows;
  return plan;
}

// Processor time of all threads of the process [us].
double processor_time() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

template <class Work>
Line timed(const char* id, const char* what, const Line& unit, double tick, Work&& work) {
  Samples taken(kTimes);
  for (int i = 0; i < kTimes; ++i) {
    const double before = processor_time();
    work();
    taken.add((processor_time() - before) / static_cast<double>(kRows));
  }
  Line line = line_of(id, what, taken, &unit);
  line.unit = "us a tick";
  line.real_time = 1e6 * tick / line.median;
  return line;
}

// A temporary file, removed in any case.
struct Temporary {
  std::filesystem::path file =
      std::filesystem::temp_directory_path() / fmt::format("limpid-bench-{}.h5", getpid());
  Temporary() = default;
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() {
    std::error_code none;
    std::filesystem::remove(file, none);
  }
};

}  // namespace

std::vector<Line> recorded_runs(const Line& unit) {
  const RunPlan plan = touching_the_table();
  const SessionInfo info = session_info(plan);
  const Temporary out;
  std::vector<double> rows(kRows * static_cast<std::size_t>(info.layout().stride()));
  const auto line = [&](const char* id, const char* what, auto&& work) {
    return timed(id, what, unit, plan.parameters.tick, work);
  };
  std::vector<Line> lines;
  lines.push_back(line("run/alone", "run without a window, a tick", [&] {
    auto next = rows.begin();
    simulate(plan, {}, [&](std::span<const double> row, LaneChanges) {
      next = std::ranges::copy(row, next).out;
      return true;
    });
  }));
  lines.push_back(line("run/recorded", "the same, recorded", [&] {
    Recorder recorder(out.file, info, plan.parameters, true, Recorder::kWaitingRoom);
    simulate(plan, {},
             [&](std::span<const double> row, LaneChanges) { return recorder.push_waiting(row); });
    recorder.finish();
  }));
  lines.push_back(line("run/writing", "writing the file alone, a row", [&] {
    SessionWriter writer(out.file, info, true, Packing::no);
    writer.append(rows);
    writer.close();
  }));
  return lines;
}

}  // namespace limpid::bench
