// A point of a sweep on its own.
#pragma once

#include "app/study/sweep_plan.h"

namespace limpid {

// Errors: UsageError where there is no run to that number.
void check_point(const SweepPlan& plan, std::uint64_t index);

// Runs it again, records it in `out` and plays it, where there is a display. The exit status.
int open_point(const SweepPlan& plan, std::uint64_t index, const std::filesystem::path& out);

}  // namespace limpid
