// Small charts of the panels: places, numbers at the axes, curves and words.
#include "app/desktop/widgets/chart.h"

#include <cmath>
#include <set>

#include "tests/app/desktop/widgets/read_panel.h"
#include "tests/support/drawn_ink.h"

namespace limpid {
namespace {

class AChart : public ReadPanel {
 protected:
  void draw(
      const ChartAxis& x, const ChartAxis& y,
      const std::function<void(const Chart&)>& inside = [](const Chart&) {}) {
    show([&, x, y, inside] {
      began_ = ImGui::GetCursorScreenPos().y;
      {
        const Chart chart("force [N] over time [s]", x, y, 120);
        inside_ = chart.inside();
        inside(chart);
      }
      ended_ = ImGui::GetCursorScreenPos().y;
    });
  }
  // Numbers below the chart, and left of it.
  std::set<std::string> below() const {
    std::set<std::string> all;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.min.y > inside_.max.y) all.insert(each.text);
    }
    return all;
  }
  std::set<std::string> left() const {
    std::set<std::string> all;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.max.x < inside_.min.x && each.min.y > inside_.min.y - 8) all.insert(each.text);
    }
    return all;
  }
  // Edges of thin lines fade: their colour counts, however faint.
  static constexpr ImU32 kRgb = IM_COL32(255, 255, 255, 0);
  static bool inked_near(ImVec2 at, ImU32 colour) {
    for (int i = 0; i < 49; ++i) {
      const ImVec2 there{at.x + 0.3f * static_cast<float>(i % 7 - 3),
                         at.y + 0.3f * static_cast<float>(i / 7 - 3)};
      if (test::inked(there, [&](ImU32 c) { return (c & kRgb) == (colour & kRgb); })) return true;
    }
    return false;
  }
  ScreenRect inside_;
  float began_ = 0, ended_ = 0;
};

constexpr ImU32 kRed = IM_COL32(255, 0, 0, 255);

TEST_F(AChart, PlacesItsEndsAtItsEdgesAndBack) {
  const ChartAxis linear{-2, 6}, logarithmic{1, 1000, true};
  draw(linear, logarithmic, [](const Chart& chart) {
    const ScreenRect& in = chart.inside();
    const ImVec2 low = chart.place({-2, 1}), high = chart.place({6, 1000}),
                 middle = chart.place({2, std::sqrt(1000.0)});
    EXPECT_NEAR(low.x, in.min.x, 0.01);
    EXPECT_NEAR(low.y, in.max.y, 0.01) << "y goes upwards";
    EXPECT_NEAR(high.x, in.max.x, 0.01);
    EXPECT_NEAR(high.y, in.min.y, 0.01);
    EXPECT_NEAR(middle.x, (in.min.x + in.max.x) / 2, 0.01);
    EXPECT_NEAR(middle.y, (in.min.y + in.max.y) / 2, 0.01) << "of equal ratios";
    for (const ChartPoint p : {ChartPoint{0, 3}, {5, 400}}) {
      const ChartPoint back = chart.at(chart.place(p));
      EXPECT_NEAR(back.x, p.x, 1e-3);
      EXPECT_NEAR(back.y / p.y, 1, 1e-3);
    }
    EXPECT_TRUE(std::isfinite(chart.place({1e30, 0}).x)) << "far beyond it";
    EXPECT_TRUE(std::isfinite(chart.place({0, 0}).y)) << "zero has no logarithm";
    EXPECT_GT(chart.place({0, 0}).y, in.max.y);
  });
}

TEST_F(AChart, IsAsHighAsItIsAskedForWithItsTitleAbove) {
  draw({0, 10}, {0, 4});
  EXPECT_NEAR(ended_ - began_, 120 * current_scale() + ImGui::GetStyle().ItemSpacing.y, 1);
  const auto title = find("force [N] over time [s]");
  ASSERT_TRUE(title);
  EXPECT_LE(title->max.y, inside_.min.y);
  EXPECT_GE(inside_.min.x, title->min.x);
  EXPECT_LT(inside_.max.y, ended_);
}

TEST_F(AChart, HasRoundNumbersAtItsAxes) {
  draw({0, 10}, {0, 4});
  EXPECT_THAT(below(), testing::IsSupersetOf({"0", "2", "4", "10"}));
  EXPECT_THAT(left(), testing::IsSupersetOf({"0", "2", "4"}));
  for (const std::string& number : below()) {
    const auto text = find(number);
    EXPECT_GE(text->min.x, 0);
    EXPECT_LE(text->max.x, kWidth) << "none is cut off";
  }
}

