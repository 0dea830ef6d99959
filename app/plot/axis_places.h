// Where a value axis has its lines and labels.
#pragma once

#include <string>
#include <vector>

#include "app/plot/axis_map.h"
#include "app/plot/plot_spec.h"

namespace limpid {

struct AxisPlace {
  double value;       // in the channels' unit
  std::string label;  // empty: a line of the grid alone
};

// At most about `most` labels, from the low end to the high one.
std::vector<AxisPlace> axis_places(const PlotAxis& axis, const AxisMap& map, double most);

// What the labels are multiplied by, and their unit.
std::string unit_text(const PlotAxis& axis, const AxisMap& map);

}  // namespace limpid
