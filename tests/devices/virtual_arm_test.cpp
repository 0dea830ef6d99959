// The virtual device against motions known otherwise.
#include "devices/virtual_arm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;
using test::random_arm;
using Vector = Vec<kAnyDof>;
using AnyArm = VirtualArm<kAnyDof>;

// A joint about z with a link of this inertia and its tip a metre ahead.
ArmDescription wheel(double inertia) {
  ArmDescription arm;
  arm.joints.resize(1);
  arm.links.resize(1);
  arm.joints[0].effort = 1;
  arm.links[0].inertia = inertia * Mat3::Identity();
  arm.tip.translation() = Vec3::UnitX();
  return arm;
}

Vector one(double value) { return Vector::Constant(1, value); }
const HandInput kNoHand{Vec3::Zero(), 0};

TEST(VirtualArm, CoastsUnderItsDampingExponentially) {
  constexpr double m = 3e-4, b = 0.012;
  AnyArm arm(wheel(m));
  Parameters p;
  p.damping = b;
  arm.place(one(0), one(5), Vec3::Zero());
  for (int k = 1; k <= 100; ++k) {
    arm.live(p, one(0), kNoHand);
    const double decay = std::exp(-b / m * k * p.tick);
    ASSERT_NEAR(arm.read(0).v[0], 5 * decay, 1e-4);
    ASSERT_NEAR(arm.read(0).x[0], 5 * m / b * (1 - decay), 1e-6);
  }
}

TEST(VirtualArm, AcceleratesUnderAConstantTorqueAsAParabola) {
  constexpr double m = 3e-4;
  AnyArm arm(wheel(m));
  Parameters p;
  p.damping = 0;
  arm.place(one(0.2), one(0), Vec3::Zero());
  for (int k = 1; k <= 100; ++k) {
    arm.live(p, one(0.01), kNoHand);
    const double t = k * p.tick;
    ASSERT_NEAR(arm.read(0).x[0], 0.2 + 0.5 * 0.01 / m * t * t, 1e-12);
  }
}

TEST(VirtualArm, SwingsInAGripForeverAsASpringDoes) {
  // Small swings: the tip's spring of 300 N/m at 1 m is 300 N m/rad.
  constexpr double m = 0.02, k_h = 300, amplitude = 1e-4;
  AnyArm arm(wheel(m));
  Parameters p;
  p.damping = 0;
  p.hand_stiffness = k_h;
  p.hand_damping = 0;
  p.substeps = 50;
  const double w = std::sqrt(k_h / m);
  arm.place(one(amplitude), one(0), Vec3::UnitX());
  double largest = 0;
  for (int k = 1; k <= 2000; ++k) {
    arm.live(p, one(0), {Vec3::UnitX(), 1});
    if (k <= 200) {
      ASSERT_NEAR(arm.read(0).x[0], amplitude * std::cos(w * k * p.tick), 2e-3 * amplitude);
    }
    if (k > 1800) largest = std::max(largest, std::abs(arm.read(0).x[0]));
  }
  EXPECT_NEAR(largest, amplitude, 1e-2 * amplitude);  // no numerical damping, no growth
}

TEST(VirtualArm, ConvergesWithTheSquareOfItsSubsteps) {
  for (const int n : {2, 3, 7}) {
    const ArmDescription description = random_arm(n, 130);
    Random random(131);
    const Vector x = random.vector(n, 1), v = random.vector(n, 2), torque = random.vector(n, 0.01);
    const auto after = [&](int substeps) {
      AnyArm arm(description);
      Parameters p;
      p.substeps = substeps;
      arm.place(x, v, Vec3::Zero());
      arm.place(x, v, arm.tip());
      Vec3 target = arm.tip();
      for (int k = 0; k < 20; ++k) {
        target += Vec3(1e-4, -2e-4, 1e-4);
        arm.live(p, torque, {target, 1});
      }
      return Vector(arm.read(0).x);
    };
    const Vector exact = after(800);
    const double coarse = (after(10) - exact).norm(), fine = (after(20) - exact).norm();
    EXPECT_LT(fine, coarse / 3) << n;  // a quarter
    EXPECT_LT(fine, 1e-4) << n;
  }
}

TEST(VirtualArm, SpeaksOfTheHandsMeanTorqueAsItsMomentumDoes) {
  // One joint: m dv = T (motor + hand - b vbar).
  constexpr double m = 3e-4, b = 0.012;
  AnyArm arm(wheel(m));
  Parameters p;
  p.damping = b;
  arm.place(one(0.3), one(0), Vec3::UnitX());
  for (int k = 0; k < 300; ++k) {
    const double v = arm.read(0).v[0], x = arm.read(0).x[0];
    arm.live(p, one(0.02), {Vec3(std::cos(0.3), std::sin(0.3 + 0.001 * k), 0), 1});
    const double gained = m * (arm.read(0).v[0] - v) / p.tick;
    const double damped = b * (arm.read(0).x[0] - x) / p.tick;
    ASSERT_NEAR(arm.hand_torque()[0], gained - 0.02 + damped, 1e-9);
  }
}

