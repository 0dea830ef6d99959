// Maps of tables that were filled by hand: places, means, ranges and lines.
#include "app/sweep/sweep_map.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "app/sweep/sweep_table.h"
#include "tests/app/sweep/plans.h"

namespace limpid {
namespace {

using testing::ElementsAre;

class HandMadeMaps : public testing::Test {
 protected:
  SweepPlan plan(const std::string& more,
                 const std::string& hand = "{ at = [0.19, 0, 0], jump = [1e-4, 0, 0] }") {
    return test::sweep_plan(
        dir_, fmt::format("scene = \"free.toml\"\nhand = {}\nseconds = 0.02\n{}", hand, more));
  }
  static OpenedSweep sweep(const SweepPlan& plan, std::vector<std::pair<double, double>> ranges) {
    return {"", std::make_shared<SweepPlan>(plan), SweepTable(plan), "", "", std::move(ranges)};
  }
  static MapChoice over(std::size_t x, std::optional<std::size_t> y, std::size_t axes) {
    return {.column = 0, .x = x, .y = y, .place = std::vector<std::size_t>(axes, 0)};
  }

  const test::TempDir dir_;
};

const std::string kGrid = R"(measure = ["human_rms"]
axis = [ { key = "hand.stiffness", values = [1000, 100, 10], scale = "log" },
         { key = "coupling.eta", values = [0.2, 0.4, 0.8] },
         { key = "coupling.kind", values = ["standard", "proposed"] } ]
)";

TEST_F(HandMadeMaps, HaveCellsHalfAStepAroundTheirValues) {
  const SweepPlan grid = plan(kGrid);
  const AxisCells ratios(grid.axes[0]), steps(grid.axes[1]), words(grid.axes[2]);
  const double half = std::sqrt(10);
  for (const double x : {10.0, 100.0, 1000.0}) {
    EXPECT_NEAR(ratios.around(x).first, x / half, 1e-9 * x);
    EXPECT_NEAR(ratios.around(x).second, x * half, 1e-9 * x);
  }
  EXPECT_NEAR(ratios.all().first, 10 / half, 1e-9);
  EXPECT_NEAR(ratios.all().second, 1000 * half, 1e-6);
  EXPECT_NEAR(steps.around(0.2).first, 0.1, 1e-12) << "as far as to the next value";
  EXPECT_NEAR(steps.around(0.2).second, 0.3, 1e-12);
  EXPECT_NEAR(steps.around(0.4).second, 0.6, 1e-12);
  EXPECT_NEAR(steps.around(0.8).first, 0.6, 1e-12);
  EXPECT_NEAR(steps.around(0.8).second, 1.0, 1e-12);
  EXPECT_EQ(words.around(1), std::pair(0.5, 1.5));
  const SweepPlan single = plan(R"(measure = ["human_rms"]
axis = [ { key = "coupling.eta", values = [0.5] } ]
)");
  EXPECT_EQ(AxisCells(single.axes[0]).around(0.5), std::pair(0.0, 1.0));
}

TEST_F(HandMadeMaps, NameTheirAxes) {
  const SweepPlan grid = plan(kGrid);
  EXPECT_EQ(axis_called(grid, "eta", {}), 1u);
  EXPECT_EQ(axis_called(grid, "kind", {}), 2u);
  EXPECT_EQ(axis_called(grid, "none", {}), std::nullopt);
  EXPECT_EQ(axis_called(grid, "", {}), 0u);
  EXPECT_EQ(axis_called(grid, "", 0), 1u) << "another one";
  EXPECT_EQ(axis_called(grid, "", 1), 0u);
  EXPECT_EQ(axis_at(grid.axes[0], 2), 10);
  EXPECT_EQ(axis_at(grid.axes[2], 1), 1) << "words stand at 0, 1, ...";
  EXPECT_EQ(value_text(grid.axes[0], 0), "1000");
  EXPECT_EQ(value_text(grid.axes[1], 1), "0.4");
  EXPECT_EQ(value_text(grid.axes[2], 1), "proposed");
  EXPECT_EQ(label_of("stiffness", "N/m"), "stiffness [N/m]");
  EXPECT_EQ(label_of("comes to rest", "yes/no"), "comes to rest");
  const SweepPlan large = plan(R"(measure = ["human_rms"]
axis = [ { key = "hand.stiffness", values = [12345.6, 999.96, 0.00123456] } ]
)");
  EXPECT_EQ(value_text(large.axes[0], 0), "12346") << "no powers of ten";
  EXPECT_EQ(value_text(large.axes[0], 1), "1000");
  EXPECT_EQ(value_text(large.axes[0], 2), "0.001235");
}

TEST_F(HandMadeMaps, BeginWithTheFiguresChoice) {
  const SweepPlan asked = plan(R"(measure = ["human_rms", "energy"]
axis = [ { key = "hand.stiffness", values = [10, 100] },
         { key = "coupling.eta", values = [0.2, 0.4] },
         { key = "coupling.kind", values = ["standard", "proposed"] } ]
[figure]
measure = "energy"
x = "eta"
y = "kind"
)");
  const MapChoice choice = first_choice(asked, SweepTable(asked));
  EXPECT_EQ(SweepTable(asked).columns[choice.column].name, "energy");
  EXPECT_EQ(choice.x, 1u);
  EXPECT_EQ(choice.y, 2u);
  EXPECT_THAT(choice.place, ElementsAre(0u, 0u, 0u));
  // Whatever the plan lacks is replaced.
  MapChoice wrong = over(7, 7, 1);
  wrong.place = {9, 9};
  const MapChoice right = mended(asked, wrong);
  EXPECT_EQ(right.x, 2u);
  EXPECT_EQ(right.y, 0u);
  EXPECT_THAT(right.place, ElementsAre(1u, 1u, 0u));
  EXPECT_EQ(mended(asked, over(0, 0, 3)).y, 1u);
  const SweepPlan one = plan(R"(measure = ["human_rms"]
axis = [ { key = "coupling.eta", values = [0.2, 0.4] } ]
)");
  EXPECT_EQ(mended(one, over(0, 1, 1)).y, std::nullopt);
}

// Points are numbered with the last axis fastest; spots go from the lowest values up.
TEST_F(HandMadeMaps, HaveEachValueInItsCell) {
  const SweepPlan grid = plan(kGrid);
  OpenedSweep filled = sweep(grid, {{0, 17}});
  std::vector<double> values;
  const std::size_t columns = filled.table.columns.size();
  for (int i = 0; i < 18; ++i) {
    values.push_back(i);
    values.insert(values.end(), columns - 1, 0.0);
  }
  filled.ranges.resize(columns, {0, 1});
  filled.table.take(0, values);
  MapChoice choice = over(0, 1, 3);
  choice.place[2] = 1;
  const SweepMap map = make_map(filled, choice);
  EXPECT_EQ(map.kind, SweepMap::Kind::cells);
  ASSERT_EQ(map.spots.size(), 9u);
  EXPECT_EQ(map.rows, 3u);
  for (std::size_t ix = 0; ix < 3; ++ix) {
    for (std::size_t iy = 0; iy < 3; ++iy) {
      const MapSpot& spot = map.spots[3 * ix + iy];
      const std::uint64_t point = (2 - ix) * 6 + iy * 2 + 1;
      EXPECT_EQ(spot.point, point);
      EXPECT_EQ(spot.count, 1u);
      EXPECT_EQ(spot.cell.value, static_cast<double>(point));
      EXPECT_NEAR(spot.x, std::pow(10, ix + 1), 1e-9);
      EXPECT_NEAR(spot.y, 0.2 * std::pow(2, iy), 1e-9);
      EXPECT_LT(spot.cell.x_low, spot.x);
      EXPECT_GT(spot.cell.x_high, spot.x);
    }
  }
  EXPECT_EQ(map.value_range, std::pair(0.0, 17.0)) << "of all points, seen or not";
  EXPECT_FALSE(map.yes_no || map.log_values);
  EXPECT_NEAR(map.y_range.first, 0.1, 1e-12);
  EXPECT_NEAR(map.y_range.second, 1, 1e-12);
  filled.ranges[0] = {1e-3, 1.01};
  EXPECT_TRUE(make_map(filled, choice).log_values) << "many decades";
  filled.ranges[0] = {1e-3, 0.99};
  EXPECT_FALSE(make_map(filled, choice).log_values);
  filled.ranges[0] = {0, 1e6};
  EXPECT_FALSE(make_map(filled, choice).log_values) << "zero has no logarithm";
  filled.ranges[0] = {3, 3};
  EXPECT_EQ(make_map(filled, choice).value_range, std::pair(3.0, 4.0));
}

TEST_F(HandMadeMaps, AreCurvesWithRoomOverOneAxis) {
  const SweepPlan one = plan(R"(measure = ["human_rms"]
axis = [ { key = "coupling.eta", values = [0.2, 0.4, 0.8] } ]
)");
  OpenedSweep filled = sweep(one, {});
  const std::size_t columns = filled.table.columns.size();
  filled.ranges.assign(columns, {0, 1});
  filled.ranges[0] = {10, 30};
  std::vector<double> values;
  for (const double v : {10.0, std::nan(""), 30.0}) {
    values.push_back(v);
    values.insert(values.end(), columns - 1, 0.0);
  }
  filled.table.take(0, values);
  const SweepMap map = make_map(filled, over(0, {}, 1));
  EXPECT_EQ(map.kind, SweepMap::Kind::curve);
  ASSERT_EQ(map.spots.size(), 3u);
  EXPECT_EQ(map.spots[0].y, 10);
  EXPECT_TRUE(std::isnan(map.spots[1].y));
  EXPECT_EQ(map.spots[1].count, 1u) << "it is done, but not finite";
  EXPECT_EQ(map.spots[2].y, 30);
  EXPECT_NEAR(map.y_range.first, 9, 1e-9) << "a twentieth below";
  EXPECT_NEAR(map.y_range.second, 31, 1e-9);
  EXPECT_NEAR(map.x_range.first, 0.1, 1e-9);
}

TEST_F(HandMadeMaps, HaveTheMeanOfRepeats) {
  std::ofstream(dir_ / "hand.csv") << "time_s,x_m,y_m,z_m\n0,0.19,0,0\n1,0.201,0,0\n";
  const SweepPlan twice = plan(R"(measure = ["human_rms"]
repeats = 2
axis = [ { key = "coupling.eta", values = [0.2, 0.4] },
         { key = "hand.stiffness", values = [100, 200] } ]
)",
                               "\"hand.csv\"");
  OpenedSweep filled = sweep(twice, {});
  const std::size_t columns = filled.table.columns.size();
  filled.ranges.assign(columns, {0, 8});
  std::vector<double> values;
  for (const double v : {1.0, 3.0, 5.0, std::nan(""), 7.0, 8.0, 2.0, 4.0}) {
    values.push_back(v);
    values.insert(values.end(), columns - 1, 0.0);
  }
  filled.table.take(0, values);
  const SweepMap map = make_map(filled, over(0, 1, 2));
  ASSERT_EQ(map.spots.size(), 4u);
  EXPECT_EQ(map.spots[0].cell.value, 2);
  EXPECT_EQ(map.spots[0].count, 2u);
  EXPECT_EQ(map.spots[1].cell.value, 5) << "of those that are finite";
  EXPECT_EQ(map.spots[1].count, 2u);
  EXPECT_EQ(map.spots[2].cell.value, 7.5);
  EXPECT_EQ(map.spots[3].cell.value, 3);
}

