// Plots beside one another.
#pragma once

#include <vector>

#include "app/plot/plot_frame.h"

namespace limpid {

struct PlotPlaces {
  std::vector<ScreenRect> places;  // one for each plot, from (0, 0) on [px]
  float width = 0;                 // needed by all; if it is more than the room, they scroll
};

// Places plots in one row while each has the width it needs, else in two where there is height for
// that. A plot over another channel is as wide as it is high, the others share the rest.
PlotPlaces place_plots(const std::vector<PlotKind>& kinds, ImVec2 room, float gap, float scale);

}  // namespace limpid
