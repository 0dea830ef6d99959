#include "core/tick/motor_stage.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/random_arm.h"
#include "tests/support/tick.h"

namespace limpid {
namespace {

using test::Random;
using Vector = Vec<kAnyDof>;
using test::T;
constexpr double kSlew = 0.1;  // time from no torque to the limit [s]

Vector three(double a, double b, double c) { return Vec3(a, b, c); }

TEST(MotorStage, PassesWhatIsWithinTheLimitsAndClampsTheRest) {
  MotorStage<kAnyDof> motors(3);
  const Vector limit = three(0.5, 0.6, 0.7);
  EXPECT_EQ(motors.pass(three(0.1, -0.6, 0.69), limit, 1, T), three(0.1, -0.6, 0.69));
  EXPECT_EQ(motors.pass(three(9, -9, 0.7), limit, 1, T), three(0.5, -0.6, 0.7));
  EXPECT_EQ(motors.pass(three(0.4, -0.2, 0.8), limit, 0.25, T), three(0.1, -0.05, 0.175));
}

TEST(MotorStage, NeverJumpsWhileACouplingIsBeingSwitched) {
  Random random(110);
  MotorStage<kAnyDof> motors(3);
  const Vector limit = three(0.5, 0.6, 0.7);
  Vector before = motors.pass(three(0.5, -0.6, 0.1), limit, 1, T);
  motors.begin_slew();
  EXPECT_FALSE(motors.steady());
  for (int k = 0; k < 400; ++k) {
    const Vector command = three(-0.4, 0.5, -0.6) + random.vector(3, 0.02);
    const Vector tau = motors.pass(command, limit, 1, T);
    if (motors.steady()) break;
    const Vector step = (tau - before).cwiseAbs();
    ASSERT_TRUE((step.array() <= limit.array() * T / kSlew * (1 + 1e-9)).all()) << k;
    before = tau;
  }
}

TEST(MotorStage, BoundsTheRateBesideAJointWithoutAMotor) {
  MotorStage<kAnyDof> motors(3);
  const Vector limit = three(0, 0.6, 0.7);
  double before = 0;
  for (int k = 0; k < 10; ++k) {
    const Vector tau = motors.pass(three(1, 0.6, 0), limit, 1, T, kSlew);
    EXPECT_EQ(tau[0], 0);
    EXPECT_NEAR(tau[1] - before, limit[1] * T / kSlew, 1e-12) << k;
    before = tau[1];
  }
}

TEST(MotorStage, ArrivesAtTheNewCommandAndFollowsItFromThenOn) {
  MotorStage<kAnyDof> motors(1);
  const Vector limit = Vector::Constant(1, 0.5);
  motors.pass(Vector::Constant(1, 0.5), limit, 1, T);
  motors.begin_slew();
  int ticks = 0;
  while (!motors.steady() && ticks < 1000) {
    motors.pass(Vector::Constant(1, -0.5), limit, 1, T);
    ++ticks;
  }
  EXPECT_NEAR(ticks * T, 2 * kSlew, 2 * T);  // from limit to limit
  EXPECT_EQ(motors.pass(Vector::Constant(1, 0.5), limit, 1, T)[0], 0.5);
}

// The command of a loop that oscillates swings faster than the motors follow at that rate.
TEST(MotorStage, EndsItsSlewWhereTheCommandIsNeverMet) {
  MotorStage<kAnyDof> motors(1);
  const Vector limit = Vector::Constant(1, 0.5);
  motors.pass(Vector::Zero(1), limit, 1, T);
  motors.begin_slew();
  int ticks = 0;
  for (; !motors.steady() && ticks < 1000; ++ticks) {
    motors.pass(Vector::Constant(1, ticks % 20 < 10 ? 0.5 : -0.5), limit, 1, T);
  }
  EXPECT_NEAR(ticks * T, 2 * kSlew, 2 * T) << "as long as from limit to limit";
  EXPECT_EQ(motors.pass(Vector::Constant(1, 0.5), limit, 1, T)[0], 0.5);
  motors.begin_slew();
  EXPECT_GT(motors.pass(Vector::Constant(1, -0.5), limit, 1, T)[0], 0.4) << "and begins anew";
}

// 0.1 s from no torque to the limit: the joint with the longer way takes 90 ms, and no joint jumps.
TEST(MotorStage, SlewsUntilTheLastJointHasArrived) {
  MotorStage<kAnyDof> motors(3);
  const Vector limit = three(0.5, 0.5, 0.5);
  motors.pass(three(0.1, 0.4, 0), limit, 1, T);
  motors.begin_slew();
  Vector before = three(0.1, 0.4, 0);
  int ticks = 0;
  for (; !motors.steady() && ticks < 1000; ++ticks) {
    const Vector tau = motors.pass(three(0.1, -0.05, 0.2), limit, 1, T);
    ASSERT_LE((tau - before).cwiseAbs().maxCoeff(), 0.5 * T / kSlew * (1 + 1e-9)) << ticks;
    before = tau;
  }
  EXPECT_NEAR(ticks * T, 0.09, 1.5 * T);
  EXPECT_EQ(before, three(0.1, -0.05, 0.2));
}

TEST(MotorStage, ObeysALimitThatIsLoweredAtOnce) {
  MotorStage<kAnyDof> motors(2);
  const Vector before = Vector::Constant(2, 0.5), lower = Vector::Constant(2, 0.1);
  for (int k = 0; k < 100; ++k) motors.pass(before, before, 1, T, 0.02);
  EXPECT_LE(motors.pass(-before, lower, 1, T, 0.02).cwiseAbs().maxCoeff(), 0.1);
}

TEST(MotorStage, IsZeroAtOnceWhenForceIsCutAndHasForgottenItsSlewThen) {
  MotorStage<kAnyDof> motors(3);
  const Vector limit = three(1, 1, 1), command = three(0.3, -0.4, 0.5);
  motors.pass(command, limit, 1, T);
  motors.begin_slew();
  motors.pass(-command, limit, 1, T);
  EXPECT_EQ(motors.pass(command, limit, 0, T).norm(), 0);
  EXPECT_TRUE(motors.steady());
  EXPECT_EQ(motors.pass(command, limit, 0.5, T), 0.5 * command);
}

// The rate holds in wall time: a tick that comes a tenth of a period after the last one may move
// the torque by a tenth of a step.
TEST(MotorStage, BoundsTheRateOfRealMotorsInTheTimeThatPassed) {
  Random random(112);
  MotorStage<kAnyDof> motors(2);
  Vector limit(2), before = Vector::Zero(2);
  limit << 0.5, 2;
  for (int k = 0; k < 20000; ++k) {
    const double dt = random.between(1e-5, T);
    const Vector command = random.vector(2, 3);
    const Vector tau = motors.pass(command, limit, 1, dt, 0.02);
    for (int i = 0; i < 2; ++i) {
      const bool on = tau[i] * before[i] > 0;  // else it has gone through zero
      const double growth = std::abs(tau[i]) - (on ? std::abs(before[i]) : 0);
      ASSERT_LE(growth, limit[i] * dt / 0.02 + 1e-12) << k;
    }
    before = tau;
  }
}

// Torque that goes on after the command has gone gives the hand energy that no law has counted.
TEST(MotorStage, LetsTheTorqueOfRealMotorsFallAtOnce) {
  MotorStage<kAnyDof> motors(3);
  const Vector limit = three(1, 1, 1);
  for (int k = 0; k < 100; ++k) motors.pass(three(0.5, -0.5, 0.5), limit, 1, T, 0.02);
  const Vector lower = three(0.1, -0.4, 0);
  EXPECT_EQ(motors.pass(lower, limit, 1, T, 0.02), lower);
  const Vector turned = motors.pass(three(-0.5, -0.4, 0), limit, 1, T, 0.02);
  EXPECT_NEAR(turned[0], -T / 0.02, 1e-12) << "through zero, then at the bounded rate";
}

// A torque that falls at one joint alone may need more force at the tip.
TEST(MotorStage, KeepsTheTipsLimitWhileOneJointFalls) {
  Random random(113);
  const Vector joints = three(1, 1, 1);
  for (int round = 0; round < 2000; ++round) {
    Jacobian<kAnyDof> J(3, 3);
    for (int i = 0; i < 3; ++i) J.row(i) = random.vector(3, 0.2).transpose();
    const TorqueLimits<kAnyDof> limits(joints, J, 2);
    MotorStage<kAnyDof> motors(3);
    for (int k = 0; k < 40; ++k) {
      const Vector tau = motors.pass(random.vector(3, 1), limits, 1, T, 0.02);
      ASSERT_LE(tip_force<kAnyDof>(tau, J), 2 * (1 + 1e-9)) << round;
    }
  }
}

TEST(MotorStage, SwitchesACouplingOfRealMotorsAsSlowlyAsOfOthers) {
  MotorStage<kAnyDof> motors(3);
  const Vector limit = three(1, 1, 1), command = three(0.5, 0.5, 0.5);
  for (int k = 0; k < 100; ++k) motors.pass(command, limit, 1, T, 0.02);
  motors.begin_slew();
  const Vector tau = motors.pass(-command, limit, 1, T, 0.02);
  EXPECT_LE((tau - command).cwiseAbs().maxCoeff(), T / kSlew + 1e-12);
}

TEST(MotorStage, GivesNoTorqueForACommandThatIsNotFinite) {
  const Vector limit = three(1, 1, 1);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), -std::nan("")}) {
    MotorStage<kAnyDof> motors(3);
    EXPECT_EQ(motors.pass(three(0.1, bad, 0.2), limit, 1, T), three(0, 0, 0));
    EXPECT_EQ(motors.pass(three(bad, 0.1, 0.2), limit, 1, T), three(0, 0, 0));
    EXPECT_EQ(motors.pass(three(0.1, 0.1, 0.2), limit, bad, T), three(0, 0, 0));
  }
}

TEST(MotorStage, IsFiniteAndWithinLimitsWhateverComes) {
  Random random(111);
  MotorStage<kAnyDof> motors(3);
  const Vector limit = three(0.5, 0.6, 0.7);
  for (int k = 0; k < 20000; ++k) {
    Vector command = random.vector(3, 3);
    const double dice = random.between(0, 100);
    if (dice < 1) command[1] = std::numeric_limits<double>::infinity();
    if (dice > 99) command[0] = std::numeric_limits<double>::quiet_NaN();
    if (dice > 40 && dice < 41) motors.begin_slew();
    const Vector& tau = motors.pass(command, limit, (k / 700) % 3 != 2 ? 1 : 0, T);
    ASSERT_TRUE(tau.allFinite());
    ASSERT_TRUE((tau.cwiseAbs().array() <= limit.array()).all());
  }
}

}  // namespace
}  // namespace limpid