// (25) of the scalar arm: eta_min has no grip in it, so its line is level over stiffness.
TEST_F(HandMadeMaps, HaveLinesOfTheoryFromEdgeToEdge) {
  const SweepPlan theory = plan(R"(measure = ["human_rms"]
set = ["hand.damping = 0"]
axis = [ { key = "hand.stiffness", values = [100, 10000], scale = "log" },
         { key = "coupling.eta", values = [0.2, 0.4, 0.8] } ]
[figure]
theory = ["pr", "routh", "routh_compliant"]
)");
  EXPECT_EQ(theory_label("pr"), "PR (25)");
  EXPECT_EQ(theory_label("routh"), "Routh, locked");
  EXPECT_EQ(theory_label("routh_compliant"), "Routh, proxy on its spring");
  const Series pr = theory_line(theory, 0, theory.axes[0], "pr");
  const Series routh = theory_line(theory, 0, theory.axes[0], "routh");
  ASSERT_EQ(pr.points.size(), 81u);
  EXPECT_EQ(pr.style, Series::Style::dashed);
  EXPECT_EQ(routh.style, Series::Style::line);
  EXPECT_NEAR(pr.points.front().x, 10, 1e-9);
  EXPECT_NEAR(pr.points.back().x, 1e5, 1e-4);
  EXPECT_NEAR(pr.points[40].x, 1000, 1e-6) << "evenly in the logarithm";
  for (const FigurePoint& p : pr.points) EXPECT_NEAR(p.y, pr.points[0].y, 1e-9);
  EXPECT_LE(routh.points.front().y, routh.points.back().y) << "a stiffer grip needs more";
  EXPECT_LE(routh.points.back().y, pr.points[0].y + 1e-6) << "and all frequencies the most";
  EXPECT_EQ(make_map(sweep(theory, {{0, 1}, {0, 1}}), over(0, 1, 2)).lines.size(), 3u);
  EXPECT_TRUE(make_map(sweep(theory, {{0, 1}, {0, 1}}), over(1, 0, 2)).lines.empty())
      << "lines are over eta alone";
}

