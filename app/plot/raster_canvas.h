// A canvas of pixels: lines and text are filled outlines, each pixel by the part that is covered.
// So a picture is the same at any resolution. It needs no window and no graphics card, and may be
// used on any thread.
#pragma once

#include <memory>
#include <vector>

#include "app/plot/plot_canvas.h"

namespace limpid {

// An image: four bytes a pixel, top row first, opaque.
struct Raster {
  int width = 0, height = 0;
  std::vector<unsigned char> rgba;
};

class RasterCanvas : public PlotCanvas {
 public:
  // `scale`: pixels of the picture for one of the layout, whose size is `width` x `height`. Text is
  // left out if no font is installed.
  RasterCanvas(double width, double height, double scale, Rgb paper);
  ~RasterCanvas() override;

  void rect(const Box& box, Rgb fill, double alpha) override;
  void outline(const Box& box, Rgb rgb) override;
  void stripes(const Box& box, Rgb rgb) override;
  void line(Point from, Point to, Rgb rgb, double width, double dash, double gap) override;
  void polyline(std::span<const Point> points, Rgb rgb, double width) override;
  void polygon(std::span<const Point> points, Rgb rgb, double width) override;
  void square(Point middle, double half, Rgb fill, Rgb edge) override;
  void ring(Point middle, double radius, Rgb edge, Rgb fill) override;
  void text(Point at, Anchor anchor, Rgb rgb, const std::string& what, bool bold) override;
  void clip(const Box* box) override;

  Raster take();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace limpid