TEST_F(AChart, HasOneTwoAndFiveOfEachDecadeOrTheDecadesAlone) {
  draw({1, 100, true}, {10, 1e6, true});
  EXPECT_THAT(below(), testing::UnorderedElementsAre("1", "2", "5", "10", "20", "50", "100"));
  EXPECT_THAT(left(), testing::UnorderedElementsAre("10", "100", "1k", "10k", "100k", "1000k"));
}

TEST_F(AChart, HasWordsInPlaceOfNumbersOrNeither) {
  draw({0, 2, false, true, {{0.5, "one"}, {1.5, "other"}}}, {0, 4, false, false});
  EXPECT_THAT(below(), testing::UnorderedElementsAre("one", "other"));
  EXPECT_TRUE(left().empty());
  const auto one = find("one");
  EXPECT_NEAR(one->middle().x, inside_.min.x + inside_.width() / 4, 2);
  draw({0, 2, false, false}, {0, 4, false, true, {{2, "a word that is rather long"}}});
  EXPECT_TRUE(below().empty());
  EXPECT_THAT(left(), testing::ElementsAre("a word that is rather long")) << "it has the room";
}

TEST_F(AChart, DrawsLinesAndDashesWithinItsFrame) {
  ImVec2 on_line, on_dash, in_gap, outside;
  draw({0, 10}, {0, 4}, [&](const Chart& chart) {
    chart.line({{0, 1}, {10, 1}}, kRed);
    chart.dashes({{0, 3}, {2, 3}, {4, 3}, {6, 3}, {8, 3}, {10, 3}}, kRed);
    chart.line({{-5, 2}, {-1, 2}}, kRed);
    on_line = chart.place({5, 1});
    on_dash = chart.place({5, 3});
    in_gap = chart.place({3, 3});
    outside = chart.place({-1, 2});
  });
  EXPECT_TRUE(inked_near(on_line, kRed));
  EXPECT_TRUE(inked_near(on_dash, kRed));
  EXPECT_FALSE(inked_near(in_gap, kRed));
  EXPECT_LT(outside.x, inside_.min.x);
  bool clipped = false;
  for (const ImDrawCmd& command : ImGui::FindWindowByName("panel")->DrawList->CmdBuffer) {
    clipped |= command.ClipRect.x >= inside_.min.x - 1 && command.ClipRect.z <= inside_.max.x + 1;
  }
  EXPECT_TRUE(clipped);
}

TEST_F(AChart, KeepsItsWordsInsideOfTheFrame) {
  const auto word_at = [&](ImVec2 offset, bool right) {
    draw({0, 10}, {0, 4}, [&](const Chart& chart) {
      const ScreenRect& in = chart.inside();
      chart.text({in.min.x + offset.x, in.min.y + offset.y}, "here", kRed, right);
    });
    return *find("here");
  };
  const test::DrawnText from = word_at({80, 40}, false), to = word_at({80, 40}, true);
  EXPECT_NEAR(from.min.x, inside_.min.x + 80, 2);
  EXPECT_NEAR(to.max.x, inside_.min.x + 80, 2);
  EXPECT_EQ(from.colour, kRed);
  for (const ImVec2 far : {ImVec2{-50, -50}, {5000, 5000}, {-50, 5000}}) {
    const test::DrawnText text = word_at(far, false);
    EXPECT_GE(text.min.x, inside_.min.x);
    EXPECT_LE(text.max.x, inside_.max.x);
    EXPECT_GE(text.min.y, inside_.min.y);
    EXPECT_LE(text.max.y, inside_.max.y);
  }
}

TEST_F(AChart, HasAnAxisAtZero) {
  draw({-1, 1}, {-1, 1, false, false});
  const ImVec2 zero{inside_.min.x + 0.3f * inside_.width(), (inside_.min.y + inside_.max.y) / 2};
  EXPECT_TRUE(inked_near(zero, colour(current_palette().axis)));
  EXPECT_FALSE(inked_near({zero.x, zero.y + 15}, colour(current_palette().axis)));
}

}  // namespace
}  // namespace limpid
