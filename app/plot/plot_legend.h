// Names of the curves; a click hides or shows one.
#pragma once

#include <vector>

#include "app/plot/plot_frame.h"

namespace limpid {

class PlotLegend {
 public:
  // Beside the title, from `title_end` to the right end of `outer`, where there is room; else on
  // lines of its own under the title's `title_bottom`, as many as leave `least_height` for the
  // curves, but one at least: what is hidden goes without a name first, then names are in their
  // curves' colours without a sample. Returns how much height it takes under the title.
  float place(const ScreenRect& outer, float title_end, float title_bottom, float least_height,
              const PlotSpec& spec, float scale);

  // Curve under the mouse, -1 for none.
  int curve_at(ImVec2 mouse) const;

  void draw(const PlotFrame& frame, const PlotSpec& spec, int hovered) const;

 private:
  struct Entry {
    ScreenRect box;
    int curve;
  };
  ImVec2 lay_out(const PlotSpec& spec, bool hidden_too, float width, float scale);
  float sample_width(float scale) const;
  void move_entries(ImVec2 by);

  std::vector<Entry> entries_;
  bool samples_ = true;
};

}  // namespace limpid
