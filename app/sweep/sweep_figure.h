// A sweep's table as a figure.
#pragma once

#include "app/plot/figure.h"
#include "app/sweep/sweep_table.h"

namespace limpid {

// Figure of the points done: a map over two axes of a grid's numbers, a line over one, dots over the first
// axis where all are sampled or words; a boundary over one, with the lines of theory that the plan
// asks for. A panel for each case of the other axes, kMostPanels at most, evenly thinned.
Figure sweep_figure(const SweepPlan& plan, const SweepTable& table);

inline constexpr std::size_t kMostPanels = 12;

}  // namespace limpid
