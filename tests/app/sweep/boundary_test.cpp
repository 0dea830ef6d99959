#include <gmock/gmock.h>

#include <cmath>

#include "app/sweep/measure_point.h"
#include "app/sweep/sweep_figure.h"
#include "app/sweep/sweep_map.h"
#include "tests/app/sweep/plans.h"

namespace limpid {
namespace {

using testing::ElementsAre;

const std::string kRouth = R"(scene = "free.toml"
hand = { at = [0.19, 0, 0], jump = [2e-5, 2e-5, 2e-5] }
seconds = 1.5
set = ["hand.damping = 0", "loop.tick = 2e-4", "device.substeps = 4"]
axis = [{ key = "hand.stiffness", values = [300, 3000] }]
[boundary]
measure = "stable"
tolerance = 0.01
axis = { key = "coupling.eta", from = 0.2, to = 1, count = 3 }
[figure]
theory = ["routh_compliant"]
)";

class Boundaries : public testing::Test {
 protected:
  test::TempDir dir_;
  std::atomic<bool> stop_{false};
};

// Routh's limit of the continuous loop, in grips of any stiffness.
TEST_F(Boundaries, OfStabilityAreRouthsLimit) {
  const SweepPlan plan = test::sweep_plan(dir_, kRouth);
  ASSERT_EQ(plan.points(), 2u);
  for (std::uint64_t i = 0; i < 2; ++i) {
    const auto values = *measure_point(plan, i, stop_);
    EXPECT_NEAR(values[0], eta_limit("routh_compliant", run_of(plan, i)), 0.03);
    EXPECT_EQ(values[0], values[1]);
    EXPECT_EQ(values[2], 1) << "stable at eta 1";
    EXPECT_EQ(values[3], 1) << "changes";
    EXPECT_LE(values[4], 3 + std::ceil(std::log2(0.4 / 0.01))) << "runs";
  }
}

TEST_F(Boundaries, AreNoneWhereNothingChanges) {
  std::string text = kRouth;
  text.replace(text.find("from = 0.2"), 10, "from = 0.9");
  const SweepPlan plan = test::sweep_plan(dir_, text);
  const auto values = *measure_point(plan, 0, stop_);
  EXPECT_TRUE(std::isnan(values[0]) && std::isnan(values[1]));
  EXPECT_THAT(std::vector(values.begin() + 2, values.end()), ElementsAre(1, 0, 3));
}

TEST_F(Boundaries, AreDrawnWithTheory) {
  const SweepPlan plan = test::sweep_plan(dir_, kRouth);
  SweepTable table(plan);
  for (std::uint64_t i = 0; i < 2; ++i) table.take(i, *measure_point(plan, i, stop_));
  const Figure figure = sweep_figure(plan, table);
  ASSERT_EQ(figure.panels.size(), 1u);
  const auto& series = figure.panels[0].series;
  ASSERT_EQ(series.size(), 3u);  // the line, its points, theory
  EXPECT_EQ(series[0].points.size(), 2u);
  EXPECT_EQ(series[2].label, theory_label("routh_compliant"));
  EXPECT_EQ(figure.panels[0].y_label, "eta [-]");
}

}  // namespace
}  // namespace limpid
