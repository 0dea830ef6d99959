// Names of the curves; a click hides or shows one.
#pragma once

#include <vector>

#include "app/plot/plot_frame.h"

namespace limpid {

class PlotLegend {
 public:
  // Beside the title, from `title_end` to the right end of `outer`, where there is room; else on
  // lines of its own under the title's `title_bottom`, as long as `least_height` is left for the
  // curves; else inside. Returns how much height it takes under the title.
  float place_outside(const ScreenRect& outer, float title_end, float title_bottom,
                      float least_height, const PlotSpec& spec, float scale);

  // Where place_outside() found no room: the corner where it hides least of the traces. Nowhere in
  // a plot that is too small for it.
  void place_inside(const PlotFrame& frame, const PlotSpec& spec, const std::vector<Trace>& traces);

  // Curve under the mouse, -1 for none.
  int curve_at(ImVec2 mouse) const;

  void draw(const PlotFrame& frame, const PlotSpec& spec, int hovered) const;

 private:
  struct Entry {
    ScreenRect box;
    int curve;
  };
  ImVec2 lay_out(const PlotSpec& spec, float width, float scale);
  void move_entries(ImVec2 by);

  std::vector<Entry> entries_;
  ScreenRect box_;
  bool inside_ = false;
  int corner_ = 0;  // bit 0: right, bit 1: bottom
};

}  // namespace limpid
