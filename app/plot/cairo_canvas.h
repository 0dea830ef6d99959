// Canvases of cairo: the pixels of a picture, or a page of PDF. They need no window and no graphics
// card, and may be used on any thread. Errors of constructors, take() and end(): std::runtime_error
// if cairo has no memory or cannot draw.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/plot/plot_canvas.h"

namespace limpid {

// An image: four bytes a pixel, top row first, opaque.
struct Raster {
  int width = 0, height = 0;
  std::vector<unsigned char> rgba;
};

class CairoCanvas : public PlotCanvas {
 public:
  ~CairoCanvas() override;

  void rect(const Box& box, Rgb fill, double alpha) override;
  void outline(const Box& box, Rgb rgb) override;
  void stripes(const Box& box, Rgb rgb) override;
  void line(Point from, Point to, Rgb rgb, double width, double dash, double gap) override;
  void polyline(std::span<const Point> points, Rgb rgb, double width) override;
  void polygon(std::span<const Point> points, Rgb rgb, double width) override;
  void square(Point middle, double half, Rgb fill, Rgb edge) override;
  void ring(Point middle, double radius, Rgb edge, Rgb fill) override;
  // Leaves text out if no font is installed.
  void text(Point at, Anchor anchor, Rgb rgb, const std::string& what, bool bold) override;
  void clip(const Box* box) override;

 protected:
  struct Impl;
  explicit CairoCanvas(std::unique_ptr<Impl> impl);

  std::unique_ptr<Impl> impl_;
};

class RasterCanvas : public CairoCanvas {
 public:
  // `scale`: pixels of the picture for one of the layout, whose size is `width` x `height`.
  RasterCanvas(double width, double height, double scale, Rgb paper);
  Raster take();
};

class PdfCanvas : public CairoCanvas {
 public:
  // `scale`: points [1/72 inch] for one pixel of the layout. `made_by` stands in the document's
  // properties.
  PdfCanvas(double width, double height, double scale, Rgb paper, const std::string& made_by);
  std::string end();  // the whole document
};

}  // namespace limpid
