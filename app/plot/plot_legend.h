// Names of the curves; a click hides or shows one.
#pragma once

#include <vector>

#include "app/plot/plot_frame.h"

namespace limpid {

class PlotLegend {
 public:
  struct Room {
    ScreenRect outer;    // of the plot
    ScreenRect beside;   // the title, on its line
    float least_height;  // of the curves
  };
  // Places the legend beside the title if there is room. Else it has lines of its own under the
  // title, as many as leave the curves their height, but one at least. For lack of room hidden
  // curves lose their names first. Then names have their curves' colours, without a sample and
  // without the words shared with the name before. Then each quantity is named once for all runs.
  // Returns the height it takes under the title.
  float place(const Room& room, const PlotSpec& spec, float scale);

  // Curve under the mouse, -1 for none.
  int curve_at(ImVec2 mouse) const;

  void draw(const PlotFrame& frame, const PlotSpec& spec, int hovered) const;

 private:
  struct Entry {
    ScreenRect box;
    int curve;
    std::string label;
  };
  struct Style {
    bool hidden_too, samples, runs;
  };
  ImVec2 lay_out(const PlotSpec& spec, float width, float scale);
  std::string label_of(const std::string& whole, const std::string& before) const;
  float sample_width(float scale) const;
  void move_entries(ImVec2 by);

  std::vector<Entry> entries_;
  Style style_{true, true, true};
};

}  // namespace limpid
