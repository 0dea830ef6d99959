// What a plot shows: plain data, the same for the window, pictures and tables.
#pragma once

#include <string>
#include <vector>

#include "app/style/palette.h"

namespace limpid {

struct Curve {
  int channel = 0;
  std::string label = {};
  Ink ink = Ink::neutral;
  float shade = 0;  // see ink()
  bool dashed = false;
  int dash_channel = -1;  // >= 0: dashed wherever this channel is below 0.5 (standard coupling)
  bool visible = true;
};

struct Threshold {
  double value;  // in the channels' unit
  std::string label;
  Ink ink = Ink::neutral;
  bool always_in_view = false;  // autoscale makes room for it
};

// How an axis is written while it shows no more than `most` [the channels' unit].
struct PlotUnit {
  std::string name;
  double factor;  // from the channels' unit
  double most;
};

struct PlotSpec {
  std::string title = {};
  std::string unit = {};             // after multiplication by factor
  double factor = 1;                 // from the channels' unit, such as 1000 from rad to mrad
  std::vector<PlotUnit> units = {};  // smallest first, to choose unit and factor from; or none
  std::string file_name = {};  // for saving, without folder and extension: "coordination-error"
  std::vector<Curve> curves = {};
  std::vector<Threshold> thresholds = {};
  int band_channel = -1;  // >= 0: tinted behind the curves wherever this channel is above 0.5
  std::string band_label = {};
  bool zero_line = true;        // emphasised and always in view
  double smallest_span = 1e-6;  // autoscale shows at least this much, in the channels' unit, > 0
};

}  // namespace limpid
