// The bench on which laws are compared: its arms, its search, and what it draws.
#include "app/experiments/law_bench.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "app/run/analysis.h"
#include "app/run/fitted_gains.h"
#include "core/coupling/walls.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using testing::UnorderedElementsAre;

TEST(BenchArm, IsItsFileUnlessSomethingIsAltered) {
  const ArmDescription touch = BenchArm{"Touch", "touch.urdf"}.arm();
  EXPECT_EQ(touch.encoder_step, 4.19e-4);
  EXPECT_EQ(touch.assumed_delay, 1e-3);
  const BenchArm plain{"ideal", "omni.urdf"};
  EXPECT_EQ(plain.arm().encoder_step, 0);
  EXPECT_EQ(plain.arm().assumed_delay, 0);
  const ArmDescription light = plain.arm(),
                       heavy = BenchArm{"heavy", "omni.urdf", 7, 4.19e-4, 2e-3}.arm();
  EXPECT_EQ(heavy.encoder_step, 4.19e-4);
  EXPECT_EQ(heavy.assumed_delay, 2e-3);
  const Eigen::VectorXd x = rest_pose(light);
  const Eigen::MatrixXd once = arm_at(light, x).M, seven = arm_at(heavy, x).M;
  EXPECT_NEAR((seven - 7 * once).norm(), 0, 1e-9 * seven.norm());
  EXPECT_EQ(arm_at(light, x).J, arm_at(heavy, x).J) << "of the same lengths";
}

TEST(BenchLaws, AreToldApartWithoutColours) {
  std::set<int> marks;
  std::set<std::string> inks;
  for (const BenchLaw& law : kBenchLaws) {
    EXPECT_EQ(&bench_law(law.kind), &law);
    EXPECT_TRUE(marks.insert(law.mark).second) << info(law.kind).key;
    EXPECT_TRUE(inks.insert(law.ink).second) << info(law.kind).key;
    const Series line = law.line(), points = law.points();
    EXPECT_EQ(line.label, info(law.kind).key);
    EXPECT_EQ(points.label, info(law.kind).key);
    EXPECT_EQ(line.style, Series::Style::line);
    EXPECT_EQ(points.style, Series::Style::points);
    EXPECT_EQ(points.mark, law.mark);
    EXPECT_STREQ(line.dash, law.dash);
  }
}

TEST(BenchHands, DampInTheirFirstHalf) {
  for (std::size_t i = 0; i < kHands.size(); ++i) {
    Parameters p;
    kHands[i].holds(p);
    EXPECT_EQ(p.hand_damping, i < kDamped ? 2 : 0);
    EXPECT_EQ(p.hand_stiffness, i % 2 == 0 ? 300 : 3000);
  }
}

// Within 20 % of the stiffness set, and at most 20 mm/s.
TEST(QuietTap, IsFeltAsSetAndDoesNotTremble) {
  EXPECT_TRUE((Came{.felt = 1, .chatter = 0.02}).well());
  EXPECT_TRUE((Came{.port = 1, .total = 1, .felt = 0.81, .chatter = 0}).well());
  EXPECT_TRUE((Came{.felt = 1.19, .chatter = 0}).well());
  EXPECT_FALSE((Came{.felt = 0.79, .chatter = 0}).well());
  EXPECT_FALSE((Came{.felt = 1.21, .chatter = 0}).well());
  EXPECT_FALSE((Came{.felt = 1, .chatter = 0.0201}).well());
}

TEST(SearchForTheStiffestWall, EndsWithinFivePercentBelowTheEnd) {
  const std::vector<double> ends{55, 700, 15000, 1e9, 1};
  const std::vector<double> found = stiffest_of(ends.size(), [&](const std::vector<double>& walls) {
    std::vector<bool> well;
    for (std::size_t i = 0; i < walls.size(); ++i) {
      EXPECT_GE(walls[i], 50);
      EXPECT_LE(walls[i], 20000);
      well.push_back(walls[i] <= ends[i]);
    }
    return well;
  });
  ASSERT_EQ(found.size(), 5u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LE(found[i], ends[i]);
    EXPECT_GT(found[i], ends[i] / 1.05);
  }
  EXPECT_GT(found[3], 20000 / 1.05);
  EXPECT_EQ(found[4], 50) << "not even the softest one";
}

