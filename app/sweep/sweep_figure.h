// A sweep's table as a figure.
#pragma once

#include "app/figure/figure.h"
#include "app/sweep/sweep_table.h"

namespace limpid {

// Of what is done: a map over two axes of numbers, slices over one, parallel coordinates over
// sampled ones; a boundary over one, with the lines of theory that the plan asks for. A panel for
// each case of the other axes, kMostPanels at most, evenly thinned.
Figure sweep_figure(const SweepPlan& plan, const SweepTable& table);

inline constexpr std::size_t kMostPanels = 12;

}  // namespace limpid
