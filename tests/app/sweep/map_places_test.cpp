// Maps and figures of sampled axes, of words, and of many panels: what stands where.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "app/sweep/sweep_figure.h"
#include "app/sweep/sweep_map.h"
#include "app/sweep/sweep_table.h"
#include "tests/app/sweep/plans.h"

namespace limpid {
namespace {

using testing::ElementsAre;

class PlacesOfMaps : public testing::Test {
 protected:
  SweepPlan plan(const std::string& more) {
    return test::sweep_plan(dir_,
                            "title = \"Places\"\nscene = \"free.toml\"\nseconds = 0.02\n" + more);
  }
  // A table of one measure whose values are the points' numbers, but for those not done.
  static OpenedSweep numbered(const SweepPlan& plan, std::uint64_t missing = ~std::uint64_t{0}) {
    OpenedSweep made{"", std::make_shared<SweepPlan>(plan), SweepTable(plan), "", "", {}};
    for (std::uint64_t i = 0; i < plan.points(); ++i) {
      if (i != missing) made.table.take(i, {static_cast<double>(i)});
    }
    made.ranges.assign(made.table.columns.size(), {0, static_cast<double>(plan.points() - 1)});
    return made;
  }
  static MapChoice choice(std::size_t x, std::optional<std::size_t> y, std::size_t axes) {
    return {.column = 0, .x = x, .y = y, .place = std::vector<std::size_t>(axes, 0)};
  }
  const test::TempDir dir_;
};

const std::string kSampled = R"(samples = 4
measure = ["energy"]
axis = [ { key = "hand.stiffness", from = 100, to = 1000, sample = "latin" },
         { key = "coupling.eta", from = 0.4, to = 1, sample = "latin" },
         { key = "hand.damping", values = [1, 3] } ]
)";

TEST_F(PlacesOfMaps, AreDotsAtTheSamplesOfTwoAxes) {
  const SweepPlan sampled = plan(kSampled);
  MapChoice second = choice(0, 1, 3);
  second.place[2] = 1;  // damping 3
  const SweepMap map = make_map(numbered(sampled, 6), second);
  EXPECT_EQ(map.kind, SweepMap::Kind::dots);
  ASSERT_EQ(map.spots.size(), 4u);
  for (std::size_t s = 0; s < 4; ++s) {
    const MapSpot& spot = map.spots[s];
    EXPECT_EQ(spot.point, 4 + s) << "samples are numbered faster than a grid";
    EXPECT_EQ(spot.x, sampled.axes[0].values[s]);
    EXPECT_EQ(spot.y, sampled.axes[1].values[s]);
    EXPECT_EQ(spot.cell.x_low, spot.x) << "a dot has no width";
    EXPECT_EQ(spot.cell.y_high, spot.y);
    EXPECT_EQ(spot.there(), s != 2);
    if (s != 2) {
      EXPECT_EQ(spot.cell.value, static_cast<double>(4 + s));
    }
  }
  EXPECT_TRUE(std::isnan(map.spots[2].cell.value));
}

TEST_F(PlacesOfMaps, AreDotsInRowsWhereOneAxisIsAGrid) {
  const SweepPlan sampled = plan(kSampled);
  const SweepMap map = make_map(numbered(sampled), choice(1, 2, 3));
  EXPECT_EQ(map.kind, SweepMap::Kind::dots);
  ASSERT_EQ(map.spots.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(map.spots[i].point, i);
    EXPECT_EQ(map.spots[i].x, sampled.axes[1].values[i % 4]);
    EXPECT_EQ(map.spots[i].y, i < 4 ? 1 : 3);
  }
  EXPECT_EQ(map.y_range, std::pair(0.0, 4.0));
}

TEST_F(PlacesOfMaps, AreACurveOfDotsOverOneSampledAxis) {
  const SweepPlan sampled = plan(kSampled);
  const SweepMap map = make_map(numbered(sampled), choice(0, {}, 3));
  EXPECT_EQ(map.kind, SweepMap::Kind::curve);
  ASSERT_EQ(map.spots.size(), 4u);
  for (std::size_t s = 0; s < 4; ++s) {
    EXPECT_EQ(map.spots[s].x, sampled.axes[0].values[s]);
    EXPECT_EQ(map.spots[s].y, static_cast<double>(s));
  }
}

// Points 0 to 3 are the samples at damping 1.
TEST_F(PlacesOfMaps, HaveTheMeanOfAllSamplesOverAGrid) {
  const SweepMap map = make_map(numbered(plan(kSampled), 7), choice(2, {}, 3));
  ASSERT_EQ(map.spots.size(), 2u);
  EXPECT_EQ(map.spots[0].x, 1);
  EXPECT_EQ(map.spots[0].y, 1.5);
  EXPECT_EQ(map.spots[0].count, 4u);
  EXPECT_EQ(map.spots[1].y, 5) << "of 4, 5 and 6";
  EXPECT_EQ(map.spots[1].count, 3u);
}

TEST_F(PlacesOfMaps, AreYesOrNoWhereEachIsOnePoint) {
  const std::string words = R"(axis = [ { key = "coupling.eta", values = [0.5, 1] },
         { key = "coupling.kind", values = ["standard", "proposed"] } ]
)";
  const SweepPlan single = plan("measure = [\"stable\"]\n" + words);
  const MapChoice first = first_choice(single, SweepTable(single));
  EXPECT_EQ(first.x, 0u);
  EXPECT_EQ(first.y, 1u) << "words, where no other axis has numbers";
  const SweepMap map = make_map(numbered(single), first);
  EXPECT_TRUE(map.yes_no);
  EXPECT_EQ(map.value_range, std::pair(0.0, 1.0));
  const SweepPlan twice = plan("measure = [\"stable\"]\nrepeats = 2\n" + words);
  EXPECT_FALSE(make_map(numbered(twice), first).yes_no) << "shares of repeats";
  const SweepPlan number = plan("measure = [\"energy\"]\n" + words);
  EXPECT_FALSE(make_map(numbered(number), first).yes_no);
}

