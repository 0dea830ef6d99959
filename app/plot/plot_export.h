// A plot as a table and as a picture made of lines.
#pragma once

#include <string>
#include <vector>

#include "app/plot/axis.h"
#include "app/plot/history.h"
#include "app/plot/plot_spec.h"
#include "app/plot/raster_canvas.h"

namespace limpid {

// What a plot shows, to be written whatever becomes of the history: visible curves only, in the
// plot's unit, over start <= time <= stop, times without the history's offset. Of a spectrum the
// frequencies stand in place of times.
struct PlotTable {
  std::string first = "time [s]";
  std::vector<std::string> columns;  // "label [unit]"
  std::vector<double> times;         // [s], or [Hz]
  std::vector<double> values;        // a row after the other
};
PlotTable plot_table(const PlotSpec& spec, const History& history, double start, double stop);

// Header "time [s],label [unit],..." and a line for each row. What is not a number is left empty.
std::string csv_text(const PlotTable& table);

// A complete SVG document, `width` x `height` [px], of the visible curves over [start, stop] and
// `y` in the channels' unit; over other things than time on `x`; light colours are for paper.
struct PlotPicture {
  double start;
  double stop;
  AxisMap x, y;
  int width = 720;
  int height = 360;
  Theme theme = Theme::light;
  double millimetres = 0;  // how wide it is printed; 0: as many pixels
};
std::string plot_svg(const PlotSpec& spec, const History& history, const PlotPicture& picture);
// The same picture on another canvas, and the colour of its paper.
Rgb draw_plot(const PlotSpec& spec, const History& history, const PlotPicture& picture,
              PlotCanvas& canvas);
// In pixels, `scale` of them for one of the layout.
Raster plot_raster(const PlotSpec& spec, const History& history, const PlotPicture& picture,
                   double scale);

}  // namespace limpid
