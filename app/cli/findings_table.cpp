#include "app/cli/findings_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace limpid {

void print(const Identification& identification) {
  const Identified& found = identification.found;
  fmt::print("{:<14}", "joint");
  for (const FindingInfo& info : kFindings) {
    fmt::print(" {:>22}", fmt::format("{} [{}]", info.label, info.unit));
  }
  fmt::print(" {:>10} {:>9}\n", "inertia was", "missed");
  for (std::size_t j = 0; j < found.joints.size(); ++j) {
    const JointFinding& joint = found.joints[j];
    fmt::print("{:<14}", found.arm.joints[j].name);
    for (const FindingInfo& info : kFindings) {
      fmt::print(" {:>22}", text_of(joint.*info.field, info.per_unit));
    }
    fmt::print(" {:>11.3f} {:>7.1f} %\n", identification.inertia_in_file[j] / 1e-3,
               100 * joint.residual / joint.torque);
  }
  fmt::print("delay          {} ms from a reading to the torque that answers it\n",
             text_of(found.delay, 1e-3));
  const ReadingTimes& timing = identification.bare.timing;
  if (timing.rate > 0) {
    fmt::print(
        "readings       {:.0f} a second; between two: {:.2f} ms in the middle, {:.2f} ms at "
        "99 %, {:.2f} ms at most\n",
        timing.rate, 1e3 * timing.p50, 1e3 * timing.p99, 1e3 * timing.most);
  }
  if (identification.torque_scale) {
    fmt::print("motors         give {} times what they are told\n",
               text_of(*identification.torque_scale, 1));
  }
}

void print_drift(const Findings& last, const Identification& now) {
  const std::vector<Drift> all = drift(last, now);
  if (all.empty()) return;
  const auto certain = std::ranges::count_if(all, &Drift::certain);
  fmt::print("since {}: {}\n", last.when, certain == 0 ? "nothing has changed" : "changed are");
  for (const Drift& d : all) {
    if (!d.certain) continue;
    fmt::print("  {:<30} {} -> {} {}\n", d.what, text_of(d.before, 1), text_of(d.now, 1), d.unit);
  }
}

}  // namespace limpid
