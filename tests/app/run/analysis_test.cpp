#include "app/run/analysis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/dynamics/arm.h"
#include "core/math/eigen.h"
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
  EXPECT_TRUE(a.above_eta_min);  // eta = 1
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
    EXPECT_FALSE(a.above_eta_min);
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
  EXPECT_NEAR(limit, 0.56, 0.03);  // limit of the theory for this grip
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

TEST(Analysis, CountsTheProxysInertia) {
  const ArmDescription arm = test::omni();
  const Eigen::VectorXd x = Eigen::Vector3d(0.3, 0.8, -0.5);
  const Arm<kAnyDof> chain(arm);
  Arm<kAnyDof>::Frames f;
  Mat<kAnyDof> M;
  chain.frames(x, f);
  chain.inertia(f, M);
  const Eigen::VectorXd inertias = symmetric_eigen(M).values;
  Parameters p;
  p.inertia_ratio = 0.5;
  p.hand_stiffness = 1000;
  p.hand_damping = 0;
  const Analysis a = analyze(arm, x, p, {});
  ASSERT_EQ(a.w_f.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {  // M_L = M1 + M2 = 1.5 M1
    const double m = 1.5 * inertias[static_cast<Eigen::Index>(i)];
    EXPECT_NEAR(a.w_f[i] * m, 0.035, 1e-12);
    EXPECT_NEAR(a.w_c[i] * m, 0.024, 1e-12);
  }
  // With an undamped grip Routh's limit depends on the inertia, too.
  Parameters light = p;
  light.inertia_ratio = 1e-4;
  EXPECT_GT(std::abs(a.eta_min_grip - analyze(arm, x, light, {}).eta_min_grip), 1e-3);
}

TEST(Analysis, IsAboveEtaMinAtTheLimitItselfAndNotBelow) {
  Parameters p;  // b_d + b_v = 0.024
  p.alpha = 0.024;
  p.eta = 0.5;
  EXPECT_EQ(analyze(3e-4, test::omni(), p, {}).eta_min, 0.5);
  EXPECT_TRUE(analyze(3e-4, test::omni(), p, {}).above_eta_min);
  p.eta = std::nextafter(0.5, 0);
  EXPECT_FALSE(analyze(3e-4, test::omni(), p, {}).above_eta_min);
}

std::optional<bool> passive(const Parameters& p) {
  const ArmDescription arm = test::omni();
  return passivity(analyze(arm, rest_pose(arm), p, {}), p).passive;
}

// (25) is about the proposed law alone.
TEST(Passivity, IsAboutTheLawThatIsChosen) {
  Parameters p;
  p.eta = 0.01;
  p.kind = CouplingKind::proposed;
  EXPECT_EQ(passive(p), false);
  for (const auto kind : {CouplingKind::standard, CouplingKind::predictive, CouplingKind::tank}) {
    p.kind = kind;
    EXPECT_EQ(passive(p), true) << name(kind);
  }
}

// b_d = 0.012 is less than 2 b_vc + k_vc T = 1.002 N m s/rad.
TEST(Passivity, IsNoneOfSpringAndDamperWhereConditionThreeIsBroken) {
  Parameters p;
  p.tick = 0.1;
  for (const auto kind : {CouplingKind::standard, CouplingKind::proposed}) {
    p.kind = kind;
    EXPECT_EQ(passive(p), false) << name(kind);
  }
  p.kind = CouplingKind::tank;
  EXPECT_EQ(passive(p), true);
}

// On arms with unequally damped joints, Routh's limit of the grip may lie above eta_min.
TEST(Passivity, OfAGripIsNoneBelowRouthsLimit) {
  Analysis a;
  a.eta_min = 0.4;
  a.eta_min_grip = a.eta_min_compliant = 0.463;
  a.above_eta_min = true;
  a.condition3.holds = true;
  Parameters p;
  p.eta = 0.45;
  EXPECT_EQ(passivity(a, p).passive, false);
  p.eta = 0.47;
  EXPECT_EQ(passivity(a, p).passive, true);
}

TEST(Passivity, IsNotKnownWhereNoBoundIs) {
  Parameters p;
  p.link_delay = 1;
  p.k_vc = 1;  // (3) holds with that delay
  EXPECT_EQ(passive(p), std::nullopt) << "what is fed forward through a link";
  p.kind = CouplingKind::standard;
  EXPECT_EQ(passive(p), true);
  p.link_loss = 0.1;
  EXPECT_EQ(passive(p), std::nullopt) << "packets of any age";
  p.kind = CouplingKind::tank;
  EXPECT_EQ(passive(p), true) << "whatever the link does";
  Parameters late;
  late.device_delay = late.delay = 1;
  late.k_vc = 1;
  EXPECT_EQ(passive(late), std::nullopt) << "(25) knows no delay";
  Parameters slow;
  slow.kind = CouplingKind::predictive;
  slow.tick = 0.004;
  EXPECT_EQ(passive(slow), std::nullopt) << "tried at ticks of up to 1 ms";
}

TEST(Analysis, TakesTheWorstOfUnequallyDampedJoints) {
  ArmDescription arm = test::omni();
  std::vector<double> dampings{0.3, 0.013, 0.03};
  for (std::size_t i = 0; i < 3; ++i) arm.joints[i].damping = dampings[i];
  Parameters p;
  p.eta = 0.5;
  const Analysis of_mass = analyze(3e-4, arm, p, {});
  EXPECT_NEAR(of_mass.b, 0.025, 1e-15);
  EXPECT_NEAR(of_mass.eta_min, 35.0 / 60, 1e-12);
  EXPECT_NEAR(of_mass.condition3.device_margin, 0.001, 1e-15);
  const Analysis of_arm = analyze(arm, rest_pose(arm), p, 2 * kPi * 20);
  EXPECT_NEAR(of_arm.b, 0.025, 1e-15);
  EXPECT_NEAR(of_arm.condition3.device_margin, 0.001, 1e-15);
  // The result holds for any joint, and so for any mode.
  constexpr double w_b = 2 * kPi * 20;
  for (int turn = 0; turn < 3; ++turn) {
    std::rotate(dampings.begin(), dampings.begin() + 1, dampings.end());
    for (std::size_t i = 0; i < 3; ++i) arm.joints[i].damping = dampings[i];
    const Analysis a = analyze(arm, rest_pose(arm), p, w_b);
    double worst = 0, worst_in_band = 0, least = 1;
    for (const LockedMode& mode : a.modes) {
      worst = std::max(worst, 0.035 / (0.035 + mode.b));
      least = std::min(least, 0.035 / (0.035 + mode.b));
      const double w_f = 0.035 / mode.m, w_c = mode.b / mode.m;
      worst_in_band = std::max(worst_in_band, (w_f - w_c * w_f * w_f / (w_b * w_b)) / (w_c + w_f));
    }
    EXPECT_GT(worst, least + 0.05);  // the modes differ
    EXPECT_NEAR(a.eta_min, worst, 1e-12);
    EXPECT_NEAR(*a.eta_min_band, worst_in_band, 1e-12);
  }
}

}  // namespace
}  // namespace limpid
