#include "app/cli/sweep_point.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

#include "app/base/interrupt.h"
#include "app/cli/options.h"
#include "app/study/record_point.h"

namespace limpid {

void check_point(const SweepPlan& plan, std::uint64_t index) {
  if (plan.boundary) throw UsageError("--open: a point of a boundary is many runs");
  if (index < plan.points()) return;
  throw UsageError(fmt::format("--open {}: is not allowed; allowed: a point from 0 to {}", index,
                               plan.points() - 1));
}

int open_point(const SweepPlan& plan, std::uint64_t index, const std::filesystem::path& out) {
  const std::filesystem::path file = point_file(out, index, {});
  const auto recorded = record_point(plan, index, {}, file, interrupted);
  if (!recorded) return 1;
  fmt::print("{}recorded in {}\n", recorded->summary.text(), file.string());
  std::fflush(stdout);
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return 0;
  ::execl("/proc/self/exe", "limpid", "play", file.c_str(), nullptr);
  return 0;
}

}  // namespace limpid
