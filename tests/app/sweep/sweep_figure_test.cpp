#include "app/sweep/sweep_figure.h"

#include <gtest/gtest.h>

#include "tests/app/sweep/plans.h"

namespace limpid {
namespace {

const std::string kTwoByThree = R"(scene = "free.toml"
measure = ["energy"]
axis = [ { key = "hand.stiffness", values = [100, 1000], scale = "log" },
         { key = "coupling.eta", values = [0.4, 0.6, 1] } ]
)";

class SweepFigures : public testing::Test {
 protected:
  static SweepTable filled(const SweepPlan& plan, std::uint64_t count) {
    SweepTable table(plan);
    for (std::uint64_t i = 0; i < count; ++i) table.take(i, {static_cast<double>(i)});
    return table;
  }
  test::TempDir dir_;
};

TEST_F(SweepFigures, AreMapsWhoseCellsMeet) {
  const SweepPlan plan = test::sweep_plan(dir_, kTwoByThree);
  const Figure figure = sweep_figure(plan, filled(plan, 6));
  ASSERT_EQ(figure.panels.size(), 1u);
  const FigurePanel& panel = figure.panels[0];
  ASSERT_EQ(panel.series[0].cells.size(), 6u);
  const auto& cells = panel.series[0].cells;
  EXPECT_DOUBLE_EQ(cells[0].y_low, 0.3);
  EXPECT_DOUBLE_EQ(cells[0].y_high, cells[1].y_low);
  EXPECT_DOUBLE_EQ(cells[1].y_high, 0.8);
  EXPECT_DOUBLE_EQ(cells[2].y_high, 1.2);
  EXPECT_DOUBLE_EQ(cells[0].x_high, std::sqrt(100.0 * 1000));
  EXPECT_DOUBLE_EQ(cells[4].value, 4);
  EXPECT_EQ(panel.x_label, "stiffness [N/m]");
}

TEST_F(SweepFigures, HaveAPanelForEachCaseAndTwoColoursForYesAndNo) {
  std::string text = kTwoByThree;
  text.replace(text.find("\"energy\""), 8, "\"stable\"");
  text.replace(text.find("axis = ["), 8,
               "axis = [ { key = \"coupling.kind\", values = [\"standard\", \"predictive\"] },");
  const SweepPlan plan = test::sweep_plan(dir_, text);
  SweepTable table(plan);
  for (std::uint64_t i = 0; i < 12; ++i) table.take(i, {i % 3 == 0 ? 0.0 : 1.0});
  const Figure figure = sweep_figure(plan, table);
  ASSERT_EQ(figure.panels.size(), 2u);
  EXPECT_EQ(figure.panels[1].title, "kind predictive");
  EXPECT_EQ(figure.panels[0].series[0].cells.size(), 4u);
  EXPECT_EQ(figure.panels[0].series[1].cells.size(), 2u);
  EXPECT_EQ(figure.panels[0].series[1].label, "not stable");
}

TEST_F(SweepFigures, OfSampledAxesAreDotsOverTheFirst) {
  const SweepPlan plan = test::sweep_plan(dir_, R"(scene = "free.toml"
samples = 8
measure = ["energy"]
axis = [ { key = "hand.stiffness", from = 100, to = 1000, sample = "latin" },
         { key = "coupling.eta", from = 0.4, to = 1, sample = "latin" } ]
)");
  const Figure figure = sweep_figure(plan, filled(plan, 8));
  ASSERT_EQ(figure.panels.size(), 1u);
  ASSERT_EQ(figure.panels[0].series.size(), 1u);
  const Series& dots = figure.panels[0].series[0];
  EXPECT_EQ(dots.style, Series::Style::points);
  ASSERT_EQ(dots.points.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(dots.points[i].x, plan.axes[0].values[i]);
    EXPECT_EQ(dots.points[i].y, static_cast<double>(i));
  }
}

TEST_F(SweepFigures, OfWordsAreDotsOverThem) {
  const SweepPlan plan = test::sweep_plan(dir_, R"(scene = "free.toml"
measure = ["energy"]
axis = [ { key = "coupling.kind", values = ["standard", "predictive"] } ]
)");
  const FigurePanel panel = sweep_figure(plan, filled(plan, 2)).panels.at(0);
  EXPECT_EQ(panel.x_ticks.at(1), std::pair(1.0, std::string("predictive")));
  ASSERT_EQ(panel.series.size(), 1u);
  EXPECT_EQ(panel.series[0].points.at(1).x, 1);
}

TEST_F(SweepFigures, AreNothingWithoutAxesAndPartOfWhatIsDone) {
  const SweepPlan plan = test::sweep_plan(dir_, kTwoByThree);
  EXPECT_EQ(sweep_figure(plan, filled(plan, 2)).panels[0].series[0].cells.size(), 2u);
}

}  // namespace
}  // namespace limpid
