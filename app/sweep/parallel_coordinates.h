// Points of many axes side by side.
#pragma once

#include "app/figure/figure.h"
#include "app/sweep/sweep_table.h"

namespace limpid {

// An upright for each axis of numbers, from its lowest value to its highest, and one for the
// measure that the figure shows; each point a line across, in the colour of its measure: no and
// yes, or by quarters. kMostLines at most, evenly thinned.
FigurePanel parallel_coordinates(const SweepPlan& plan, const SweepTable& table);

inline constexpr std::size_t kMostLines = 600;

}  // namespace limpid
