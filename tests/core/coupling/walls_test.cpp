// Limits of walls at the tip, against a bar and a sliding mass with simple numbers.
#include "core/coupling/walls.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/eigen.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

// A bar of length l that turns about one joint: the tip moves along y.
TipAlong bar(double l, double inertia, double b_d) {
  const Eigen::MatrixXd J = Vec3(0, l, 0);
  return tip_along(J, Eigen::MatrixXd::Constant(1, 1, inertia), Eigen::VectorXd::Constant(1, b_d),
                   Vec3::UnitY());
}

TEST(TipAlong, OfABarHasItsInertiaAndDampingOverTheLeverSquared) {
  const TipAlong tip = bar(0.2, 4e-4, 0.012);
  EXPECT_NEAR(tip.mass, 4e-4 / 0.04, 1e-15);
  EXPECT_NEAR(tip.damping, 0.012 / 0.04, 1e-14);
  EXPECT_NEAR(tip.lever2, 0.04, 1e-16);
  EXPECT_NEAR(spring_at_tip(tip, 10), 250, 1e-11);
}

// A force F n turns the joints by K^-1 J' n F, K their springs, and moves the tip by n' J K^-1 J' n
// F.
TEST(TipAlong, SpringsThatDifferGiveWayByTheirSum) {
  test::Random random(612);
  for (int joints = 3; joints < 8; ++joints) {
    const Eigen::MatrixXd J = random.matrix(joints, 0.2).topRows(3);
    const Eigen::VectorXd weights = 1 + 50 * random.vector(joints, 1).array().abs();
    const Vec3 n = Vec3(random.between(-1, 1), random.between(-1, 1), 0.3).normalized();
    const Mat3 gives = J * (8 * weights).cwiseInverse().asDiagonal() * J.transpose();
    const double stiffness = 1 / n.dot(gives * n);
    TipAlong tip;
    tip.lever2 = (J.transpose() * n).squaredNorm();
    EXPECT_NEAR(spring_at_tip(tip, 8 * weight_at_tip(J, weights, n)), stiffness, 1e-9 * stiffness);
    const double softest = 1 / symmetric_eigen(gives).values[2];
    const double lever = easiest(J, Eigen::MatrixXd::Identity(joints, joints)).lever;
    EXPECT_NEAR(8 * longest_levers_weight(J, weights) / (lever * lever), softest, 1e-9 * softest);
  }
}

// Led along n, the tip's kinetic energy is the least of all joint velocities that move it so; free
// to give way, a force along n moves it more.
TEST(TipAlong, LedMassIsTheLeastThatMovesTheTipSo) {
  test::Random random(611);
  for (int i = 0; i < 20; ++i) {
    const int joints = 4 + i % 3;
    const Eigen::MatrixXd J = random.matrix(joints, 0.2).topRows(3);
    const Eigen::MatrixXd M = random.positive_definite(joints, 1e-4, 1e-2);
    const Vec3 n = Vec3(random.between(-1, 1), random.between(-1, 1), 0.3).normalized();
    const TipAlong tip = tip_along(J, M, Eigen::VectorXd::Constant(joints, 0.01), n);
    EXPECT_GE(tip.led, tip.mass * (1 - 1e-9));
    const Eigen::MatrixXd reach = J.transpose() * (J * J.transpose()).inverse();
    const Eigen::MatrixXd still = Eigen::MatrixXd::Identity(joints, joints) - reach * J;
    // v = J^+ n + N z with the z that has the least energy: (N' M N) z = -N' M J^+ n.
    const Eigen::VectorXd base = reach * n;
    const Eigen::VectorXd z =
        least_squares(still.transpose() * M * still, -(still.transpose() * M * base));
    const Eigen::VectorXd v = base + still * z;
    EXPECT_LT((J * v - n).norm(), 1e-9);
    EXPECT_NEAR(v.dot(M * v), tip.led, 1e-6 * tip.led);
  }
}

TEST(TipAlong, LeastDampedIsWhereTheLongLeverIsIfNothingIsDamped) {
  Eigen::MatrixXd J(3, 2);
  J << 0.1, 0, 0, 0.3, 0, 0;
  EXPECT_NEAR(std::abs(least_damped(J, Eigen::Vector2d(0, 0)).y()), 1, 1e-12);
  EXPECT_NEAR(std::abs(least_damped(J, Eigen::Vector2d(0, 0.01)).x()), 1, 1e-6);
}

TEST(TipAlong, LeastDampedIsWhereTheLongLeverOrTheWeakDamperIs) {
  Eigen::MatrixXd J(3, 2);
  J << 0.1, 0, 0, 0.3, 0, 0;
  EXPECT_NEAR(std::abs(least_damped(J, Eigen::Vector2d(0.01, 0.01)).y()), 1, 1e-12);
  EXPECT_NEAR(std::abs(least_damped(J, Eigen::Vector2d(0.001, 0.1)).x()), 1, 1e-12);
}

TEST(Walls, OfThePapersLawAreDampingOverLag) {
  const TipAlong tip = bar(0.225, 5e-4, 0.012);
  const double r2 = 0.225 * 0.225;
  const WallSetting s{.T = 0.001, .k_vc = 10, .b_v = 0.012, .eta = 0.6, .hand_damping = 2};
  EXPECT_NEAR(proposed_wall(tip, s), 0.6 * ((0.012 + 0.012 + 0.005) / r2 + 2) / (0.0005 + 0.0012),
              1e-9);
}

