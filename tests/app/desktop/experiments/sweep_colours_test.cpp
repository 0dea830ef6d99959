// Colours of a sweep's map in the window: each cell has that of its value, and the scale says
// which.
#include <cmath>
#include <cstdlib>

#include "app/style/colour_scale.h"
#include "app/style/ticks.h"
#include "tests/app/desktop/shell/whole_window.h"
#include "tests/app/sweep/plans.h"
#include "tests/support/drawn_ink.h"

namespace limpid {
namespace {

using testing::HasSubstr;
using testing::Not;

// Two grips, three etas, and a limit by theory.
const std::string kColoured = R"(title = "Colours"
scene = "free.toml"
hand = { at = [0.19, 0, 0], jump = [1e-4, 0, 0] }
seconds = 0.02
measure = ["human_rms", "stable"]
axis = [
  { key = "hand.stiffness", values = [100, 1000], scale = "log" },
  { key = "coupling.eta", from = 0.4, to = 1, count = 3 },
]
[figure]
x = "stiffness"
theory = ["pr"]
)";

class ColoursOfASweep : public WholeWindow {
 protected:
  void open(const std::string& plan) {
    desktop->world.open_files({test::swept(test::sweep_plan(dir, plan), dir / "swept", 1000)});
    ASSERT_TRUE(until([&] { return drawn(); }));
    frames(3);
  }
  bool drawn() const {
    const SweepController& sweep = desktop->sweep;
    return sweep.map() != nullptr && sweep.map()->choice == sweep.choice() && sweep.on_screen;
  }
  const SweepMap& map() const { return *desktop->sweep.map(); }
  const ScreenRect& rect() const { return desktop->sweep.on_screen->rect; }
  static bool inked(ImVec2 at, ImU32 rgba) {
    return test::inked(at, [=](ImU32 ink) { return ink == rgba; });
  }
  // A place of a cell that no mark covers.
  ImVec2 beside(int x, int columns, int y, int rows) const {
    return {
        rect().min.x +
            rect().width() * (static_cast<float>(x) + 0.3f) / static_cast<float>(columns),
        rect().max.y - rect().height() * (static_cast<float>(y) + 0.3f) / static_cast<float>(rows)};
  }
  double value(int x, int y, std::size_t column) const {
    return desktop->sweep.sweep()->table.at(static_cast<std::uint64_t>(3 * x + y), column);
  }
};

TEST_F(ColoursOfASweep, AreThoseOfTheirValues) {
  open(kColoured);
  ASSERT_FALSE(map().log_values);
  const auto [low, high] = map().value_range;
  for (int x = 0; x < 2; ++x) {
    for (int y = 0; y < 3; ++y) {
      const double part = (value(x, y, 0) - low) / (high - low);
      EXPECT_GE(part, 0);
      EXPECT_LE(part, 1);
      EXPECT_TRUE(inked(beside(x, 2, y, 3), colour(scale_colour(part)))) << x << ", " << y;
    }
  }
}

TEST_F(ColoursOfASweep, AreExplainedByTheScale) {
  open(kColoured);
  const auto [low, high] = map().value_range;
  const double unit = std::pow(10, common_exponent(low, high));
  // A bar of 32 steps stands at the right of the map, as high as it.
  int bars = 0;
  for (float x = rect().max.x + 1; x < rect().max.x + 150; ++x) {
    bool all = true;
    for (int i = 0; i < 32 && all; ++i) {
      const float y = rect().max.y - rect().height() * (static_cast<float>(i) + 0.5f) / 32;
      all = inked({x + 0.5f, y}, colour(scale_colour((i + 0.5) / 32)));
    }
    bars += all;
  }
  EXPECT_NEAR(bars, 14, 1) << "px wide";
  int numbers = 0;
  for (const test::DrawnText& each : test::drawn_texts()) {
    char* end = nullptr;
    const double number = std::strtod(each.text.c_str(), &end);
    const bool beside = each.min.x > rect().max.x + 20 && each.window.starts_with("Sweep");
    if (end == each.text.c_str() || *end != '\0' || !beside) continue;
    ++numbers;
    const double part = (number * unit - low) / (high - low);
    EXPECT_NEAR(each.middle().y, rect().max.y - static_cast<float>(part) * rect().height(), 5)
        << each.text;
  }
  EXPECT_GE(numbers, 2);
  bool named = false;
  for (const test::DrawnText& each : test::drawn_texts()) {
    named = named || (each.text.starts_with("rms hand torque [mN m]") &&
                      each.max.y < rect().min.y && each.max.x > rect().max.x);
  }
  EXPECT_TRUE(named) << "above the scale";
}

TEST_F(ColoursOfASweep, OfAYesOrNoAreTwo) {
  open(kColoured);
  click("rms hand torque", "Sweep");
  click("comes to rest", "##Combo");
  ASSERT_TRUE(until([&] { return drawn() && map().yes_no; }));
  frames(3);
  const Palette& colours = current_palette();
  for (int x = 0; x < 2; ++x) {
    for (int y = 0; y < 3; ++y) {
      const Ink which = value(x, y, 1) == 1 ? Ink::proxy : Ink::contact;
      EXPECT_TRUE(inked(beside(x, 2, y, 3), colour(mix(ink(colours, which), colours.panel, 0.45f))))
          << x << ", " << y;
    }
  }
  EXPECT_THAT(words("Sweep"), HasSubstr("comes to rest: yes\n"));
  EXPECT_THAT(words("Sweep"), HasSubstr("\nno\n"));
}

// The line's pieces lie where their values are on both axes, and every other one is drawn, as it is
// dashed; grips are on a logarithmic axis.
TEST_F(ColoursOfASweep, HaveTheLineOfTheoryOverThem) {
  open(kColoured);
  ASSERT_EQ(map().lines.size(), 1u);
  ASSERT_EQ(map().lines[0].style, Series::Style::dashed);
  const double left = map().x_range.first, right = map().x_range.second;
  const double low = map().y_range.first, high = map().y_range.second;
  const auto place = [&](const FigurePoint& p) {
    const double across = std::log(p.x / left) / std::log(right / left);
    const double up = (p.y - low) / (high - low);
    return ImVec2{rect().min.x + static_cast<float>(across) * rect().width(),
                  rect().max.y - static_cast<float>(up) * rect().height()};
  };
  const std::vector<FigurePoint>& points = map().lines[0].points;
  ASSERT_EQ(points.size(), 81u);
  int gaps = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    ASSERT_TRUE(std::isfinite(points[i].y) && points[i].y > low && points[i].y < high);
    const ImVec2 from = place(points[i]), to = place(points[i + 1]);
    const ImVec2 middle{(from.x + to.x) / 2, (from.y + to.y) / 2};
    const bool drawn = inked(middle, colour(current_palette().text));
    if (i % 2 == 0) {
      EXPECT_TRUE(drawn) << i;
    } else {
      gaps += !drawn;
    }
  }
  EXPECT_GT(gaps, 35) << "of 40; words may lie over some";
}

TEST_F(ColoursOfASweep, SayHowManyDiverged) {
  open(kColoured);
  EXPECT_THAT(words("Sweep"), HasSubstr("6 of 6 points\n"));
  EXPECT_THAT(words("Sweep"), Not(HasSubstr("diverged")));
}

}  // namespace
}  // namespace limpid