TEST_F(PlacesOfMaps, OfOneAxisAreALineWithDotsInAFigure) {
  const SweepPlan curve = plan(R"(measure = ["energy"]
repeats = 2
axis = [ { key = "hand.stiffness", values = [10, 100, 1000], scale = "log" } ]
[figure]
caption = "What is seen."
)");
  const Figure figure = sweep_figure(curve, numbered(curve, 3).table);
  EXPECT_EQ(figure.title, "Places");
  EXPECT_EQ(figure.caption, "What is seen.");
  EXPECT_EQ(figure.columns, 1);
  ASSERT_EQ(figure.panels.size(), 1u);
  const FigurePanel& panel = figure.panels[0];
  EXPECT_EQ(panel.title, "energy");
  EXPECT_EQ(panel.x_label, "stiffness [N/m]");
  EXPECT_EQ(panel.y_label, "energy [J]");
  EXPECT_TRUE(panel.log_x);
  ASSERT_TRUE(panel.x_range);
  EXPECT_NEAR(panel.x_range->first, 10 / std::sqrt(10), 1e-9);
  EXPECT_NEAR(panel.x_range->second, 1000 * std::sqrt(10), 1e-6);
  EXPECT_TRUE(panel.x_ticks.empty());
  ASSERT_EQ(panel.series.size(), 2u);
  EXPECT_EQ(panel.series[0].style, Series::Style::line);
  EXPECT_EQ(panel.series[1].style, Series::Style::points);
  for (const Series& each : panel.series) {
    ASSERT_EQ(each.points.size(), 3u);
    EXPECT_EQ(each.points[0].x, 10);
    EXPECT_EQ(each.points[0].y, 0.5) << "the mean of both repeats";
    EXPECT_EQ(each.points[1].y, 2) << "the other repeat is not done";
    EXPECT_EQ(each.points[2].y, 4.5);
  }
}