TEST(DirectTheory, IsKeptFrom85To125Percent) {
  for (const auto& [ratio, low, high] : {std::tuple(0.84, false, true),
                                         {0.86, true, true},
                                         {1.24, true, true},
                                         {1.26, true, false}}) {
    const auto [least, most] = by_direct_theory("ratio", ratio);
    EXPECT_EQ(least.passed, low) << ratio;
    EXPECT_EQ(most.passed, high) << ratio;
    EXPECT_TRUE(least.least);
    EXPECT_FALSE(most.least);
    EXPECT_EQ(least.value, ratio);
    EXPECT_EQ(most.what, "ratio");
  }
}

TEST(EnergyOfTaps, IsDrawnOverTheStiffnessFelt) {
  const std::vector<LawCame> all{{CouplingKind::direct, {.port = 2e-3, .felt = 0.5}},
                                 {CouplingKind::eba, {.port = 0, .felt = 0.25}},
                                 {CouplingKind::direct, {.port = HUGE_VAL, .felt = 0}},
                                 {CouplingKind::direct, {.port = 1e-6, .felt = 3}}};
  const FigurePanel panel = energy_panel("title", all);
  EXPECT_EQ(panel.title, "title");
  EXPECT_TRUE(panel.log_x && panel.log_y);
  EXPECT_EQ(panel.series.size(), kBenchLaws.size());
  const auto points_of = [&](CouplingKind kind) {
    std::vector<std::pair<double, double>> points;
    for (const Series& s : panel.series) {
      if (s.label != info(kind).key) continue;
      for (const FigurePoint& p : s.points) points.emplace_back(p.x, p.y);
    }
    return points;
  };
  // A wall of 2000 N/m; from 20 to 4000 N/m, and from 1e-4 mJ to 1 J.
  EXPECT_THAT(
      points_of(CouplingKind::direct),
      UnorderedElementsAre(std::pair(1000.0, 2.0), std::pair(20.0, 1e3), std::pair(4000.0, 1e-3)));
  EXPECT_THAT(points_of(CouplingKind::eba), UnorderedElementsAre(std::pair(500.0, 1e-4)));
  EXPECT_TRUE(points_of(CouplingKind::popc).empty());
  ASSERT_TRUE(panel.x_range && panel.y_range);
  EXPECT_LE(panel.x_range->first, 20);
  EXPECT_GE(panel.x_range->second, 4000);
  EXPECT_LT(panel.y_range->first, 1e-4);
  EXPECT_GT(panel.y_range->second, 1e3);
}

// The predictive coupling renders the wall as set; the standard one has its spring before it.
TEST(TapsOfAnArm, FindStiffnessAndEnergyOfALaw) {
  const test::TempDir dir;
  TrialRunner::Options options;
  options.dir = dir / ".";
  TrialRunner lab("taps", options);
  const ArmDescription arm = BenchArm{"ideal", "omni.urdf"}.arm();
  std::vector<ArmTap> taps;
  for (const CouplingKind kind : {CouplingKind::predictive, CouplingKind::standard}) {
    ArmTap tap{{arm, fitted(arm)}, kCommonWall};
    tap.at.parameters.kind = kind;
    kHands[0].holds(tap.at.parameters);
    taps.push_back(tap);
  }
  const std::vector<Came> came = tap_arms(lab, taps);
  ASSERT_EQ(came.size(), 2u);
  EXPECT_NEAR(came[0].felt, 1, 0.02);
  EXPECT_TRUE(came[0].well());
  EXPECT_LT(came[0].port, 1e-4);
  const Parameters& p = taps[1].at.parameters;
  const ArmAt at = arm_at(arm, rest_pose(arm));
  const Eigen::VectorXd b = device_damping(arm, p);
  const TipAlong tip = tip_along(at.J, at.M, b, least_damped(at.J, b));
  const double in_series = 1 / (1 / kCommonWall + 1 / spring_at_tip(tip, p.k_vc));
  EXPECT_NEAR(kCommonWall * came[1].felt, in_series, 0.15 * in_series);
  EXPECT_FALSE(came[1].well());
  EXPECT_EQ(lab.diverged(), 0u);
}

}  // namespace
}  // namespace limpid
