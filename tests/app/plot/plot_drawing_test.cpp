// A plot's picture on a canvas that notes what is drawn: each part at its place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "app/plot/plot_export.h"
#include "app/style/ticks.h"

namespace limpid {
namespace {

class Notes : public PlotCanvas {
 public:
  struct Lined {
    Point from, to;
    Rgb rgb;
    double width, dash, gap;
    bool clipped;
  };
  struct Text {
    Point at;
    Anchor anchor;
    Rgb rgb;
    std::string what;
    bool bold;
  };
  struct Filled {
    Box box;
    Rgb rgb;
    double alpha;
  };
  struct Path {
    std::vector<Point> points;
    Rgb rgb;
    double width;
  };
  struct Sign {
    Point at;
    double size;
    Rgb rgb;
  };

  void rect(const Box& box, Rgb fill, double alpha) override {
    filled.push_back({box, fill, alpha});
  }
  void outline(const Box& box, Rgb rgb) override { outlined.push_back({box, rgb, 1}); }
  void stripes(const Box& box, Rgb rgb) override { striped.push_back({box, rgb, 1}); }
  void line(Point from, Point to, Rgb rgb, double width, double dash, double gap) override {
    lines.push_back({from, to, rgb, width, dash, gap, clipped});
  }
  void polyline(std::span<const Point> points, Rgb rgb, double width) override {
    paths.push_back({{points.begin(), points.end()}, rgb, width});
  }
  void polygon(std::span<const Point> points, Rgb rgb, double width) override {
    areas.push_back({{points.begin(), points.end()}, rgb, width});
  }
  void square(Point middle, double half, Rgb fill, Rgb) override {
    squares.push_back({middle, half, fill});
  }
  void ring(Point middle, double radius, Rgb edge, Rgb) override {
    rings.push_back({middle, radius, edge});
  }
  void text(Point at, Anchor anchor, Rgb rgb, const std::string& what, bool bold) override {
    texts.push_back({at, anchor, rgb, what, bold});
  }
  void clip(const Box* box) override {
    clipped = box != nullptr;
    if (box != nullptr) clips.push_back({*box, {}, 1});
  }

  std::vector<Lined> lines;
  std::vector<Text> texts;
  std::vector<Filled> filled, outlined, striped, clips;
  std::vector<Path> paths, areas;
  std::vector<Sign> squares, rings;
  bool clipped = false;

  const Text& said(const std::string& what) const {
    static const Text kNone{};
    const auto found = std::ranges::find(texts, what, &Text::what);
    EXPECT_NE(found, texts.end()) << what;
    return found == texts.end() ? kNone : *found;
  }
  bool says(const std::string& what) const {
    return std::ranges::find(texts, what, &Text::what) != texts.end();
  }
};

bool same(Rgb a, Rgb b) { return a.r == b.r && a.g == b.g && a.b == b.b; }

// Ten seconds of a picture of 720 by 360: curves are between 56 and 706 across, 32 and 318 down.
class ADrawing : public testing::Test {
 protected:
  ADrawing() {
    spec_.title = "Force";
    spec_.y = {.unit = "N"};
    spec_.curves = {{.label = "one", .ink = Ink::hand}};
    for (int k = 0; k <= 10000; ++k) {
      const double t = 1e-3 * k;
      history_.append(t, std::array{t, t >= 4 && t < 8 ? 1.0 : 0.0, t >= 2 ? 2.0 : 0.0});
    }
  }
  Notes draw() {
    Notes notes;
    draw_plot(spec_, history_, picture_, notes);
    return notes;
  }
  double x_of(double t) const {
    return 56 + (t - picture_.start) / (picture_.stop - picture_.start) * 650;
  }
  double y_of(double value) const { return 318 - picture_.y.part(value) * 286; }