// 25 values of a third axis are 25 maps, of which a page has room for 12 at most: every third.
TEST_F(PlacesOfMaps, AreNoMorePanelsThanThereIsRoomFor) {
  std::string values;
  for (int i = 1; i <= 25; ++i) values += fmt::format("{}{}", i > 1 ? ", " : "", 0.01 * i);
  const SweepPlan many = plan(R"(measure = ["energy"]
axis = [ { key = "coupling.eta", values = [0.5, 1] },
         { key = "hand.stiffness", values = [10, 1000], scale = "log" },
         { key = "observer.alpha", values = [)" +
                              values + "] } ]\n");
  const Figure figure = sweep_figure(many, numbered(many).table);
  ASSERT_EQ(figure.panels.size(), 9u);
  EXPECT_EQ(figure.columns, 3);
  for (std::size_t i = 0; i < 9; ++i) {
    const FigurePanel& panel = figure.panels[i];
    EXPECT_EQ(panel.title, fmt::format("alpha = {:.4g}", 0.01 * static_cast<double>(1 + 3 * i)));
    EXPECT_EQ(panel.x_label, "eta [-]");
    EXPECT_EQ(panel.y_label, "stiffness [N/m]");
    EXPECT_FALSE(panel.log_x);
    EXPECT_TRUE(panel.log_y);
    EXPECT_EQ(panel.x_range, std::pair(0.25, 1.25));
    EXPECT_NEAR(panel.y_range->first, 1, 1e-12) << "half a step of two decades";
    EXPECT_NEAR(panel.y_range->second, 1e4, 1e-8);
    EXPECT_EQ(panel.value_range, std::pair(0.0, 99.0)) << "the same of all panels";
    ASSERT_EQ(panel.series.size(), 1u);
    const Series& map = panel.series[0];
    EXPECT_EQ(map.label, "energy [J]");
    EXPECT_EQ(map.style, Series::Style::cells);
    std::vector<double> found;
    for (const FigureCell& cell : map.cells) found.push_back(cell.value);
    const auto first = static_cast<double>(3 * i);
    EXPECT_THAT(found, ElementsAre(first, first + 25, first + 50, first + 75));
    EXPECT_EQ(map.cells[3].x_low, 0.75);
    EXPECT_NEAR(map.cells[3].y_low, 100, 1e-9);
  }
}

TEST_F(PlacesOfMaps, AreInColumnsOfTheMeasureThatTheFigureWants) {
  const SweepPlan two = plan(R"(measure = ["energy", "seconds"]
axis = [ { key = "coupling.eta", values = [0.5, 1] },
         { key = "coupling.kind", values = ["standard", "tank"] } ]
[figure]
x = "kind"
y = "eta"
measure = "seconds"
)");
  SweepTable table(two);
  table.take(0, {1, 7, 2, 7, 3, 7, 4, 7});
  const FigurePanel panel = sweep_figure(two, table).panels.at(0);
  EXPECT_EQ(panel.title, "seconds");
  EXPECT_EQ(panel.x_label, "kind");
  ASSERT_EQ(panel.x_ticks.size(), 2u);
  EXPECT_EQ(panel.x_ticks[1], std::pair(1.0, std::string("tank")));
  ASSERT_EQ(panel.series.at(0).cells.size(), 4u);
  for (const FigureCell& cell : panel.series[0].cells) EXPECT_EQ(cell.value, 7);
  EXPECT_EQ(panel.value_range, std::pair(7.0, 8.0)) << "one value has a range, too";
  // Nothing that is not a number is drawn.
  table.take(3, {4, std::nan("")});
  EXPECT_EQ(sweep_figure(two, table).panels.at(0).series.at(0).cells.size(), 3u);
}

}  // namespace
}  // namespace limpid
