// Drawings that are moved or played again: each call comes as it was given.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "app/plot/canvas_tape.h"
#include "app/plot/plot_export.h"
#include "app/plot/shifted_canvas.h"

namespace limpid {
namespace {

// Writes each call in words, as if it were given further down.
class CallsInWords : public PlotCanvas {
 public:
  explicit CallsInWords(double down = 0) : down_(down) {}

  void rect(const Box& box, Rgb fill, double alpha) override {
    say("rect", of(box) + of(fill) + of(alpha));
  }
  void outline(const Box& box, Rgb rgb) override { say("outline", of(box) + of(rgb)); }
  void stripes(const Box& box, Rgb rgb) override { say("stripes", of(box) + of(rgb)); }
  void line(Point from, Point to, Rgb rgb, double width, double dash, double gap) override {
    say("line", of(from) + of(to) + of(rgb) + of(width) + of(dash) + of(gap));
  }
  void polyline(std::span<const Point> points, Rgb rgb, double width) override {
    say("polyline", of(points) + of(rgb) + of(width));
  }
  void polygon(std::span<const Point> points, Rgb rgb, double width) override {
    say("polygon", of(points) + of(rgb) + of(width));
  }
  void square(Point middle, double half, Rgb fill, Rgb edge) override {
    say("square", of(middle) + of(half) + of(fill) + of(edge));
  }
  void ring(Point middle, double radius, Rgb edge, Rgb fill) override {
    say("ring", of(middle) + of(radius) + of(edge) + of(fill));
  }
  void text(Point at, Anchor anchor, Rgb rgb, const std::string& what, bool bold) override {
    say("text", of(at) + of(static_cast<double>(anchor)) + of(rgb) + what + (bold ? " bold" : ""));
  }
  void clip(const Box* box) override { say("clip", box == nullptr ? " none" : of(*box)); }

  std::vector<std::string> all;
  bool has(const std::string& call) const {
    return std::ranges::any_of(all, [&](const std::string& c) { return c.starts_with(call); });
  }

 private:
  void say(const char* call, const std::string& how) { all.push_back(call + how); }
  static std::string of(double x) { return fmt::format(" {:.6f}", x); }
  static std::string of(Rgb c) { return fmt::format(" #{:02x}{:02x}{:02x}", c.r, c.g, c.b); }
  std::string of(Point p) const { return of(p.x) + of(p.y + down_); }
  std::string of(const Box& box) const {
    return of(box.left) + of(box.top + down_) + of(box.width) + of(box.height);
  }
  std::string of(std::span<const Point> points) const {
    std::string text;
    for (const Point& p : points) text += of(p);
    return text;
  }

  double down_;
};

// Calls everything that a canvas can do, each with numbers of its own.
void call_all(PlotCanvas& canvas) {
  const Rgb red{200, 10, 20}, blue{10, 20, 200};
  const std::array<PlotCanvas::Point, 3> points{{{1, 2}, {3, 5}, {7, 11}}};
  const PlotCanvas::Box box{13, 17, 19, 23};
  canvas.clip(&box);
  canvas.rect(box, red, 0.5);
  canvas.outline(box, blue);
  canvas.stripes(box, red);
  canvas.line({29, 31}, {37, 41}, blue, 2, 3, 5);
  canvas.polyline(points, red, 1.5);
  canvas.polygon(points, blue, 2.5);
  canvas.square({43, 47}, 4, red, blue);
  canvas.ring({53, 59}, 6, blue, red);
  canvas.text({61, 67}, PlotCanvas::Anchor::end, red, "words", true);
  canvas.clip(nullptr);
}

TEST(CallsOfACanvas, AreMovedDown) {
  CallsInWords moved, wanted(100);
  ShiftedCanvas shifted(moved, 100);
  call_all(shifted);
  call_all(wanted);
  EXPECT_EQ(moved.all, wanted.all);
}

TEST(CallsOfACanvas, ArePlayedAsOftenAsOneLikes) {
  CanvasTape tape;
  call_all(tape);
  CallsInWords wanted;
  call_all(wanted);
  for (int i = 0; i < 2; ++i) {
    CallsInWords played;
    tape.play(played);
    EXPECT_EQ(played.all, wanted.all);
  }
}

// Parts of a figure are the plots' pictures, one below the other.
TEST(CallsOfACanvas, OfAFigureAreThoseOfItsPlots) {
  History history({.channels = 2});
  for (int k = 0; k <= 5000; ++k) {
    const double t = 1e-3 * k;
    history.append(t, std::array{t, t < 2 ? 0.0 : 1.0});
  }
  history.mark(1, "a note", kNoteMark);
  PlotSpec spec{.title = "Force", .y = {.unit = "N"}};
  spec.curves = {{.label = "one", .sign = RunSign::square},
                 {.label = "two", .sign = RunSign::ring},
                 {.label = "three", .sign = RunSign::triangle}};
  spec.bands = {{.channel = 1, .names = {"a", "b"}, .laws = true},
                {.channel = 1, .names = {"", "off"}, .striped = true}};
  spec.thresholds = {{2, "limit"}};
  const PlotPicture high{0, 5, {}, {{0, 5}}, 600, 300}, low{1, 4, {}, {{0, 5}}, 600, 200};
  CallsInWords figure;
  draw_figure(std::array{FigurePart{spec, high}, FigurePart{spec, low}}, history, figure);
  CallsInWords first, second(300);
  draw_plot(spec, history, high, first);
  draw_plot(spec, history, low, second);
  std::vector<std::string> both = first.all;
  both.insert(both.end(), second.all.begin(), second.all.end());
  EXPECT_EQ(figure.all, both);
  for (const char* call : {"rect", "outline", "stripes", "line", "polygon", "square", "ring",
                           "text", "clip 56", "clip none"}) {
    EXPECT_TRUE(first.has(call)) << call;
  }
}

}  // namespace
}  // namespace limpid