// Over eta alone the limit is one number: where the map over the grip has it for this grip.
TEST_F(HandMadeMaps, HaveUprightLinesOfTheoryOverEta) {
  const SweepPlan curve = plan(R"(measure = ["human_rms"]
set = ["hand.damping = 0", "hand.stiffness = 900"]
axis = [ { key = "coupling.eta", values = [0.1, 2.0, 4.0] } ]
[figure]
theory = ["pr", "routh"]
)");
  const SweepMap map = make_map(sweep(curve, {{-2, 6}}), over(0, {}, 1));
  ASSERT_EQ(map.lines.size(), 2u);
  for (const Series& line : map.lines) {
    ASSERT_EQ(line.points.size(), 2u);
    EXPECT_EQ(line.points[0].x, line.points[1].x);
    EXPECT_EQ(line.points[0].y, map.y_range.first) << "from edge to edge";
    EXPECT_EQ(line.points[1].y, map.y_range.second);
  }
  const SweepPlan grips = plan(R"(measure = ["human_rms"]
set = ["hand.damping = 0"]
axis = [ { key = "hand.stiffness", values = [400, 900] } ]
)");
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string name = i == 0 ? "pr" : "routh";
    EXPECT_EQ(map.lines[i].label, theory_label(name));
    EXPECT_NEAR(map.lines[i].points[0].x, eta_limit(name, run_of(grips, 1)), 1e-12) << name;
  }
  const SweepPlan beyond = plan(R"(measure = ["human_rms"]
axis = [ { key = "coupling.eta", values = [3.0, 4.0] } ]
[figure]
theory = ["pr"]
)");
  EXPECT_TRUE(make_map(sweep(beyond, {{-2, 6}}), over(0, {}, 1)).lines.empty());
}

}  // namespace
}  // namespace limpid