TEST(VirtualArm, FeelsNoHandThatHasLetGo) {
  Random random(132);
  AnyArm arm(random_arm(3, 132));
  const Parameters p;
  arm.place(random.vector(3, 1), Vector::Zero(3), Vec3::Zero());
  const Vector before = arm.read(0).x;
  for (int k = 0; k < 50; ++k) arm.live(p, Vector::Zero(3), {Vec3(1, 2, 3), 0});
  EXPECT_EQ(arm.read(0).x, before);
  EXPECT_EQ(arm.hand_torque().norm(), 0);
}

TEST(VirtualArm, SticksBelowItsFrictionAndSlidesAboveIt) {
  constexpr double m = 3e-4, kFriction = 0.05;
  Parameters p;
  p.damping = 0;
  p.friction = kFriction;
  AnyArm stuck(wheel(m));
  stuck.place(one(0), one(0), Vec3::Zero());
  for (int k = 0; k < 1000; ++k) stuck.live(p, one(0.9 * kFriction), kNoHand);
  EXPECT_LT(std::abs(stuck.read(0).v[0]), 1e-3);  // it creeps at most
  EXPECT_LT(std::abs(stuck.read(0).x[0]), 1e-3);
  AnyArm sliding(wheel(m));
  sliding.place(one(0), one(0), Vec3::Zero());
  for (int k = 0; k < 100; ++k) sliding.live(p, one(1.5 * kFriction), kNoHand);
  EXPECT_NEAR(sliding.read(0).v[0], 0.5 * kFriction / m * 0.1, 0.02 * 0.5 * kFriction / m * 0.1);
}

TEST(VirtualArm, ComesToRestByFrictionWithoutSwingingBack) {
  constexpr double m = 3e-4, kFriction = 0.05;
  AnyArm arm(wheel(m));
  Parameters p;
  p.damping = 0;
  p.friction = kFriction;
  arm.place(one(0), one(2), Vec3::Zero());
  double last = 2;
  for (int k = 0; k < 200; ++k) {
    arm.live(p, one(0), kNoHand);
    const double v = arm.read(0).v[0];
    ASSERT_GE(v, -1e-5);  // a hundredth of the speed below which friction is a damper
    ASSERT_LE(std::abs(v), std::abs(last) + 1e-12);
    last = v;
  }
  EXPECT_LT(last, 1e-3);
  EXPECT_NEAR(arm.read(0).x[0], 0.5 * m * 4 / kFriction, 1e-3);  // its energy over the friction
}

TEST(VirtualArm, IsHeldByItsStops) {
  ArmDescription description = wheel(3e-4);
  description.joints[0].lower = -0.5;
  description.joints[0].upper = 0.8;
  AnyArm arm(description);
  const Parameters p;
  for (const double torque : {1.0, -1.0}) {  // the motor's limit
    arm.place(one(0), one(0), Vec3::Zero());
    for (int k = 0; k < 3000; ++k) arm.live(p, one(torque), kNoHand);
    const double stop = torque > 0 ? 0.8 : -0.5;
    EXPECT_NEAR(arm.read(0).x[0], stop + 0.01 * torque, 1e-4);
    EXPECT_NEAR(arm.read(0).v[0], 0, 1e-6);
  }
}

TEST(VirtualArm, IsReadInWholeEncoderSteps) {
  Random random(133);
  AnyArm arm(random_arm(3, 133));
  const Vector x = random.vector(3, 1), v = random.vector(3, 1);
  arm.place(x, v, Vec3::Zero());
  EXPECT_EQ(arm.read(0).measured, x);
  constexpr double step = 4e-4;
  const auto reading = arm.read(step);
  EXPECT_EQ(reading.x, x);
  EXPECT_EQ(reading.v, v);
  for (int i = 0; i < 3; ++i) {
    const double steps = reading.measured[i] / step;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    EXPECT_LE(std::abs(reading.measured[i] - x[i]), step / 2 * (1 + 1e-9));
  }
}

TEST(VirtualArm, OfThreeJointsIsTheSameWithFixedAndWithAnySize) {
  const ArmDescription description = random_arm(3, 134);
  Random random(135);
  const Eigen::VectorXd x = random.vector(3, 1), v = random.vector(3, 2);
  VirtualArm<3> fixed(description);
  AnyArm any(description);
  fixed.place(x, v, Vec3(0.1, 0, 0));
  any.place(x, v, Vec3(0.1, 0, 0));
  const Parameters p;
  for (int k = 0; k < 100; ++k) {
    const Eigen::VectorXd torque = random.vector(3, 0.1);
    fixed.live(p, torque, {Vec3(0.1, 0, 0), 0.5});
    any.live(p, torque, {Vec3(0.1, 0, 0), 0.5});
    ASSERT_LT((fixed.read(0).x - any.read(0).x).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace limpid
