// Warmth of the motors against closed forms: c is the torque that a motor bears for hours, p its
// peak, t its time constant.
#include "core/tick/motor_warmth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/random_arm.h"
#include "tests/support/tick.h"

namespace limpid {
namespace {

using test::T;
using Vector = Vec<kAnyDof>;

constexpr double kPeak = 0.64, kContinuous = 0.17, kTime = 60;  // [N m, s]

// The first motor's continuous torque is known, the second one's is not.
ArmDescription two_motors() {
  ArmDescription arm = test::random_arm(2, 5);
  for (Joint& joint : arm.joints) joint.effort = kPeak;
  arm.joints[0].continuous = kContinuous;
  arm.joints[0].warming = kTime;
  return arm;
}

struct WarmMotors : testing::Test {
  WarmMotors() : warmth(two_motors()) {}
  double first() const { return warmth.modelled()[0]; }
  Vector limits() const {
    Vector limits = Vector::Constant(2, kPeak);
    warmth.limit(limits);
    return limits;
  }
  // Holds a torque tick by tick [N m, s].
  void hold(double torque, double time) {
    for (double t = 0; t < time - T / 2; t += T) warmth.hold(Vector::Constant(2, torque), T);
  }
  // Holds all that the limit leaves until the motor is so warm; returns how long it took [s].
  double hold_limit_until(double goal) {
    double t = 0;
    for (; first() < goal && t < 100 * kTime; t += T) warmth.hold(limits(), T);
    return t;
  }

  MotorWarmth<kAnyDof> warmth;
};

TEST_F(WarmMotors, WarmUpExponentiallyByTheSquareOfTheirTorque) {
  const double goal = std::pow(kPeak / kContinuous, 2);
  for (double t = 0.5; t <= 4; t += 0.5) {
    hold(-kPeak, 0.5);
    EXPECT_NEAR(first(), goal * (1 - std::exp(-t / kTime)), 1e-9) << t;
  }
  // The time until it is as warm as it may be is -t ln(1 - (c/p)^2), 4.4 s here.
  warmth.start({});
  hold(kPeak, -kTime * std::log(1 - 1 / goal));
  EXPECT_NEAR(first(), 1, goal * T / kTime);
}

TEST_F(WarmMotors, GiveTheirPeakUntilTheyAreHalfAsWarmAsTheyMayBe) {
  const double goal = std::pow(kPeak / kContinuous, 2);
  EXPECT_NEAR(hold_limit_until(kWarmFrom), -kTime * std::log(1 - kWarmFrom / goal), 2 * T);
  EXPECT_NEAR(limits()[0], kPeak, 1e-3);
}

// The square of the limit falls with the warmth in a straight line, so the warmth nears 1 with the
// time constant t / (1 + ((p/c)^2 - 1) / (1 - kWarmFrom)).
TEST_F(WarmMotors, NearTheTorqueThatTheyBearForHoursAtTheirLimit) {
  hold_limit_until(kWarmFrom);
  const double before = 1 - first();
  const double faster = 1 + (std::pow(kPeak / kContinuous, 2) - 1) / (1 - kWarmFrom);
  const double time = 3 * kTime / faster;
  for (double t = 0; t < time - T / 2; t += T) warmth.hold(limits(), T);
  EXPECT_NEAR((1 - first()) / before, std::exp(-3), 1e-4);
  for (int k = 0; k < 100'000; ++k) {
    ASSERT_LE(first(), 1);
    ASSERT_GE(limits()[0], kContinuous);
    warmth.hold(limits(), T);
  }
  EXPECT_NEAR(limits()[0], kContinuous, 1e-6);
}

TEST_F(WarmMotors, AreNeverHeldBackAtTheTorqueThatTheyBearForHours) {
  for (int hour = 0; hour < 3600; ++hour) {
    warmth.hold(Vector::Constant(2, kContinuous), 1);
    ASSERT_GE(limits()[0], kContinuous) << hour;
  }
  EXPECT_NEAR(first(), 1, 1e-12);
}

TEST_F(WarmMotors, CoolExponentiallyInStepsOfAnyLength) {
  const std::vector<double> hot{1, 1};
  warmth.start(hot);
  hold(0, 30);
  EXPECT_NEAR(first(), std::exp(-0.5), 1e-9);
  warmth.hold(Vector::Zero(2), 90);
  EXPECT_NEAR(first(), std::exp(-2), 1e-9);
}

TEST_F(WarmMotors, OfWhichNothingIsKnownStayAtTheirPeak) {
  hold(kPeak, 30);
  EXPECT_GT(first(), 1);
  EXPECT_EQ(warmth.modelled()[1], 0);
  EXPECT_EQ(limits()[1], kPeak);
  warmth.report(1);
  EXPECT_EQ(limits()[1], kPeak);
  EXPECT_EQ(warmth.known()[1], 1) << "though the device tells of it";
}

TEST_F(WarmMotors, AreAtLeastAsWarmAsTheDeviceSays) {
  const std::vector<double> some{0.6};
  warmth.start(some);
  const double alone = limits()[0];
  warmth.report(0.55);
  EXPECT_EQ(limits()[0], alone);
  warmth.report(1);
  EXPECT_NEAR(limits()[0], kContinuous, 1e-12);
  EXPECT_EQ(warmth.known()[0], 1);
  EXPECT_EQ(first(), 0.6) << "the model goes on by itself";
  warmth.report(0);
  EXPECT_EQ(limits()[0], alone);
}

TEST_F(WarmMotors, BeginColdWhereNoNumberSaysOtherwise) {
  for (const double wrong : {std::nan(""), -1.0, 0.0}) {
    const std::vector<double> start{wrong, 0.5};
    warmth.start(start);
    EXPECT_EQ(first(), 0);
    EXPECT_EQ(warmth.modelled()[1], 0) << "of this motor nothing is known";
  }
  const std::vector<double> hot{std::numeric_limits<double>::infinity()};
  warmth.start(hot);
  EXPECT_EQ(first(), 1);
  warmth.hold(Vector::Constant(2, std::nan("")), T);
  EXPECT_EQ(first(), 1);
}

TEST(WarmLimit, LeavesALimitThatIsBelowTheContinuousOne) {
  EXPECT_EQ(warm_limit(0.1, kContinuous, 1), 0.1);
  EXPECT_EQ(warm_limit(kPeak, 0, 1), kPeak);
  EXPECT_NEAR(warm_limit(kPeak, kContinuous, 7), kContinuous, 1e-15);
}

}  // namespace
}  // namespace limpid
