// A sweep's table as a figure.
#pragma once

#include "app/plot/figure.h"
#include "app/sweep/sweep_table.h"

namespace limpid {

// Figure of the points done: a map over two axes of a grid's numbers, or a line over one. Dots over
// the first axis if all are sampled or words. A boundary over one axis, with the plan's lines of
// theory. One panel for each case of the other axes, kMostPanels at most, evenly thinned.
Figure sweep_figure(const SweepPlan& plan, const SweepTable& table);

inline constexpr std::size_t kMostPanels = 12;

}  // namespace limpid
