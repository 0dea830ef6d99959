// The passive integrator: energy to round-off at every step, and the motion itself.
#include "core/touch/proxy.h"

#include <gtest/gtest.h>

#include <tuple>

#include "core/math/eigen.h"
#include "tests/support/proxy_drive.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::no_drive;
using test::Random;
using test::random_arm;
using AnyProxy = Proxy<kAnyDof>;
using Vector = Vec<kAnyDof>;

class ProxyOfJoints : public testing::TestWithParam<std::tuple<int, double, double>> {
 protected:
  int n() const { return std::get<0>(GetParam()); }
  double T() const { return std::get<1>(GetParam()); }
  double ratio() const { return std::get<2>(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(ArmsTicksAndRatios, ProxyOfJoints,
                         testing::Combine(testing::Values(1, 2, 3, 7),
                                          testing::Values(0.001, 0.002, 0.004, 0.008),
                                          testing::Values(1e-4, 1.0)));

TEST_P(ProxyOfJoints, BalancesEnergyAndWorkAtEveryStepOfAThousand) {
  Random random(31);
  AnyProxy proxy(random_arm(n(), 30), Scene{});
  proxy.place(random.vector(n(), 2), random.vector(n(), 3), ratio());
  for (int k = 0; k < 1000; ++k) {
    ProxyDrive<kAnyDof> drive = no_drive(n());
    drive.constant = random.vector(n(), 0.2) * std::sqrt(ratio());
    if (k % 2 == 0) drive.damping = 0.02 * ratio() * random.vector(n(), 1).cwiseAbs();
    const double before = proxy.kinetic_energy();
    const Vector x = proxy.x();
    proxy.advance(T(), drive);
    const Vector dx = proxy.x() - x;
    const Vector torque = proxy.tau() + proxy.f();
    const double after = proxy.kinetic_energy();
    // Error of the work from the rounding of positions of the size of x.
    const double resolution = 1e-15 * torque.norm() * x.norm();
    EXPECT_NEAR(after - before, torque.dot(dx), 1e-11 * std::max(before, after) + resolution)
        << "step " << k;
  }
}

TEST_P(ProxyOfJoints, KeepsItsEnergyForAThousandFreeSteps) {
  Random random(33);
  AnyProxy proxy(random_arm(n(), 32), Scene{});
  proxy.place(random.vector(n(), 2), random.vector(n(), 3), ratio());
  const double energy = proxy.kinetic_energy();
  for (int k = 0; k < 1000; ++k) {
    proxy.advance(T(), no_drive(n()));
    ASSERT_NEAR(proxy.kinetic_energy(), energy, 1e-12 * energy) << "step " << k;
    proxy.catch_up();
    ASSERT_NEAR(0.5 * proxy.v().dot(proxy.M() * proxy.v()), energy, 1e-9 * energy);
  }
}

TEST_P(ProxyOfJoints, SaysTheTorqueThatTheDriveAsksFor) {
  Random random(35);
  AnyProxy proxy(random_arm(n(), 34), Scene{});
  proxy.place(random.vector(n(), 2), random.vector(n(), 3), ratio());
  for (int k = 0; k < 50; ++k) {
    ProxyDrive<kAnyDof> drive = no_drive(n());
    drive.constant = random.vector(n(), 0.2);
    drive.damping = 0.018 * (1 + random.vector(n(), 0.9).array());
    proxy.advance(T(), drive);
    const Vector wanted = drive.constant - drive.damping.cwiseProduct(proxy.vbar());
    EXPECT_LT((proxy.tau() - wanted).norm(), 1e-10 * (1 + wanted.norm()));
    EXPECT_EQ(proxy.f().norm(), 0);
  }
}

// (6) by a fourth-order method in small steps.
void exact_motion(const Arm<kAnyDof>& arm, double ratio, const Vector& torque, double time,
                  Vector& x, Vector& v) {
  const auto acceleration = [&](const Vector& at, const Vector& rate) {
    Arm<kAnyDof>::Frames f;
    Mat<kAnyDof> M;
    Vector Cv;
    arm.frames(at, f);
    arm.inertia_bias(f, rate, M, Cv);
    return Vector(least_squares(ratio * M, torque - ratio * Cv));
  };
  constexpr int kSteps = 400;
  const double h = time / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const Vector a1 = acceleration(x, v);
    const Vector v2 = v + h / 2 * a1, a2 = acceleration(x + h / 2 * v, v2);
    const Vector v3 = v + h / 2 * a2, a3 = acceleration(x + h / 2 * v2, v3);
    const Vector v4 = v + h * a3, a4 = acceleration(x + h * v3, v4);
    x += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
}

TEST(Proxy, ConvergesToTheContinuousMotion) {
  for (const int n : {1, 2, 3, 7}) {
    const ArmDescription description = random_arm(n, 36);
    Random random(37);
    const Vector x = random.vector(n, 2), v = random.vector(n, 2);
    const Vector torque = random.vector(n, 2e-4);
    constexpr double kTime = 0.2, kRatio = 0.3;
    Vector x_exact = x, v_exact = v;
    exact_motion(Arm<kAnyDof>(description), kRatio, torque, kTime, x_exact, v_exact);
    const auto error = [&](int steps) {
      AnyProxy proxy(description, Scene{});
      proxy.place(x, v, kRatio);
      ProxyDrive<kAnyDof> drive = no_drive(n);
      drive.constant = torque;
      for (int k = 0; k < steps; ++k) proxy.advance(kTime / steps, drive);
      return (proxy.x() - x_exact).norm() + kTime * (proxy.v() - v_exact).norm();
    };
    const double coarse = error(800), fine = error(1600);
    EXPECT_LT(fine, 0.02 * (x_exact - x).norm()) << n;
    EXPECT_LT(fine, 0.6 * coarse + 1e-12) << n;  // first order: at least half
  }
}

TEST(Proxy, OfOneJointFollowsTheScalarMidpointRule) {
  const ArmDescription description = random_arm(1, 38);
  constexpr double T = 0.002, k_vc = 10, b = 0.013, kRatio = 1e-3;
  AnyProxy proxy(description, Scene{});
  proxy.place(Vector::Constant(1, 0.3), Vector::Constant(1, -0.7), kRatio);
  const double m = proxy.M()(0, 0);
  double x = 0.3, v = -0.7;
  for (int k = 0; k < 200; ++k) {
    const double x1 = 0.5 * std::sin(0.05 * k);
    ProxyDrive<kAnyDof> drive = no_drive(1);
    drive.constant << k_vc * (x1 - proxy.x()[0]);
    drive.damping.setConstant(b + k_vc * T / 2);
    proxy.advance(T, drive);
    // m (v' - v)/T = k_vc (x1 - (x + x')/2) - b vbar,  x' = x + T vbar,  vbar = (v + v')/2
    const double vbar = (2 * m * v / T + k_vc * (x1 - x)) / (2 * m / T + b + k_vc * T / 2);
    x += T * vbar;
    v = 2 * vbar - v;
    ASSERT_NEAR(proxy.x()[0], x, 1e-12);
    ASSERT_NEAR(proxy.v()[0], v, 1e-9);
    ASSERT_NEAR(proxy.tau()[0], k_vc * (x1 - (x - T * vbar / 2)) - b * vbar, 1e-10);
  }
}

TEST(Proxy, KeepsItsVelocityWhenTheRatioChanges) {
  Random random(39);
  AnyProxy proxy(random_arm(3, 39), Scene{});
  const Vector v = random.vector(3, 2);
  proxy.place(random.vector(3, 2), v, 1e-4);
  const double energy = proxy.kinetic_energy();
  proxy.set_ratio(0.25);
  EXPECT_LT((proxy.v() - v).norm(), 1e-12);
  EXPECT_NEAR(proxy.kinetic_energy(), 2500 * energy, 1e-9 * 2500 * energy);
}

TEST(Proxy, OfThreeJointsIsTheSameWithFixedAndWithAnySize) {
  const ArmDescription description = random_arm(3, 40);
  Random random(41);
  const Eigen::VectorXd x = random.vector(3, 2), v = random.vector(3, 2);
  Proxy<3> fixed(description, Scene{});
  AnyProxy any(description, Scene{});
  fixed.place(x, v, 0.1);
  any.place(x, v, 0.1);
  for (int k = 0; k < 100; ++k) {
    const Eigen::VectorXd constant = random.vector(3, 1e-3);
    fixed.advance(0.001, {constant, Vec3::Constant(0.01)});
    any.advance(0.001, {constant, Vec3::Constant(0.01)});
    ASSERT_LT((fixed.x() - any.x()).norm(), 1e-12);
    ASSERT_LT((fixed.v() - any.v()).norm(), 1e-10);
  }
}

}  // namespace
}  // namespace limpid
