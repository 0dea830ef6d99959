// Searches for boundaries that are known: the stiffness of the wall, along itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "app/sweep/measure_point.h"
#include "app/sweep/record_point.h"
#include "app/sweep/sweep_map.h"
#include "app/sweep/sweep_table.h"
#include "tests/app/sweep/plans.h"

namespace limpid {
namespace {

using testing::ElementsAre;

class KnownBoundary : public testing::Test {
 protected:
  SweepPlan read(const std::string& boundary) {
    return test::sweep_plan(dir_, R"(scene = "table.toml"
hand = { at = [0.19, 0, 0.02] }
seconds = 0.003
axis = [{ key = "hand.stiffness", values = [300] }]
[boundary]
measure = "wall"
)" + boundary);
  }
  std::vector<double> find(const std::string& boundary) {
    return measure_point(read(boundary), 0, stop_).value();
  }
  const test::TempDir dir_;
  std::atomic<bool> stop_{false};
};

// From 400 to 1000 ten halvings come to less than 1 N/m; three values are tried before.
TEST_F(KnownBoundary, IsFoundWithinItsTolerance) {
  const auto found = find(R"(above = 500
tolerance = 1
axis = { key = "scene.stiffness", values = [1000, 100, 400] }
)");
  ASSERT_EQ(found.size(), 5u);
  EXPECT_NEAR(found[0], 500, 0.5);
  EXPECT_EQ(found[1], found[0]) << "the only one";
  EXPECT_THAT(std::vector(found.begin() + 2, found.end()), ElementsAre(1, 1, 3 + 10));
}

TEST_F(KnownBoundary, IsTheLowestAndTheHighestOfSeveral) {
  const auto found = find(R"(above = 300
below = 700
tolerance = 1
axis = { key = "scene.stiffness", values = [100, 500, 1000] }
)");
  EXPECT_NEAR(found[0], 300, 0.5);
  EXPECT_NEAR(found[1], 700, 0.5);
  EXPECT_THAT(std::vector(found.begin() + 2, found.end()), ElementsAre(0, 2, 3 + 9 + 9));
}

// From 1 to 10000 ten square roots come to a ratio of less than 1.01.
TEST_F(KnownBoundary, IsFoundByRatiosOnALogarithm) {
  const auto found = find(R"(above = 50
tolerance = 0.01
axis = { key = "scene.stiffness", from = 1, to = 10000, count = 2, scale = "log" }
)");
  EXPECT_NEAR(found[0] / 50, 1, 0.005);
  EXPECT_THAT(std::vector(found.begin() + 2, found.end()), ElementsAre(1, 1, 2 + 10));
}

TEST_F(KnownBoundary, HasColumnsThatSayWhatTheyAre) {
  const auto columns = measured_columns(read(R"(above = 500
tolerance = 1
axis = { key = "scene.stiffness", values = [100, 1000] }
)"));
  std::vector<std::string> names, units, what;
  for (const SweepColumn& each : columns) {
    names.push_back(each.name);
    units.push_back(each.unit);
    what.push_back(each.what);
  }
  EXPECT_THAT(names, ElementsAre("boundary", "boundary_last", "at_top", "changes", "runs"));
  EXPECT_THAT(units, ElementsAre("N/m", "N/m", "yes/no", "-", "-"));
  EXPECT_THAT(what, ElementsAre("lowest wall at which wall changes",
                                "highest wall at which the result changes",
                                "whether the condition wall is met at the highest wall",
                                "number of changes of the result between the values tried",
                                "number of runs made"));
}

TEST_F(KnownBoundary, IsNoneWhereTheSearchIsStopped) {
  const SweepPlan plan = read(R"(above = 500
tolerance = 1
axis = { key = "scene.stiffness", values = [100, 1000] }
)");
  stop_ = true;
  EXPECT_FALSE(measure_point(plan, 0, stop_));
}

// A single run of a search can be recorded: its measure is the condition's.
TEST_F(KnownBoundary, HasRunsThatCanBeRecorded) {
  const SweepPlan plan = read(R"(above = 500
tolerance = 1
axis = { key = "scene.stiffness", values = [100, 1000] }
)");
  const auto out = point_file(dir_ / "out", 0, 640.5);
  EXPECT_EQ(out, dir_ / "out/points/0-at-640.5.h5");
  EXPECT_EQ(point_file(dir_ / "out", 12, {}), dir_ / "out/points/12.h5");
  std::vector<double> parts;
  const auto recorded =
      record_point(plan, 0, 640.5, out, stop_, [&](double part) { parts.push_back(part); });
  ASSERT_TRUE(recorded);
  EXPECT_THAT(recorded->values, ElementsAre(640.5));
  EXPECT_EQ(recorded->summary.totals().rows, 3u);
  EXPECT_THAT(parts, ElementsAre(0, testing::DoubleEq(1 / 3.0), testing::DoubleEq(2 / 3.0)));
  const Session session = read_session(out);
  EXPECT_EQ(session.size(), 3u);
  EXPECT_THAT(session.info.scene, testing::HasSubstr("640.5")) << "the scene as it was run";
}

TEST(Differences, BetweenRunsAndTheirTableAreNamed) {
  const test::TempDir dir;
  const SweepPlan plan = test::sweep_plan(dir, test::kShort);  // human_rms, energy, stable
  const double none = std::nan("");
  const std::vector<double> same{0.5, none, 1}, other{0.75, none, 1};
  EXPECT_EQ(differences(plan, same, same), "");
  EXPECT_EQ(differences(plan, {0.5, 0.25, 1}, other),
            "human_rms is 0.5, but the table says 0.75; energy is 0.25, but the table says nan");
}

// The searched values over eta; the second point changes twice, the fourth is not done.
class BoundaryMaps : public testing::Test {
 protected:
  OpenedSweep sweep(const std::string& key, const std::string& more = "") {
    const SweepPlan plan = test::sweep_plan(dir_, R"(scene = "table.toml"
hand = { at = [0.19, 0, 0.02] }
seconds = 0.003
axis = [{ key = "hand.stiffness", values = [100, 200, 300, 400] }]
[boundary]
measure = "stable"
tolerance = 0.01
axis = { key = ")" + key + "\", values = [0.25, 0.5, 1] }\n" +
                                                      more);
    OpenedSweep made{"", std::make_shared<SweepPlan>(plan), SweepTable(plan), "", "", {}};
    const double none = std::nan("");
    made.table.take(0, {0.375, 0.375, 1, 1, 5, 0.3, 0.75, 0, 2, 9, none, none, 1, 0, 3});
    made.ranges = {{0.3, 0.375}, {0.375, 0.75}, {0, 1}, {0, 2}, {3, 9}};
    return made;
  }
  const test::TempDir dir_;
};

TEST_F(BoundaryMaps, AreCurvesOverTheFirstAxisWithTheHighestChangeBeside) {
  const OpenedSweep made = sweep("observer.alpha");
  const MapChoice choice = first_choice(*made.plan, made.table);
  EXPECT_EQ(choice.column, 0u);
  EXPECT_FALSE(choice.y);
  const SweepMap map = make_map(made, choice);
  EXPECT_EQ(map.kind, SweepMap::Kind::curve);
  EXPECT_EQ(map.y_range, std::pair(0.25, 1.0)) << "all of the search's axis";
  EXPECT_EQ(map.x_range, std::pair(50.0, 450.0));
  ASSERT_EQ(map.spots.size(), 4u);
  EXPECT_EQ(map.spots[0].y, 0.375);
  EXPECT_EQ(map.spots[1].y, 0.3);
  EXPECT_TRUE(map.spots[2].there() && std::isnan(map.spots[2].y));
  EXPECT_FALSE(map.spots[3].there());
  ASSERT_EQ(map.lines.size(), 1u);
  const Series& last = map.lines[0];
  EXPECT_EQ(last.label, "highest change");
  EXPECT_EQ(last.style, Series::Style::dashed);
  ASSERT_EQ(last.points.size(), 3u);
  EXPECT_EQ(std::pair(last.points[0].x, last.points[0].y), std::pair(100.0, 0.375));
  EXPECT_EQ(std::pair(last.points[1].x, last.points[1].y), std::pair(200.0, 0.75));
  EXPECT_TRUE(std::isnan(last.points[2].y));
  MapChoice runs = choice;
  runs.column = 4;
  const SweepMap counted = make_map(made, runs);
  EXPECT_TRUE(counted.lines.empty());
  EXPECT_NEAR(counted.y_range.first, 3 - 0.05 * 6, 1e-12) << "its own range";
  EXPECT_NEAR(counted.y_range.second, 9 + 0.05 * 6, 1e-12);
}

TEST_F(BoundaryMaps, HaveNoHighestChangeWhereEachIsTheOnlyOne) {
  OpenedSweep made = sweep("observer.alpha");
  made.table.take(1, {0.75, 0.75, 0, 1, 9});
  EXPECT_TRUE(make_map(made, first_choice(*made.plan, made.table)).lines.empty());
}

TEST_F(BoundaryMaps, OfEtaHaveTheoryBeside) {
  const OpenedSweep made = sweep("coupling.eta", "[figure]\ntheory = [\"routh\"]\n");
  const SweepMap map = make_map(made, first_choice(*made.plan, made.table));
  ASSERT_EQ(map.lines.size(), 2u);
  EXPECT_EQ(map.lines[1].label, theory_label("routh"));
  EXPECT_NEAR(map.lines[1].points.front().x, 50, 1e-12);
  EXPECT_NEAR(map.lines[1].points.back().x, 450, 1e-12);
  MapChoice top{.column = 2, .x = 0, .y = {}, .place = {0}};
  EXPECT_TRUE(make_map(made, top).lines.empty()) << "no values of eta";
}

}  // namespace
}  // namespace limpid
