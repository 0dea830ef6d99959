#include "app/sweep/record_point.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "app/run/recorder.h"
#include "app/run/replay.h"
#include "devices/files/scene/scene_file.h"

namespace limpid {

namespace fs = std::filesystem;

fs::path point_file(const fs::path& dir, std::uint64_t index, std::optional<double> at) {
  const std::string name =
      at ? fmt::format("{}-at-{:.6g}.h5", index, *at) : fmt::format("{}.h5", index);
  return dir / "points" / name;
}

std::optional<RecordedPoint> record_point(const SweepPlan& plan, std::uint64_t index,
                                          std::optional<double> at, const fs::path& out,
                                          const std::atomic<bool>& stop,
                                          const std::function<void(double part)>& part) {
  try {
    RunPlan run = run_of(plan, index, at);
    run.document.toml = scene_text(run.document, run.arm);  // as changed by the axes
    fs::create_directories(out.parent_path());
    std::optional<RunMeter> meter;
    {
      Recorder recorder(out, session_info(run), run.parameters, true, Recorder::kWaitingRoom);
      meter = run_point(plan, run, stop, [&](std::span<const double> row) {
        if (part) part(static_cast<double>(recorder.rows()) / static_cast<double>(run.rows));
        return recorder.push_waiting(row);
      });
      if (meter || !stop) recorder.finish();  // also reports why it failed
    }
    if (meter) return RecordedPoint{measured(plan, *meter), meter->summary()};
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(fmt::format("point {}: {}", index, e.what()));
  }
  std::error_code none;
  fs::remove(out.string() + ".part", none);
  return std::nullopt;
}

std::string differences(const SweepPlan& plan, const std::vector<double>& again,
                        std::span<const double> row) {
  std::string text;
  for (std::size_t i = 0; i < again.size() && i < row.size(); ++i) {
    const bool same = again[i] == row[i] || (std::isnan(again[i]) && std::isnan(row[i]));
    if (same) continue;
    text += fmt::format("{}{} is {:.6g}, but the table says {:.6g}", text.empty() ? "" : "; ",
                        plan.measures[i]->name, again[i], row[i]);
  }
  return text;
}

}  // namespace limpid
