// A recorded drawing, to be played on another canvas: beside the window, say, where it may take its
// time.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/plot/plot_canvas.h"

namespace limpid {

class CanvasTape : public PlotCanvas {
 public:
  void rect(const Box& box, Rgb fill, double alpha) override {
    keep([=](PlotCanvas& to) { to.rect(box, fill, alpha); });
  }
  void outline(const Box& box, Rgb rgb) override {
    keep([=](PlotCanvas& to) { to.outline(box, rgb); });
  }
  void stripes(const Box& box, Rgb rgb) override {
    keep([=](PlotCanvas& to) { to.stripes(box, rgb); });
  }
  void line(Point from, Point to, Rgb rgb, double width, double dash, double gap) override {
    keep([=](PlotCanvas& on) { on.line(from, to, rgb, width, dash, gap); });
  }
  void polyline(std::span<const Point> points, Rgb rgb, double width) override {
    keep([all = std::vector(points.begin(), points.end()), rgb, width](PlotCanvas& to) {
      to.polyline(all, rgb, width);
    });
  }
  void polygon(std::span<const Point> points, Rgb rgb, double width) override {
    keep([all = std::vector(points.begin(), points.end()), rgb, width](PlotCanvas& to) {
      to.polygon(all, rgb, width);
    });
  }
  void square(Point middle, double half, Rgb fill, Rgb edge) override {
    keep([=](PlotCanvas& to) { to.square(middle, half, fill, edge); });
  }
  void ring(Point middle, double radius, Rgb edge, Rgb fill) override {
    keep([=](PlotCanvas& to) { to.ring(middle, radius, edge, fill); });
  }
  void text(Point at, Anchor anchor, Rgb rgb, const std::string& what, bool bold) override {
    keep([=](PlotCanvas& to) { to.text(at, anchor, rgb, what, bold); });
  }
  void clip(const Box* box) override {
    const auto kept = box != nullptr ? std::optional(*box) : std::nullopt;
    keep([kept](PlotCanvas& to) { to.clip(kept ? &*kept : nullptr); });
  }

  void play(PlotCanvas& to) const {
    for (const auto& step : steps_) step(to);
  }

 private:
  template <class Step>
  void keep(Step step) {
    steps_.emplace_back(std::move(step));
  }

  std::vector<std::function<void(PlotCanvas&)>> steps_;
};

}  // namespace limpid
