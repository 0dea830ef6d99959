#include "app/run/analysis.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/dynamics/arm.h"
#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

constexpr double kPi = 3.14159265358979323846;

TEST(Analysis, OfAScalarInertiaIsTheTheoryInClosedForm) {
  const Parameters p;
  const Analysis a = analyze(3e-4, test::omni(), p, 2 * kPi * 20);
  EXPECT_NEAR(a.b, 0.024, 1e-15);
  ASSERT_EQ(a.w_f.size(), 1u);
  EXPECT_NEAR(a.w_f[0], 0.035 / 3e-4, 1e-9);
  EXPECT_NEAR(a.w_c[0], 0.024 / 3e-4, 1e-9);
  EXPECT_NEAR(a.eta_min, 35.0 / 59, 1e-12);
  EXPECT_TRUE(a.passive);  // eta = 1
  EXPECT_TRUE(a.condition3.holds);
  const double w_f = 0.035 / 3e-4, w_c = 80, w_b = 2 * kPi * 20;
  EXPECT_NEAR(*a.eta_min_band, (w_f - w_c * w_f * w_f / (w_b * w_b)) / (w_c + w_f), 1e-12);
}

TEST(Analysis, WithoutABandSaysNothingAboutIt) {
  EXPECT_FALSE(analyze(3e-4, test::omni(), Parameters{}, {}).eta_min_band);
}

TEST(Analysis, OfAnArmIsAlphaOverAlphaPlusBInEveryPose) {
  const ArmDescription arm = test::omni();
  test::Random random(160);
  Parameters p;
  p.eta = 0.59;
  for (int round = 0; round < 10; ++round) {
    const Analysis a = analyze(arm, random.vector(3, 1), p, {});
    EXPECT_NEAR(a.eta_min, 35.0 / 59, 1e-9);
    EXPECT_FALSE(a.passive);
    ASSERT_EQ(a.modes.size(), 3u);
    EXPECT_LE(a.modes[0].m, a.modes[2].m);
  }
}

TEST(Analysis, OfAGripIsWhereTheFirstPoleOfTheHandleCrosses) {
  const ArmDescription arm = test::omni();
  Parameters p;
  p.hand_stiffness = 3000;
  p.hand_damping = 0;
  const Eigen::VectorXd x = rest_pose(arm);
  const double limit = analyze(arm, x, p, {}).eta_min_grip;
  EXPECT_NEAR(limit, 0.56, 0.03);  // what the theory found for this grip
  const auto growth = [&](double eta) {
    p.eta = eta;
    double most = -1e9;
    for (const auto& pole : handle_poles(arm, x, p)) most = std::max(most, pole.real());
    return most;
  };
  EXPECT_LT(growth(1.02 * limit), 0);
  EXPECT_GT(growth(0.98 * limit), 0);
}

TEST(Analysis, TakesTheDampingThatIsSet) {
  Parameters p;
  p.damping = 0.035 - p.b_v;  // b = alpha
  EXPECT_NEAR(analyze(test::omni(), rest_pose(test::omni()), p, {}).eta_min, 0.5, 1e-9);
}

}  // namespace
}  // namespace limpid