  PlotSpec spec_;
  History history_{{.channels = 3}};
  PlotPicture picture_{0, 10, {}, {{0, 10}}};
  const Palette& palette_ = palette(Theme::light);
};

TEST_F(ADrawing, HasItsFrameTitleAndUnit) {
  const Notes notes = draw();
  ASSERT_EQ(notes.outlined.size(), 1u);
  const PlotCanvas::Box& frame = notes.outlined[0].box;
  EXPECT_EQ(frame.left, 56);
  EXPECT_EQ(frame.top, 32);
  EXPECT_EQ(frame.width, 650);
  EXPECT_EQ(frame.height, 286);
  ASSERT_EQ(notes.clips.size(), 1u);
  EXPECT_EQ(notes.clips[0].box.width, 650);
  EXPECT_FALSE(notes.clipped) << "the clip ends";
  const auto& title = notes.said("Force  [N]");
  EXPECT_TRUE(title.bold);
  EXPECT_EQ(title.at.x, 56);
  EXPECT_EQ(title.anchor, PlotCanvas::Anchor::start);
  for (const auto& each : notes.texts) {
    if (each.what != title.what) {
      EXPECT_FALSE(each.bold) << each.what;
    }
  }
}

TEST_F(ADrawing, HasNumbersBesideTheirLines) {
  const Notes notes = draw();
  int across = 0, up = 0;
  for (const auto& each : notes.texts) {
    char* end = nullptr;
    const double number = std::strtod(each.what.c_str(), &end);
    if (end == each.what.c_str()) continue;
    const auto on = [&](const Notes::Lined& line) {
      return across >= 0 && line.from.x == line.to.x && std::abs(line.from.x - each.at.x) < 1e-6;
    };
    if (each.anchor == PlotCanvas::Anchor::middle) {
      ++across;
      EXPECT_NEAR(each.at.x, x_of(number), 1e-6) << each.what;
      EXPECT_EQ(each.at.y, 318 + 16);
      EXPECT_TRUE(std::ranges::any_of(notes.lines, on)) << each.what;
    } else if (each.anchor == PlotCanvas::Anchor::end) {
      ++up;
      EXPECT_NEAR(each.at.y - 4, y_of(number), 1e-6) << each.what;
      EXPECT_EQ(each.at.x, 56 - 6);
    }
  }
  EXPECT_GE(across, 5);
  EXPECT_LE(across, 9) << "90 px for each";
  EXPECT_GE(up, 4);
  EXPECT_LE(up, 9) << "45 px for each";
  for (const auto& line : notes.lines) {
    if (!same(line.rgb, palette_.grid)) continue;
    const bool upright = line.from.x == line.to.x;
    EXPECT_EQ(upright ? line.from.y : line.from.x, upright ? 32 : 56);
    EXPECT_EQ(upright ? line.to.y : line.to.x, upright ? 318 : 706);
    EXPECT_EQ(line.width, 1);
    EXPECT_EQ(line.dash, 0);
  }
}

// From a minute on times have minutes and seconds.
TEST_F(ADrawing, WritesMinutesWhereThereAreSome) {
  for (int k = 10001; k <= 61000; ++k) history_.append(1e-3 * k, std::array{0.0, 0.0, 0.0});
  picture_.start = 20;
  picture_.stop = 59.9;
  EXPECT_FALSE(std::ranges::any_of(
      draw().texts, [](const auto& each) { return each.what.find(':') != std::string::npos; }));
  picture_.stop = 60;
  const Notes notes = draw();
  EXPECT_TRUE(notes.says("0:30") || notes.says("0:40")) << notes.texts[1].what;
}

TEST_F(ADrawing, EmphasizesZeroUnlessItIsALogarithm) {
  picture_.y.limits = {-5, 10};
  const auto zero = [&] {
    return std::ranges::count_if(draw().lines, [&](const Notes::Lined& line) {
      return same(line.rgb, palette_.axis) && std::abs(line.from.y - y_of(0)) < 1e-6 &&
             line.to.y == line.from.y && line.from.x == 56 && line.to.x == 706;
    });
  };
  EXPECT_EQ(zero(), 1);
  spec_.y.zero_line = false;
  EXPECT_EQ(zero(), 0);
  spec_.y.zero_line = true;
  picture_.y.log = true;
  picture_.y.limits = {-1, 1};
  EXPECT_TRUE(std::ranges::none_of(
      draw().lines, [&](const Notes::Lined& line) { return same(line.rgb, palette_.axis); }));
}

TEST_F(ADrawing, HasTheCurveAtItsValues) {
  picture_.start = 2;
  picture_.stop = 2.2;  // samples are far apart
  picture_.y.limits = {1, 3};
  const Notes notes = draw();
  ASSERT_FALSE(notes.paths.empty());
  EXPECT_GT(notes.paths[0].points.size(), 150u);
  for (const PlotCanvas::Point& p : notes.paths[0].points) {
    const double t = picture_.start + (p.x - 56) / 650 * (picture_.stop - picture_.start);
    EXPECT_NEAR(p.y, y_of(t), 0.6) << t;
  }
  EXPECT_TRUE(same(notes.paths[0].rgb, ink(palette_, Ink::hand)));
  EXPECT_EQ(notes.paths[0].width, 2);
  EXPECT_LE(notes.paths[0].points.front().x, 57);
  EXPECT_GE(notes.paths[0].points.back().x, 704);
}

TEST_F(ADrawing, ListsItsVisibleCurvesBelow) {
  spec_.curves = {{.label = "one", .ink = Ink::hand},
                  {.channel = 1, .label = "hidden", .visible = false},
                  {.channel = 2, .label = "another", .ink = Ink::contact, .sign = RunSign::square}};
  const Notes notes = draw();
  EXPECT_FALSE(notes.says("hidden"));
  double next = 56;
  for (const auto& [label, which] : {std::pair("one", Ink::hand), {"another", Ink::contact}}) {
    const auto& text = notes.said(label);
    EXPECT_EQ(text.at.y, 360 - 10);
    EXPECT_EQ(text.at.x, next + 23);
    EXPECT_EQ(text.anchor, PlotCanvas::Anchor::start);
    const auto sample = std::ranges::find_if(notes.lines, [&](const Notes::Lined& line) {
      return line.from.y == 360 - 14 && line.from.x == next;
    });
    ASSERT_NE(sample, notes.lines.end()) << label;
    EXPECT_EQ(sample->to.x, next + 18);
    EXPECT_EQ(sample->to.y, sample->from.y);
    EXPECT_TRUE(same(sample->rgb, ink(palette_, which)));
    next += 40 + 0.6 * 12 * static_cast<double>(std::string(label).size());
  }
  ASSERT_FALSE(notes.squares.empty());
  EXPECT_EQ(notes.squares.back().at.y, 360 - 14) << "the sign stands on the sample, too";
  EXPECT_NEAR(notes.squares.back().at.x, notes.said("another").at.x - 23 + 9, 1e-9);
}

// Signs stand on the curve, 64 px apart.
TEST_F(ADrawing, HasSignsAtEvenDistances) {
  spec_.curves[0].sign = RunSign::square;
  const Notes notes = draw();
  ASSERT_EQ(notes.squares.size(), 11u) << "650 / 64, and the legend's";
  for (std::size_t i = 0; i + 1 < notes.squares.size(); ++i) {
    const auto& sign = notes.squares[i];
    EXPECT_NEAR(sign.at.x, 56 + 32 + 64 * static_cast<double>(i), 1);
    EXPECT_NEAR(sign.at.y, 318 - (sign.at.x - 56) / 650 * 286, 1);
    EXPECT_EQ(sign.size, 3.6);
    EXPECT_TRUE(same(sign.rgb, ink(palette_, Ink::hand)));
  }
  spec_.curves[0].sign = RunSign::ring;
  EXPECT_EQ(draw().rings.size(), 11u);
  EXPECT_TRUE(draw().squares.empty());
  spec_.curves[0].sign = RunSign::triangle;
  const Notes triangles = draw();
  const auto of_three = std::ranges::count_if(
      triangles.areas, [](const Notes::Path& area) { return area.points.size() == 3; });
  EXPECT_EQ(of_three, 22) << "each with a rim of the paper's colour";
  for (const Notes::Path& area : triangles.areas) {
    if (area.points.size() != 3) continue;
    const double middle = area.points[0].x;
    EXPECT_NEAR(area.points[1].x - middle, middle - area.points[2].x, 1e-9);
    EXPECT_LT(area.points[0].y, area.points[1].y) << "it points up";
    EXPECT_EQ(area.points[1].y, area.points[2].y);
  }
}

TEST_F(ADrawing, HasThresholdsAtTheirValues) {
  spec_.thresholds = {{7.5, "limit", Ink::energy}};
  const Notes notes = draw();
  const auto line = std::ranges::find_if(notes.lines, [&](const Notes::Lined& each) {
    return same(each.rgb, ink(palette_, Ink::energy));
  });
  ASSERT_NE(line, notes.lines.end());
  EXPECT_NEAR(line->from.y, y_of(7.5), 1e-9);
  EXPECT_EQ(line->to.y, line->from.y);
  EXPECT_EQ(line->from.x, 56);
  EXPECT_EQ(line->to.x, 706);
  EXPECT_EQ(line->dash, 4);
  EXPECT_EQ(line->gap, 3);
  EXPECT_TRUE(line->clipped);
  const auto& label = notes.said("limit");
  EXPECT_EQ(label.anchor, PlotCanvas::Anchor::end);
  EXPECT_EQ(label.at.x, 700);
  EXPECT_NEAR(label.at.y, y_of(7.5) - 4, 1e-9) << "above its line";
}

TEST_F(ADrawing, HasMarksWithinItsStretch) {
  history_.mark(1, "early", kNoteMark);
  history_.mark(3, "eta = 2", "eta");
  history_.mark(3.1, "above it", "k_vc");
  for (const char* key : {"third", "fourth"}) history_.mark(3.15, key, key);
  history_.mark(3.2, "no room", "alpha");
  history_.mark(9, "late", kNoteMark);
  picture_.start = 2;
  picture_.stop = 8;
  const Notes notes = draw();
  EXPECT_FALSE(notes.says("early"));
  EXPECT_FALSE(notes.says("late"));
  EXPECT_FALSE(notes.says("no room"));
  const auto& label = notes.said("eta = 2");
  EXPECT_NEAR(label.at.x, x_of(3) + 4, 1e-9);
  EXPECT_EQ(label.at.y, 318 - 5);
  EXPECT_EQ(notes.said("above it").at.y, label.at.y - 14) << "in the next row";
  EXPECT_TRUE(same(label.rgb, palette_.muted));
  const auto lines_at = [&](const Notes& of, double t) {
    std::vector<Notes::Lined> found;
    for (const auto& line : of.lines) {
      if (line.clipped && std::abs(line.from.x - x_of(t)) < 1e-6 && line.to.x == line.from.x) {
        found.push_back(line);
      }
    }
    return found;
  };
  ASSERT_EQ(lines_at(notes, 3).size(), 1u);
  EXPECT_EQ(lines_at(notes, 3)[0].dash, 2);
  EXPECT_EQ(lines_at(notes, 3.2).size(), 1u) << "a mark without a label has its line";
  picture_.start = 0;
  picture_.stop = 10;
  const Notes whole = draw();
  ASSERT_EQ(lines_at(whole, 1).size(), 1u);
  EXPECT_EQ(lines_at(whole, 1)[0].dash, 0) << "a note's line is whole";
  EXPECT_TRUE(same(whole.said("early").rgb, palette_.text));
}

TEST_F(ADrawing, TintsBandsByTheirValue) {
  spec_.bands = {{.channel = 1, .names = {"", "contact"}},
                 {.channel = 2, .names = {"", "half", "whole"}}};
  const Notes notes = draw();
  const auto at = [&](double from) {
    const auto found = std::ranges::find_if(notes.filled, [&](const Notes::Filled& each) {
      return std::abs(each.box.left - x_of(from)) < 1;
    });
    EXPECT_NE(found, notes.filled.end()) << from;
    return found == notes.filled.end() ? Notes::Filled{} : *found;
  };
  EXPECT_EQ(notes.filled.size(), 2u);
  EXPECT_NEAR(at(4).box.width, x_of(8) - x_of(4), 1.5);
  EXPECT_EQ(at(4).box.top, 32);
  EXPECT_EQ(at(4).box.height, 286);
  EXPECT_NEAR(at(4).alpha, 0.13, 1e-6);
  EXPECT_NEAR(at(2).alpha, 0.13, 1e-6) << "the last value";
  EXPECT_TRUE(same(at(2).rgb, palette_.accent));
  EXPECT_NEAR(notes.said("contact").at.x, x_of(4) + 3, 1.5);
  EXPECT_EQ(notes.said("contact").at.y, 32 + 15);
  EXPECT_EQ(notes.said("whole").at.y, 32 + 29) << "each band has a line";
  spec_.bands[1].names.emplace_back("more");
  const Notes three = draw();
  EXPECT_TRUE(std::ranges::any_of(three.filled, [&](const Notes::Filled& each) {
    return std::abs(each.alpha - 0.13 * 2 / 3) < 1e-6;
  })) << "two of three";
}

TEST_F(ADrawing, HasAnEdgeOfEachLaw) {
  spec_.bands = {{.channel = 2, .names = {"standard", "proposed", "predictive"}, .laws = true}};
  const Notes one = draw();
  // Each stretch: a tint over all, and an edge of 3 px at the top.
  ASSERT_EQ(one.filled.size(), 4u);
  EXPECT_TRUE(same(one.filled[0].rgb, law_ink(palette_, 0)));
  EXPECT_EQ(one.filled[0].box.height, 286);
  EXPECT_EQ(one.filled[1].box.height, 3);
  EXPECT_EQ(one.filled[1].box.top, 32);
  EXPECT_EQ(one.filled[1].alpha, 1);
  EXPECT_TRUE(same(one.filled[3].rgb, law_ink(palette_, 2)));
  EXPECT_TRUE(one.says("standard") && one.says("predictive"));
  spec_.bands[0].lane = 1;
  const Notes second = draw();
  ASSERT_EQ(second.filled.size(), 2u) << "a lane has its edge alone";
  EXPECT_EQ(second.filled[0].box.top, 32 + 4);
  picture_.start = 1.99;
  picture_.stop = 10;
  EXPECT_FALSE(draw().says("standard")) << "a short time has no name";
}

// Names of laws keep clear of one another and of the edges, and each law with room has one.
TEST_F(ADrawing, NamesALawWhereTheNameBeforeEnds) {
  History laws({.channels = 2});
  for (int k = 0; k <= 10000; ++k) {
    const double t = 1e-3 * k;
    laws.append(t, std::array{t, t < 1 ? 0.0 : 1.0});
  }
  spec_.bands = {{.channel = 1, .names = {"standard law", "proposed"}, .laws = true}};
  Notes notes;
  picture_.start = -0.3;  // the first one lasts 1 s of 10.3: 63 px for 12 letters of 6.6
  picture_.stop = 10;
  draw_plot(spec_, laws, picture_, notes);
  EXPECT_FALSE(notes.says("standard law"));
  EXPECT_NEAR(notes.said("proposed").at.x, x_of(1) + 3, 1.5);
  picture_.stop = 7.3;  // now it has 85 px, and the gap behind its name reaches beyond
  Notes close;
  draw_plot(spec_, laws, picture_, close);
  EXPECT_NEAR(close.said("standard law").at.x, x_of(0) + 3, 1.5);
  EXPECT_NEAR(close.said("proposed").at.x, x_of(0) + 3 + 12 * 6.6 + 8 + 3, 1.5);
}

TEST_F(ADrawing, NamesALawThatHadNoRoomAtFirst) {
  History laws({.channels = 2});
  for (int k = 0; k <= 10000; ++k) {
    const double t = 1e-3 * k;
    if (t >= 4.2 && t < 5) continue;  // the predictive law is interrupted just after it began
    laws.append(t, std::array{t, t < 4 ? 0.0 : 1.0});
  }
  spec_.bands = {{.channel = 1, .names = {"standard", "predictive"}, .laws = true}};
  Notes notes;
  draw_plot(spec_, laws, picture_, notes);
  EXPECT_NEAR(notes.said("predictive").at.x, x_of(5) + 3, 1.5);
}

TEST_F(ADrawing, NamesLawsBelowAllEdges) {
  spec_.bands = {{.channel = 2, .names = {"standard", "", "predictive"}, .laws = true},
                 {.channel = 1, .names = {"standard", "proposed"}, .laws = true, .lane = 1}};
  const Notes notes = draw();
  double lowest = 0;
  for (const auto& each : notes.filled) {
    if (each.box.height == 3) lowest = std::max(lowest, each.box.top + 3);
  }
  EXPECT_EQ(lowest, 32 + 7);
  for (const char* name : {"predictive", "proposed"}) {
    EXPECT_GE(notes.said(name).at.y - 9, lowest) << name;
  }
}

// Names stand on a line of their own below the edges of all lanes, 4 px for each further one.
TEST_F(ADrawing, HasNamesOnTheirLines) {
  spec_.bands = {{.channel = 2, .names = {"standard", "", "predictive"}, .laws = true}};
  EXPECT_EQ(draw().said("standard").at.y, 32 + 15);
  spec_.bands.push_back({.channel = 1, .names = {"left", "right"}, .laws = true, .lane = 1});
  spec_.bands.push_back({.channel = 1, .names = {"", "off"}, .striped = true});
  const Notes notes = draw();
  EXPECT_EQ(notes.said("standard").at.y, 32 + 15 + 4);
  EXPECT_EQ(notes.said("predictive").at.y, 32 + 15 + 4);
  EXPECT_EQ(notes.said("left").at.y, 32 + 15 + 4 + 14);
  EXPECT_EQ(notes.said("off").at.y, 32 + 15 + 4 + 28);
  EXPECT_NEAR(notes.said("standard").at.x, 56 + 3, 1);
  EXPECT_NEAR(notes.said("predictive").at.x, x_of(2) + 3, 1);
  EXPECT_NEAR(notes.said("right").at.x, x_of(4) + 3, 1);
  ASSERT_EQ(notes.striped.size(), 1u);
  EXPECT_NEAR(notes.striped[0].box.left, x_of(4), 1);
  EXPECT_NEAR(notes.striped[0].box.width, x_of(8) - x_of(4), 1);
  EXPECT_EQ(notes.striped[0].box.height, 286);
}

// A mark at the right end has its label left of it; thresholds take turns around their line.
TEST_F(ADrawing, HasLabelsWhereThereIsRoom) {
  history_.mark(9.95, "a long label", "key");
  spec_.thresholds = {{7.5, "one"}, {7.5, "two"}, {7.5, "six"}};
  const Notes notes = draw();
  const auto& mark = notes.said("a long label");
  EXPECT_EQ(mark.anchor, PlotCanvas::Anchor::end);
  EXPECT_NEAR(mark.at.x, x_of(9.95) - 4, 1e-6);
  EXPECT_EQ(mark.at.y, 318 - 5);
  const double y = y_of(7.5);
  for (const auto& [text, at, anchor] :
       {std::tuple("one", PlotCanvas::Point{700, y - 4}, PlotCanvas::Anchor::end),
        {"two", PlotCanvas::Point{700, y + 12}, PlotCanvas::Anchor::end},
        {"six", PlotCanvas::Point{62, y - 4}, PlotCanvas::Anchor::start}}) {
    EXPECT_NEAR(notes.said(text).at.x, at.x, 1e-6) << text;
    EXPECT_NEAR(notes.said(text).at.y, at.y, 1e-6) << text;
    EXPECT_EQ(notes.said(text).anchor, anchor) << text;
  }
}

// Entries of 40 letters of 7.2 px: two in a row, and the area is as much lower.
TEST_F(ADrawing, HasRowsOfItsLegend) {
  std::vector<std::string> labels;
  spec_.curves.clear();
  for (const char letter : {'a', 'b', 'c'}) {
    labels.emplace_back(40, letter);
    spec_.curves.push_back({.label = labels.back()});
  }
  const Notes notes = draw();
  EXPECT_EQ(notes.outlined.at(0).box.height, 286 - 14);
  EXPECT_NEAR(notes.said(labels[0]).at.x, 56 + 23, 1e-6);
  EXPECT_NEAR(notes.said(labels[1]).at.x, 56 + 23 + 40 * 7.2 + 17 + 23, 1e-6);
  EXPECT_NEAR(notes.said(labels[2]).at.x, 56 + 23, 1e-6);
  EXPECT_EQ(notes.said(labels[0]).at.y, 350 - 14);
  EXPECT_EQ(notes.said(labels[1]).at.y, 350 - 14);
  EXPECT_EQ(notes.said(labels[2]).at.y, 350);
}

TEST_F(ADrawing, OverAnotherChannelNamesBoth) {
  spec_.kind = PlotKind::cross;
  spec_.x = {.label = "way", .unit = "mm", .factor = 1e3};
  spec_.curves[0].across = 2;
  picture_.x.limits = {-1, 3};
  const Notes notes = draw();
  const auto& name = notes.said("way  [mm]");
  EXPECT_EQ(name.at.x, 706);
  EXPECT_EQ(name.at.y, 350);
  EXPECT_EQ(name.anchor, PlotCanvas::Anchor::end);
  for (const auto& each : notes.texts) {
    if (each.anchor != PlotCanvas::Anchor::middle) continue;
    const double number = std::strtod(each.what.c_str(), nullptr);
    if (each.what.starts_with("\u2212")) continue;
    EXPECT_NEAR(each.at.x, 56 + 650 * (number / 1e3 + 1) / 4, 1e-6) << each.what;
  }
  ASSERT_FALSE(notes.paths.empty());
  EXPECT_NEAR(notes.paths[0].points.front().x, 56 + 650.0 / 4, 1.5) << "at 0 across";
}

TEST_F(ADrawing, OnADarkPaperHasTheDarkColours) {
  picture_.theme = Theme::dark;
  const Notes notes = draw();
  EXPECT_TRUE(same(notes.said("one").rgb, palette(Theme::dark).text));
  EXPECT_TRUE(same(paper_of(picture_), palette(Theme::dark).panel));
  picture_.theme = Theme::light;
  EXPECT_TRUE(same(paper_of(picture_), Rgb{255, 255, 255}));
}

TEST(PlotSvgSize, IsInMillimetresWhereItIsPrinted) {
  History history({.channels = 1});
  PlotSpec spec{.title = "t", .curves = {{.label = "a"}}};
  PlotPicture picture{0, 1, {}, {{0, 1}}, 600, 300};
  EXPECT_NE(plot_svg(spec, history, picture).find("width=\"600\" height=\"300\""),
            std::string::npos);
  picture.millimetres = 90;
  const std::string svg = plot_svg(spec, history, picture);
  EXPECT_NE(svg.find("width=\"90mm\" height=\"45mm\""), std::string::npos) << svg.substr(0, 200);
  EXPECT_NE(svg.find("viewBox=\"0 0 600 300\""), std::string::npos);
}

TEST(WordOnTimes, SaysWhatNegativeOnesAre) {
  EXPECT_EQ(word_on_times({}), "");
  PlotTable table;
  table.times = {0, 1};
  EXPECT_EQ(word_on_times(table), "");
  table.times = {-0.5, 1};
  EXPECT_EQ(word_on_times(table), " (negative times: before the last t = 0)");
}

}  // namespace
}  // namespace limpid
