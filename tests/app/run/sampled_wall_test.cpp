// The sampled loop of tip, hand and wall, against closed forms of sampled systems.
#include "app/run/sampled_wall.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace limpid {
namespace {

HeldArm one_joint(double mass, double damping, double stiffness, double T, int delay) {
  const auto number = [](double value) { return Eigen::MatrixXd::Constant(1, 1, value); };
  return {number(mass), number(damping), number(stiffness), T, delay, Eigen::VectorXd::Ones(1)};
}
double on_device(const HeldArm& arm, double K) {
  return growth_on_device(arm, Eigen::MatrixXd::Constant(1, 1, K));
}
double behind_spring(const HeldArm& arm, const SpringDamper& gains, double M2, double K) {
  return growth_behind_spring(arm, gains, Eigen::MatrixXd::Constant(1, 1, M2),
                              Eigen::MatrixXd::Constant(1, 1, K));
}

// m v' = -b v - K x_k, held: with a = b/m and E = exp(-a T) the poles leave the unit circle at
// K = b (1 - E)/((1 - E)/a - T E).
double stiffest_held(double m, double b, double T) {
  const double a = b / m, E = std::exp(-a * T);
  return b * (1 - E) / ((1 - E) / a - T * E);
}

TEST(SampledWall, IsStableUpToTheClosedForm) {
  for (const double m : {0.01, 0.1, 1.0}) {
    for (const double b : {0.25, 2.0, 6.0}) {
      for (const double T : {0.001, 0.0002}) {
        const HeldArm tip = one_joint(m, b, 0, T, 0);
        const double K = stiffest_held(m, b, T);
        EXPECT_NEAR(stable_up_to([&](double k) { return on_device(tip, k); }), K, 1e-4 * K)
            << m << " " << b << " " << T;
      }
    }
  }
}

// A heavy tip, whose force is late by T/2 and the delay: K = (b_d + b_h)/(T/2 + t_d).
TEST(SampledWall, OfAHeavyTipIsItsDampingOverTheLag) {
  for (const int delay : {0, 1, 3, 10}) {
    const HeldArm tip = one_joint(3, 2, 0, 0.001, delay);
    const double K = 2 / (0.0005 + 0.001 * delay);
    EXPECT_NEAR(stable_up_to([&](double k) { return on_device(tip, k); }), K, 0.02 * K) << delay;
  }
}

// Before a wall that does not give way the proxy stands still, and the spring is a wall on the
// device. The proxy's own velocity changes its sign with every tick then, which counts as stable.
TEST(SampledWall, BehindASpringBeforeARigidWallIsTheSpringAlone) {
  const HeldArm tip = one_joint(0.05, 1.5, 400, 0.001, 2);
  for (const double k : {100.0, 1000.0, 3000.0}) {
    const double alone = on_device(tip, k);
    EXPECT_EQ(alone > 1, k > 500) << "1.5/(T/2 + 2 T) is 600 N/m";
    EXPECT_NEAR(behind_spring(tip, {k, 0, 1}, 0.001, 1e13), std::max(alone, 1.0), 1e-6);
  }
}

// Condition (3) makes it passive, so that every hand without damping of its own is stable on every
// wall; beyond it some are not.
TEST(SampledWall, BehindASpringIsStableInEveryHandWhereConditionThreeHolds) {
  const double T = 0.001, b_d = 0.6;
  const SpringDamper edge{b_d / T, 0, b_d / 2}, beyond{20 * b_d / T, 0, b_d / 2};
  int unstable = 0;
  for (const double hand : {1.0, 30.0, 1000.0, 30'000.0}) {
    for (const double M2 : {1e-6, 1e-3, 0.1}) {
      const HeldArm tip = one_joint(0.01, b_d, hand, T, 0);
      EXPECT_TRUE(std::isinf(stable_up_to([&](double K) {
        return behind_spring(tip, edge, M2, K);
      }))) << hand
           << " " << M2;
      unstable +=
          std::isinf(stable_up_to([&](double K) { return behind_spring(tip, beyond, M2, K); })) ? 0
                                                                                                : 1;
    }
  }
  EXPECT_GT(unstable, 0);
}

// A damper alone, before a rigid wall: m D' = -b_vc D/T of the tick before, held. With a = b_d/m
// and E = exp(-a T) a tick takes v to E v + (1 - E)/b_d f and moves by (1 - E)/a v + (T - (1 -
// E)/a)/b_d f, f = -b_vc/T of the last motion.
TEST(SampledWall, BehindADamperIsTheClosedForm) {
  const double m = 0.02, b_d = 0.5, T = 0.001, E = std::exp(-b_d / m * T), p = (1 - E) * m / b_d;
  for (const double b_vc : {8.0, 60.0, 100.0}) {
    // Poles of [v, D] -> [E v - g D, p v - h D].
    const double g = (1 - E) / b_d * b_vc / T, h = (T - p) / b_d * b_vc / T;
    const std::complex<double> root =
        std::sqrt(std::complex<double>((E - h) * (E - h) - 4 * (p * g - E * h)));
    const double largest = std::max(std::abs(E - h + root), std::abs(E - h - root)) / 2;
    EXPECT_NEAR(behind_spring(one_joint(m, b_d, 0, T, 0), {0, b_vc, 1}, 0.001, 1e13),
                std::max(largest, 1.0), 1e-6)
        << b_vc;
    EXPECT_EQ(largest > 1, b_vc > 50) << b_vc;
  }
}

// Joints that have nothing to do with each other grow as the worst of them does, also where they
// are seen in other coordinates.
TEST(SampledWall, OfSeveralJointsIsTheWorstOfThem) {
  const SpringDamper gains{60, 0.01, 0.02};
  const HeldArm joints[] = {one_joint(2e-4, 0.01, 5, 0.001, 2),
                            one_joint(1e-3, 0.02, 20, 0.001, 2)};
  const double walls[] = {30, 2}, M2[] = {1e-5, 2e-4};
  Eigen::Matrix2d turn;
  turn << 0.6, -0.8, 0.8, 0.6;
  const auto both = [&](double one, double two) -> Eigen::MatrixXd {
    return turn * Eigen::Vector2d(one, two).asDiagonal() * turn.transpose();
  };
  const HeldArm arm{both(2e-4, 1e-3),        both(0.01, 0.02), both(5, 20), 0.001, 2,
                    Eigen::VectorXd::Ones(2)};
  double direct = 0, behind = 0;
  for (int i = 0; i < 2; ++i) {
    direct = std::max(direct, on_device(joints[i], walls[i]));
    behind = std::max(behind, behind_spring(joints[i], gains, M2[i], walls[i]));
  }
  EXPECT_NE(direct, behind);
  EXPECT_NEAR(growth_on_device(arm, both(walls[0], walls[1])), direct, 1e-9);
  EXPECT_NEAR(growth_behind_spring(arm, gains, both(M2[0], M2[1]), both(walls[0], walls[1])),
              behind, 1e-9);
}

// A joint whose gains have a weight is a joint alone with gains as large.
TEST(SampledWall, OfJointsWithGainsOfTheirOwnIsTheWorstOfThem) {
  const SpringDamper gains{6, 0.001, 0.002};
  const double weights[] = {3, 40}, walls[] = {30, 2000}, M2[] = {1e-5, 2e-4};
  const HeldArm joints[] = {one_joint(2e-4, 0.01, 5, 0.001, 1), one_joint(1e-3, 0.2, 20, 0.001, 1)};
  const auto both = [](double one, double two) -> Eigen::MatrixXd {
    return Eigen::Vector2d(one, two).asDiagonal();
  };
  const HeldArm arm{both(2e-4, 1e-3),
                    both(0.01, 0.2),
                    both(5, 20),
                    0.001,
                    1,
                    Eigen::Vector2d(weights[0], weights[1])};
  FedForward forward{.eta = 0.8,
                     .alpha = 0.01,
                     .phi = 0,
                     .inertia = both(2e-4, 1e-3),
                     .damping = Eigen::Vector2d(0.01, 0.2)};
  double behind[2], ahead[2];
  for (int i = 0; i < 2; ++i) {
    const double w = weights[i];
    const SpringDamper own{w * gains.k_vc, w * gains.b_vc, w * gains.b_v};
    behind[i] = behind_spring(joints[i], own, M2[i], walls[i]);
    FedForward one = forward;
    one.inertia = joints[i].inertia;
    one.damping = forward.damping.segment(i, 1);
    ahead[i] = growth_fed_forward(joints[i], own, one, Eigen::MatrixXd::Constant(1, 1, M2[i]),
                                  Eigen::MatrixXd::Constant(1, 1, walls[i]));
  }
  EXPECT_NE(behind[0], behind[1]);
  EXPECT_NEAR(growth_behind_spring(arm, gains, both(M2[0], M2[1]), both(walls[0], walls[1])),
              std::max(behind[0], behind[1]), 1e-9);
  EXPECT_NEAR(growth_fed_forward(arm, gains, forward, both(M2[0], M2[1]), both(walls[0], walls[1])),
              std::max(ahead[0], ahead[1]), 1e-9);
}

TEST(SampledWall, NoneIsStableWhereTheTipIsNot) {
  EXPECT_EQ(stable_up_to([](double) { return 1.01; }), 0);
  EXPECT_TRUE(std::isinf(stable_up_to([](double) { return 0.99; })));
  EXPECT_NEAR(stable_up_to([](double K) { return K < 1234 ? 0.9 : 1.1; }), 1234, 0.01);
}

}  // namespace
}  // namespace limpid
