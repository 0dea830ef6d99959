// Plots as tables and pictures: SVG documents, or drawn on a canvas.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/plot/axis.h"
#include "app/plot/cairo_canvas.h"
#include "app/plot/history.h"
#include "app/plot/plot_spec.h"

namespace limpid {

// Table of what a plot shows, which outlives the history's rows: visible curves only, in the plot's
// unit, over start <= time <= stop, times without the history's offset. A spectrum has frequencies
// in place of times.
struct PlotTable {
  std::string first = "time [s]";
  std::vector<std::string> columns;  // "label [unit]"
  std::vector<double> times;         // [s], or [Hz]
  std::vector<double> values;        // row by row
};
PlotTable plot_table(const PlotSpec& spec, const History& history, double start, double stop);

// Returns a header "time [s],label [unit],..." and a line for each row. Values that are not numbers
// are left empty.
std::string csv_text(const PlotTable& table);

// Returns words for a message about the table: that negative times are of the run before, or none.
std::string word_on_times(const PlotTable& table);

// Stretch and look of a plot's picture: the visible curves over [start, stop]. `y` is in the
// channels' unit; `x` is for other things than time; light colours are for paper.
struct PlotPicture {
  double start;
  double stop;
  AxisMap x, y;
  int width = 720;
  int height = 360;
  Theme theme = Theme::light;
  double millimetres = 0;  // printed width; 0: as many pixels
};
// A plot of a figure, below the one before.
struct FigurePart {
  PlotSpec spec;
  PlotPicture picture;
};
// Returns a complete SVG document of all parts, which have one width and one look, and `height`
// each [px]; or of one plot.
std::string figure_svg(std::span<const FigurePart> parts, const History& history);
std::string plot_svg(const PlotSpec& spec, const History& history, const PlotPicture& picture);
// Returns the colour of a picture's paper.
Rgb paper_of(const PlotPicture& picture);
// Draws the same figure, or picture, on another canvas.
void draw_figure(std::span<const FigurePart> parts, const History& history, PlotCanvas& canvas);
void draw_plot(const PlotSpec& spec, const History& history, const PlotPicture& picture,
               PlotCanvas& canvas);
// Draws the same picture in pixels, `scale` of them for one of the layout.
Raster plot_raster(const PlotSpec& spec, const History& history, const PlotPicture& picture,
                   double scale);

}  // namespace limpid
