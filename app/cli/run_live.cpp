#include "app/cli/run_live.h"

#include <fmt/format.h>

#include "app/base/interrupt.h"
#include "app/cli/live_bench.h"
#include "app/cli/picture.h"
#include "app/run/summary.h"

namespace limpid {

int run_live(const LiveRunOptions& options) {
  LiveBench bench(options.live, options.input);
  const RunPlan& plan = bench.plan();
  Summary summary(RowLayout(plan.arm.dof()));
  const double seconds = options.input.duration.value_or(kLiveSeconds);
  const LiveTask task{
      fmt::format("Take hold of {}: {:.3g} s, as you like.", plan.arm.name, seconds), seconds,
      options.record, options.force};
  const bool whole = bench.carry_out(task, plan.parameters,
                                     [&](std::span<const double> row) { summary.add(row); });
  if (summary.totals().rows == 0) {
    fmt::print(stderr, "limpid: stopped\n");
    return 1;
  }
  if (!options.picture.empty()) save_picture(options.picture, plan, summary.memorable(), {});
  fmt::print("{}", summary.text());
  if (!options.record.empty()) fmt::print("recorded in {}\n", options.record);
  if (!whole) fmt::print(stderr, "limpid: stopped at {:.3f} s\n", summary.time());
  return 0;
}

}  // namespace limpid
