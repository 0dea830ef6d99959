// A plot as a table and as a picture made of lines.
#pragma once

#include <string>

#include "app/plot/autoscale.h"
#include "app/plot/history.h"
#include "app/plot/plot_spec.h"

namespace limpid {

// How many rows plot_csv() would have, without its header.
std::size_t plot_csv_rows(const History& history, double start, double stop);

// Header "time [s],label [unit],..." and a line for each row of the history with
// start <= time <= stop, times without the history's offset; visible curves only, in the plot's
// unit. What is not a number is left empty.
std::string plot_csv(const PlotSpec& spec, const History& history, double start, double stop);

// A complete SVG document, `width` x `height` [px], of the visible curves over [start, stop] and
// `y` in the channels' unit; light colours, for paper.
struct PlotPicture {
  double start;
  double stop;
  Limits y;
  int width = 720;
  int height = 360;
};
std::string plot_svg(const PlotSpec& spec, const History& history, const PlotPicture& picture);

}  // namespace limpid
