// A canvas that draws on another one, further down: parts of a figure below one another.
#pragma once

#include <string>
#include <vector>

#include "app/plot/plot_canvas.h"

namespace limpid {

class ShiftedCanvas : public PlotCanvas {
 public:
  ShiftedCanvas(PlotCanvas& on, double down) : on_(on), down_(down) {}

  void rect(const Box& box, Rgb fill, double alpha) override { on_.rect(moved(box), fill, alpha); }
  void outline(const Box& box, Rgb rgb) override { on_.outline(moved(box), rgb); }
  void stripes(const Box& box, Rgb rgb) override { on_.stripes(moved(box), rgb); }
  void line(Point from, Point to, Rgb rgb, double width, double dash, double gap) override {
    on_.line(moved(from), moved(to), rgb, width, dash, gap);
  }
  void polyline(std::span<const Point> points, Rgb rgb, double width) override {
    on_.polyline(moved(points), rgb, width);
  }
  void polygon(std::span<const Point> points, Rgb rgb, double width) override {
    on_.polygon(moved(points), rgb, width);
  }
  void square(Point middle, double half, Rgb fill, Rgb edge) override {
    on_.square(moved(middle), half, fill, edge);
  }
  void ring(Point middle, double radius, Rgb edge, Rgb fill) override {
    on_.ring(moved(middle), radius, edge, fill);
  }
  void text(Point at, Anchor anchor, Rgb rgb, const std::string& what, bool bold) override {
    on_.text(moved(at), anchor, rgb, what, bold);
  }
  void clip(const Box* box) override {
    if (box == nullptr) return on_.clip(nullptr);
    const Box below = moved(*box);
    on_.clip(&below);
  }

 private:
  Point moved(Point p) const { return {p.x, p.y + down_}; }
  Box moved(Box box) const {
    box.top += down_;
    return box;
  }
  std::vector<Point> moved(std::span<const Point> points) const {
    std::vector<Point> all(points.begin(), points.end());
    for (Point& each : all) each.y += down_;
    return all;
  }

  PlotCanvas& on_;
  double down_;
};

}  // namespace limpid
