// Canvas for a plot's picture: the lines of an SVG document, a page of PDF, or pixels.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "app/style/palette.h"

namespace limpid {

// Draws at places and in sizes in pixels of the layout, from the upper left corner.
class PlotCanvas {
 public:
  struct Point {
    double x = 0, y = 0;
  };
  struct Box {
    double left = 0, top = 0, width = 0, height = 0;
  };
  enum class Anchor : std::uint8_t { start, middle, end };

  virtual ~PlotCanvas() = default;

  virtual void rect(const Box& box, Rgb fill, double alpha) = 0;
  virtual void outline(const Box& box, Rgb rgb) = 0;
  virtual void stripes(const Box& box, Rgb rgb) = 0;
  // Draws dashes of that length with gaps between; a whole line if `dash` is 0.
  virtual void line(Point from, Point to, Rgb rgb, double width, double dash, double gap) = 0;
  virtual void polyline(std::span<const Point> points, Rgb rgb, double width) = 0;
  // Draws a filled polygon, with an edge of the same colour.
  virtual void polygon(std::span<const Point> points, Rgb rgb, double width) = 0;
  virtual void square(Point middle, double half, Rgb fill, Rgb edge) = 0;
  virtual void ring(Point middle, double radius, Rgb edge, Rgb fill) = 0;
  // Draws text with its anchor at `at`, on the base line.
  virtual void text(Point at, Anchor anchor, Rgb rgb, const std::string& what, bool bold) = 0;
  // Draws nothing outside of `box` from now on; null: everything.
  virtual void clip(const Box* box) = 0;
};

inline constexpr double kCanvasFont = 12;  // height of all text [px]

}  // namespace limpid
