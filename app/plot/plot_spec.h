// What a plot shows: plain data, the same for the window, pictures and tables.
#pragma once

#include <string>
#include <vector>

#include "app/style/palette.h"

namespace limpid {

// What stands along its horizontal axis.
enum class PlotKind : std::uint8_t {
  time,
  cross,     // another channel
  spectrum,  // the frequency, of the stretch of time shown
};

// Drawn on a curve at even distances, so that curves of two runs differ by more than a tint.
enum class RunSign : std::uint8_t { none, square, ring };

struct Curve {
  int channel = 0;
  int across = -1;  // of kind cross: the channel along the horizontal axis
  std::string label = {};
  Ink ink = Ink::neutral;
  float shade = 0;  // see ink()
  bool visible = true;
  int law = -1;  // the curve has this law's colour instead of its thing's
  RunSign sign = RunSign::none;
};
inline Rgb colour_of(const Palette& palette, const Curve& curve) {
  const Rgb pure = curve.law < 0 ? ink(palette, curve.ink) : law_ink(palette, curve.law);
  return shaded(palette, pure, curve.shade);
}

struct Threshold {
  double value;  // in the channels' unit
  std::string label;
  Ink ink = Ink::neutral;
  bool always_in_view = false;  // autoscale makes room for it
};

// Tinted behind the curves by what a channel says: one of the numbers from 0 that have a name here.
// Where 0 has none it is the usual; where it has one, only changes are of interest.
struct Band {
  int channel = 0;
  std::vector<std::string> names = {};
  float tint = 0.13f;  // of the last one; those before have less
  // All but 0 look alike, striped: what is behind them is not what it seems.
  bool striped = false;
  // They are coupling laws: each has its colour, 0 too, and an edge of it at the top.
  bool laws = false;
  // Marks with this key say what the band says: they go without a label while it is seen.
  std::string key = {};
};

// How an axis is written while it shows no more than `most` [the channels' unit].
struct PlotUnit {
  std::string name;
  double factor;  // from the channels' unit
  double most;
};

struct PlotAxis {
  std::string label = {};            // of the horizontal one
  std::string unit = {};             // after multiplication by factor
  double factor = 1;                 // from the channels' unit, such as 1000 from rad to mrad
  std::vector<PlotUnit> units = {};  // smallest first, to choose unit and factor from; or none
  bool zero_line = true;             // emphasised and always in view
  double smallest_span = 1e-6;       // autoscale shows at least this much, in the channels' unit
  bool log = false;

  void choose_unit(double largest) {
    for (const PlotUnit& each : units) {
      unit = each.name;
      factor = each.factor;
      if (largest <= each.most) return;
    }
  }
};

struct PlotSpec {
  std::string title = {};
  std::string file_name = {};  // for saving, without folder and extension: "coordination-error"
  PlotKind kind = PlotKind::time;
  PlotAxis x = {}, y = {};  // over time, x is the group's
  std::vector<Curve> curves = {};
  std::vector<Threshold> thresholds = {};
  std::vector<Band> bands = {};
  bool end_labels = false;  // the value of each curve at the right end, over time
};

}  // namespace limpid
