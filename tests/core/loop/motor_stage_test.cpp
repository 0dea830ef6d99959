#include "core/loop/motor_stage.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;
using Vector = Vec<kAnyDof>;
constexpr double T = 1e-3;
constexpr double kSlew = 0.1;  // from no torque to the limit [s]
constexpr double kFade = 0.5;  // from no force to full force [s]

Vector three(double a, double b, double c) { return Vec3(a, b, c); }

TEST(MotorStage, PassesWhatIsWithinTheLimitsAndClampsTheRest) {
  MotorStage<kAnyDof> motors(3);
  motors.start(true);
  const Vector limit = three(0.5, 0.6, 0.7);
  EXPECT_EQ(motors.pass(three(0.1, -0.6, 0.69), limit, true, T), three(0.1, -0.6, 0.69));
  EXPECT_EQ(motors.pass(three(9, -9, 0.7), limit, true, T), three(0.5, -0.6, 0.7));
}

TEST(MotorStage, NeverJumpsWhileACouplingIsBeingSwitched) {
  Random random(110);
  MotorStage<kAnyDof> motors(3);
  motors.start(true);
  const Vector limit = three(0.5, 0.6, 0.7);
  Vector before = motors.pass(three(0.5, -0.6, 0.1), limit, true, T);
  motors.begin_slew();
  EXPECT_FALSE(motors.steady(true));
  for (int k = 0; k < 400; ++k) {
    const Vector command = three(-0.4, 0.5, -0.6) + random.vector(3, 0.02);
    const Vector tau = motors.pass(command, limit, true, T);
    if (motors.steady(true)) break;
    const Vector step = (tau - before).cwiseAbs();
    ASSERT_TRUE((step.array() <= limit.array() * T / kSlew * (1 + 1e-9)).all()) << k;
    before = tau;
  }
}

TEST(MotorStage, ArrivesAtTheNewCommandAndFollowsItFromThenOn) {
  MotorStage<kAnyDof> motors(1);
  motors.start(true);
  const Vector limit = Vector::Constant(1, 0.5);
  motors.pass(Vector::Constant(1, 0.5), limit, true, T);
  motors.begin_slew();
  int ticks = 0;
  while (!motors.steady(true) && ticks < 1000) {
    motors.pass(Vector::Constant(1, -0.5), limit, true, T);
    ++ticks;
  }
  EXPECT_NEAR(ticks * T, 2 * kSlew, 2 * T);  // from limit to limit
  EXPECT_EQ(motors.pass(Vector::Constant(1, 0.5), limit, true, T)[0], 0.5);
}

TEST(MotorStage, IsZeroAtOnceWhenForceIsCut) {
  MotorStage<kAnyDof> motors(3);
  motors.start(true);
  const Vector limit = three(1, 1, 1), command = three(0.3, -0.4, 0.5);
  motors.pass(command, limit, true, T);
  EXPECT_EQ(motors.pass(command, limit, false, T).norm(), 0);
  EXPECT_TRUE(motors.steady(false));
  motors.pass(command, limit, true, T);
  motors.begin_slew();
  EXPECT_EQ(motors.pass(command, limit, false, T).norm(), 0);
}

TEST(MotorStage, FadesInAtAConstantRateWhenForceIsArmed) {
  MotorStage<kAnyDof> motors(1);
  motors.start(false);
  const Vector limit = Vector::Constant(1, 1), command = Vector::Constant(1, 0.8);
  for (int k = 1; k * T < kFade - T / 2; ++k) {
    ASSERT_NEAR(motors.pass(command, limit, true, T)[0], 0.8 * k * T / kFade, 1e-12);
    ASSERT_FALSE(motors.steady(true));
  }
  motors.pass(command, limit, true, T);
  motors.pass(command, limit, true, T);
  EXPECT_TRUE(motors.steady(true));
  EXPECT_EQ(motors.pass(command, limit, true, T)[0], 0.8);
}

TEST(MotorStage, GivesNoTorqueForACommandThatIsNotFinite) {
  const Vector limit = three(1, 1, 1);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), -std::nan("")}) {
    MotorStage<kAnyDof> motors(3);
    motors.start(true);
    EXPECT_EQ(motors.pass(three(0.1, bad, 0.2), limit, true, T), three(0, 0, 0));
    EXPECT_EQ(motors.pass(three(bad, 0.1, 0.2), limit, true, T), three(0, 0, 0));
  }
}

TEST(MotorStage, IsFiniteAndWithinLimitsWhateverComes) {
  Random random(111);
  MotorStage<kAnyDof> motors(3);
  motors.start(false);
  const Vector limit = three(0.5, 0.6, 0.7);
  for (int k = 0; k < 20000; ++k) {
    Vector command = random.vector(3, 3);
    const double dice = random.between(0, 100);
    if (dice < 1) command[1] = std::numeric_limits<double>::infinity();
    if (dice > 99) command[0] = std::numeric_limits<double>::quiet_NaN();
    if (dice > 40 && dice < 41) motors.begin_slew();
    const bool wanted = (k / 700) % 3 != 2;
    const Vector& tau = motors.pass(command, limit, wanted, T);
    ASSERT_TRUE(tau.allFinite());
    ASSERT_TRUE((tau.cwiseAbs().array() <= limit.array()).all());
  }
}

}  // namespace
}  // namespace limpid
