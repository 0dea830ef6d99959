// Specification of a plot: plain data, the same for the window, pictures and tables.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "app/style/palette.h"
#include "core/base/lanes.h"

namespace limpid {

// Quantity along a plot's horizontal axis.
enum class PlotKind : std::uint8_t {
  time,
  cross,     // another channel
  spectrum,  // frequency, in the stretch of time shown
};

// Sign drawn on a curve at even distances, so that curves of two runs differ by more than a tint.
enum class RunSign : std::uint8_t { none, square, ring, triangle };

// Returns the sign of a lane's curves.
constexpr RunSign sign_of_lane(std::size_t lane) {
  constexpr std::array kSigns{RunSign::none, RunSign::square, RunSign::triangle};
  static_assert(kSigns.size() == kMostLanes);
  return kSigns[lane];
}

struct Curve {
  int channel = 0;
  int across = -1;  // of kind cross: the channel along the horizontal axis
  std::string label = {};
  std::string help = {};  // what it is, for people
  Ink ink = Ink::neutral;
  float shade = 0;  // see ink()
  bool visible = true;
  int law = -1;               // of now: the curve has its colour instead of its thing's
  std::string law_name = {};  // of that law, in a plot of one run that has no band to say it
  // Channel of the law that made each value: parts of another law have that one's colour.
  int law_channel = -1;
  RunSign sign = RunSign::none;

  // Name in legends.
  std::string name() const { return law_name.empty() ? label : law_name + " " + label; }
};
inline Rgb colour_of(const Palette& palette, const Curve& curve) {
  const Rgb pure = curve.law < 0 ? ink(palette, curve.ink) : law_ink(palette, curve.law);
  return shaded(palette, pure, curve.shade);
}

// Returns the colour of a part that this law made; -1: the law of now.
inline Rgb colour_of(const Palette& palette, const Curve& curve, int made_by) {
  if (curve.law < 0 || made_by < 0 || made_by == curve.law) return colour_of(palette, curve);
  return law_ink(palette, made_by);
}

struct Threshold {
  double value;  // in the channels' unit
  std::string label;
  Ink ink = Ink::neutral;
  bool always_in_view = false;  // autoscale makes room for it
};

// Tint behind the curves by a channel's value: a number from 0 that has a name here. Without a
// name, 0 is the usual value; if 0 has one, only changes are of interest.
struct Band {
  int channel = 0;
  std::vector<std::string> names = {};
  float tint = 0.13f;  // of the last value; those before have less
  // All values but 0 look alike, striped: the curves there are not what they seem.
  bool striped = false;
  // Values are coupling laws: each, 0 too, has its colour, and an edge of it at the top.
  bool laws = false;
  int lane = -1;  // of laws in several lanes: an edge of this lane's place alone, without a tint
  // Key of marks that say the same as the band: they have no label while it is seen.
  std::string key = {};
};

// Unit of an axis while it shows no more than `most` [the channels' unit].
struct PlotUnit {
  std::string name;
  double factor;  // from the channels' unit
  double most;
};

struct PlotAxis {
  std::string label = {};            // of the horizontal axis
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
