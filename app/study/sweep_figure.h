// A sweep's table as a figure.
#pragma once

#include "app/study/figure.h"
#include "app/study/sweep_table.h"

namespace limpid {

// Parallel coordinates: an upright for each axis of numbers, from lowest to highest value, and one
// for the figure's measure. Each point is a line across, coloured by its measure: no and yes, or
// quarters. At most kMostLines, evenly thinned.
FigurePanel parallel_coordinates(const SweepPlan& plan, const SweepTable& table);

inline constexpr std::size_t kMostLines = 600;

// Figure of the points done: a map over two axes of numbers, slices over one, parallel coordinates
// over sampled axes. A boundary over one axis, with the plan's lines of theory. A panel for each
// case of the other axes, at most kMostPanels, evenly thinned.
Figure sweep_figure(const SweepPlan& plan, const SweepTable& table);

inline constexpr std::size_t kMostPanels = 12;

}  // namespace limpid
