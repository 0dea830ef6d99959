// A sweep's table as a figure.
#pragma once

#include "app/study/figure.h"
#include "app/study/sweep_table.h"

namespace limpid {

// Points of many axes side by side.

// An upright for each axis of numbers, from its lowest value to its highest, and one for the
// measure that the figure shows; each point a line across, in the colour of its measure: no and
// yes, or by quarters. kMostLines at most, evenly thinned.
FigurePanel parallel_coordinates(const SweepPlan& plan, const SweepTable& table);

inline constexpr std::size_t kMostLines = 600;

// Of what is done: a map over two axes of numbers, slices over one, parallel coordinates over
// sampled ones; a boundary over one, with the lines of theory that the plan asks for. A panel for
// each case of the other axes, kMostPanels at most, evenly thinned.
Figure sweep_figure(const SweepPlan& plan, const SweepTable& table);

inline constexpr std::size_t kMostPanels = 12;

}  // namespace limpid