TEST(Walls, ThatAreInfinitelyFastAndHeavyHandedEndWhereTheDesignSaysSo) {
  // (2 b m_p / (T^3 (1 - m_p/m)))^1/2 with the hand's mass far above the device's.
  const TipAlong tip = bar(0.225, 5e-4, 0.012);
  WallSetting s{.T = 0.001, .k_vc = 10, .b_v = 0.012, .hand_damping = 2, .hand_mass = 1e6};
  const double b = (0.012 + 0.012) / 0.225 / 0.225 + 2 + 0.2 * tip.mass / 0.001;
  EXPECT_NEAR(mistaken_wall(tip, s), std::sqrt(2 * b * tip.mass / 1e-9), 1e-3);
  const double heavy = mistaken_wall(tip, s);
  s.hand_mass = tip.mass;  // half of the moving mass: 2^1/2 as stiff
  EXPECT_NEAR(mistaken_wall(tip, s), std::sqrt(2.0) * heavy, 1e-2);
  s.hand_mass = 0;
  EXPECT_TRUE(std::isinf(mistaken_wall(tip, s)));
}

TEST(Walls, AreSofterWhereTheTorqueIsLate) {
  const TipAlong tip = bar(0.225, 5e-4, 0.012);
  WallSetting s{.T = 0.001, .k_vc = 10, .b_v = 0.012, .hand_damping = 2};
  const double prompt = proposed_wall(tip, s);
  s.delay = 0.0017;  // half a tick and b_v/k_vc together
  EXPECT_NEAR(proposed_wall(tip, s), prompt / 2, 1e-9);
  EXPECT_NEAR(every_hands_wall(tip, 0.001, 0.002), every_hands_wall(tip, 0.001) / 5, 1e-9);
}

TEST(Walls, OfEveryHandAreTwiceTheDampingOverATick) {
  EXPECT_NEAR(every_hands_wall(bar(0.225, 5e-4, 0.012), 0.001), 2 * 0.012 / 0.225 / 0.225 / 0.001,
              1e-9);
}

// Bounds of a wall by encoder steps: the tip of 51.6 g and 0.2 m that a Touch has, or another mass.
struct Stepped {
  double mass = 0.0516, friction = 0, q_t = 8.4e-5, delay = 0, T = 0.001;  // [kg, N, m, s, s]

  BoundedWall named() const {
    constexpr double kLever = 0.2;
    PredictiveWallSetting s{.at = {.T = T, .k_vc = 10, .delay = delay}};
    s.encoder_step = q_t / kLever;
    s.friction = friction;
    s.delay_foreseen = delay;
    s.inertia_ratio = 1e-9;
    return predictive_wall({mass, kLever}, s);
  }
};

// The tip swings with 0.6 of a step times its natural frequency, which may be 5 mm/s.
TEST(Walls, ThatNoFrictionHoldsEndWhereTheTipSwingsInsideACell) {
  for (const double mass : {0.01, 0.0516, 0.3}) {
    const BoundedWall wall = Stepped{.mass = mass}.named();
    EXPECT_NEAR(0.6 * 8.4e-5 * std::sqrt(wall.stiffness / mass), 5e-3, 1e-8);
    EXPECT_EQ(wall.by, WallBound::cell);
  }
}

TEST(Walls, ThroughFineEncodersEndWhereTheyWereTried) {
  for (const double friction : {0.0, 0.1}) {
    const BoundedWall wall = Stepped{.friction = friction, .q_t = 2e-6}.named();
    EXPECT_EQ(wall.stiffness, 10000);
    EXPECT_EQ(wall.by, WallBound::tried);
  }
}

TEST(Walls, AreHeldByFrictionUpToItsForceOverHalfAStep) {
  const BoundedWall wall = Stepped{.friction = 0.06}.named();
  EXPECT_NEAR(wall.stiffness * 8.4e-5 / 2, 0.06, 1e-8);
  EXPECT_EQ(wall.by, WallBound::friction);
  const BoundedWall little = Stepped{.friction = 0.02}.named();
  EXPECT_EQ(little.by, WallBound::cell);
  EXPECT_EQ(little.stiffness, Stepped{}.named().stiffness) << "less than without";
}

TEST(Walls, EndWhereAStepPushesWithAQuarterOfANewton) {
  for (const double friction : {0.26, 5.0}) {
    const BoundedWall wall = Stepped{.friction = friction}.named();
    EXPECT_NEAR(wall.stiffness * 8.4e-5, 0.25, 1e-8);
    EXPECT_EQ(wall.by, WallBound::step);
  }
}

// An error of position grows with the filter's bandwidth until a late torque meets the device.
TEST(Walls, OfStepsAreSofterByWhatADelayMakesOfThem) {
  constexpr double kDelay = 0.001;
  const double K = Stepped{.friction = 0.26, .delay = kDelay}.named().stiffness;
  const double rest = std::cbrt(std::sqrt(12.0) * 10 / 0.0516 / 8.4e-5);
  const double a = kDelay * std::max(rest, std::sqrt(K / 0.0516));
  EXPECT_NEAR(K * 8.4e-5 * (1 + a + a * a / 2), 0.25, 1e-6);
}

TEST(Walls, OfStepsAreTheSameForEveryTickUpToAMillisecond) {
  for (const double friction : {0.0, 0.06, 0.26}) {
    const double usual = Stepped{.friction = friction}.named().stiffness;
    EXPECT_EQ((Stepped{.friction = friction, .T = 2.5e-4}.named().stiffness), usual);
  }
}

TEST(Walls, KnowTheFrictionOfTheJointThatHoldsTheTipLeast) {
  Eigen::MatrixXd J(3, 3);
  J << 0.1, 0, 0, 0, 0.2, 0, 0, 0, 0;
  EXPECT_NEAR(friction_at_tip(J, Eigen::Vector3d(0.02, 0.03, 0)), 0.15, 1e-12)
      << "the last one does not move it";
}

}  // namespace
}  // namespace limpid
