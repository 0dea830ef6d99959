// Reasons against force on a guarded device, at the limits it is given.
#include "core/tick/safety.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/random_arm.h"
#include "tests/support/tick.h"

namespace limpid {
namespace {

using test::T;
using Vector = Vec<kAnyDof>;

// An arm of two joints, healthy, armed and at rest; the tip moves as the joints do, in x and y.
struct SafeArm : testing::Test {
  SafeArm() {
    for (Joint& joint : arm.joints) joint.lower = -1, joint.upper = 1;
    safety = std::make_unique<Safety<kAnyDof>>(arm);
  }
  // Judges so many ticks with the test's values; returns the reason against force.
  ForceState judge(int ticks = 1) {
    for (int i = 0; i < ticks; ++i)
      against = safety->judge(health, diverged, {x, v, J, tau, put_out, T});
    return against.fault != ForceState::on ? against.fault : against.limited;
  }
  void expect_trips(ForceState reason) {
    judge();
    EXPECT_EQ(against.fault, reason);
  }

  ArmDescription arm = test::random_arm(2, 1);
  std::unique_ptr<Safety<kAnyDof>> safety;
  DeviceHealth health{.guarded = true};
  bool diverged = false;
  Vector x = Vector::Zero(2), v = Vector::Zero(2), tau = Vector::Zero(2);
  Jacobian<kAnyDof> J = Jacobian<kAnyDof>::Identity(3, 2);
  double put_out = 0;
  Objections against;
};

TEST_F(SafeArm, MayPushWhenAllIsWell) {
  EXPECT_EQ(judge(), ForceState::on);
  EXPECT_EQ(against.ceiling, 1);
  EXPECT_TRUE(against.hand);
  EXPECT_FALSE(against.gap);
}

TEST_F(SafeArm, TripsAtALoss) {
  health.lost = true;
  expect_trips(ForceState::lost);
}

TEST_F(SafeArm, TripsAtAFault) {
  health.fault = true;
  expect_trips(ForceState::fault);
}

TEST_F(SafeArm, TripsAfterFiveMillisecondsWithoutAReading) {
  health.age = 0.0049;
  EXPECT_EQ(judge(), ForceState::on);
  health.age = 0.0051;
  expect_trips(ForceState::stale);
}

TEST_F(SafeArm, TakesAnAgeThatIsNoNumberForStale) {
  for (const double age : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    health.age = age;
    expect_trips(ForceState::stale);
  }
}

TEST_F(SafeArm, TripsWhenTheLoopWasUnstable) {
  diverged = true;
  expect_trips(ForceState::diverged);
}

TEST_F(SafeArm, PassesOnWhetherTheHandIsThereAndTheDeviceWasWithoutTorque) {
  health.hand = false;
  health.gap = true;
  judge();
  EXPECT_FALSE(against.hand);
  EXPECT_TRUE(against.gap);
  EXPECT_EQ(against.fault, ForceState::on);
}

TEST_F(SafeArm, FadesWithTheSpeedOfAJoint) {
  J.setZero();
  v[1] = -14.8;
  judge(1000);
  EXPECT_EQ(against.ceiling, 1);
  v[1] = -18.75;  // halfway from 15 to 22.5 rad/s
  EXPECT_EQ(judge(1000), ForceState::too_fast);
  EXPECT_NEAR(against.ceiling, 0.5, 1e-3);
  v[1] = 22.5;
  judge(1000);
  EXPECT_NEAR(against.ceiling, 0, 1e-3);
  v[1] = 0;
  EXPECT_EQ(judge(1000), ForceState::on) << "it comes back by itself";
}

TEST_F(SafeArm, HasNoForceAtASpeedThatIsNoNumber) {
  v.setConstant(std::nan(""));
  EXPECT_EQ(judge(), ForceState::too_fast);
  EXPECT_EQ(against.ceiling, 0);
}

TEST_F(SafeArm, FadesWithTheSpeedOfTheTip) {
  v = Vec3(0.6, 0.8, 0).head(2) * 2.5;  // halfway from 2 to 3 m/s
  EXPECT_EQ(judge(1000), ForceState::too_fast);
  EXPECT_NEAR(against.ceiling, 0.5, 1e-3);
  EXPECT_EQ(against.fault, ForceState::on);
}

TEST_F(SafeArm, IsGoneAtASingleJumpFromEndToEnd) {
  v[0] = 2.0 / T;
  EXPECT_EQ(judge(), ForceState::too_fast);
  EXPECT_EQ(against.ceiling, 0);
}

TEST_F(SafeArm, FadesBeyondTheRangeOfAJoint) {
  for (const double side : {-1.0, 1.0}) {
    x[1] = side;
    EXPECT_EQ(judge(), ForceState::on);
    x[1] = side * 1.025;  // 0.025 of 0.1 rad beyond
    EXPECT_EQ(judge(), ForceState::too_far);
    EXPECT_NEAR(against.ceiling, 0.75, 1e-9);
    x[1] = side * 1.2;
    judge();
    EXPECT_EQ(against.ceiling, 0);
  }
}

TEST_F(SafeArm, TripsWhenTheMotorsPutOutTooMuchEnergy) {
  put_out = 0.75 * T;  // [J] a tick: half the limit in a second
  EXPECT_EQ(judge(5000), ForceState::on) << "it is forgotten within a second";
  put_out = 1.8 * T;
  EXPECT_EQ(judge(5000), ForceState::energy);
  EXPECT_NEAR(against.ceiling, 0.6, 0.01);  // 1.8 J on the way from 1.5 to 2.25
  EXPECT_EQ(against.fault, ForceState::on);
  put_out = 2.3 * T;
  judge(5000);
  EXPECT_EQ(against.fault, ForceState::energy);
}

TEST_F(SafeArm, LetsTheHandPutEnergyIn) {
  put_out = -1;
  EXPECT_EQ(judge(1000), ForceState::on);
}

TEST_F(SafeArm, FadesWhenTheWindowIsSilentAndThenTrips) {
  health.silence = 0.199;
  EXPECT_EQ(judge(), ForceState::on);
  health.silence = 0.3;  // halfway from 0.2 to 0.4 s
  EXPECT_EQ(judge(), ForceState::unwatched);
  EXPECT_NEAR(against.ceiling, 0.5, 1e-9);
  EXPECT_EQ(against.fault, ForceState::on);
  health.silence = 0.4;
  expect_trips(ForceState::unwatched);
}

TEST_F(SafeArm, WaitsForAReadingRightAfterAGap) {
  health.age = 0.1;
  health.gap = true;
  EXPECT_EQ(judge(), ForceState::on);
  EXPECT_FALSE(against.hand) << "nothing to push by yet";
  health.gap = false;
  expect_trips(ForceState::stale);
}

TEST_F(SafeArm, ForgetsItsOldSpeedAtAGap) {
  v[0] = 1000;
  judge(100);
  v[0] = 0;
  health.gap = true;
  EXPECT_EQ(judge(), ForceState::on);
}

TEST_F(SafeArm, ForgetsSpeedAndEnergyWhenItStarts) {
  v[0] = 1000;
  put_out = 2.3 * T;
  expect_trips(ForceState::on);
  judge(5000);
  EXPECT_EQ(against.fault, ForceState::energy);
  safety->start();
  v[0] = put_out = 0;
  EXPECT_EQ(judge(), ForceState::on);
  EXPECT_EQ(against.ceiling, 1);
}

TEST_F(SafeArm, IsHeldBackByTheStrictestOfItsLimits) {
  J.setZero();
  v[0] = 21;           // between 15 and 22.5 rad/s: a fifth is left
  put_out = 1.65 * T;  // between 1.5 and 2.25 J: four fifths are left
  EXPECT_EQ(judge(5000), ForceState::too_fast);
  EXPECT_NEAR(against.ceiling, 0.2, 1e-3);
}

TEST_F(SafeArm, HoldsOneJointToItsRangeBesideAnotherWithoutAny) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  for (const int free : {0, 1}) {
    ArmDescription half = arm;
    half.joints[static_cast<std::size_t>(free)].lower = -kNone;
    half.joints[static_cast<std::size_t>(free)].upper = kNone;
    safety = std::make_unique<Safety<kAnyDof>>(half);
    safety->limit({.range = 0.5});
    for (const double beyond : {-0.55, 0.55}) {  // halfway from 0.5 to 0.6 rad
      x.setZero();
      x[1 - free] = beyond;
      EXPECT_EQ(judge(), ForceState::too_far) << free;
      EXPECT_NEAR(against.ceiling, 0.5, 1e-9);
    }
    x[1 - free] = 0;
    x[free] = 1000;
    EXPECT_EQ(judge(), ForceState::on) << free;
  }
}

TEST_F(SafeArm, DoesNotJudgeADeviceThatIsNotGuarded) {
  health = {.guarded = false, .hand = false, .fault = true, .lost = true, .age = 1, .silence = 9};
  v[0] = 1e6;
  x[0] = 1e6;
  EXPECT_EQ(judge(), ForceState::on);
  EXPECT_TRUE(against.hand);
  diverged = true;
  EXPECT_EQ(judge(), ForceState::diverged);
}

TEST_F(SafeArm, CanBeHeldToLowerLimits) {
  safety->limit({.joint_speed = 3, .tip_speed = 0.4, .tip_force = 2, .energy = 0.3, .range = 0.5});
  v[1] = -0.5;
  EXPECT_EQ(judge(1000), ForceState::too_fast);
  EXPECT_NEAR(against.ceiling, 0.5, 1e-3);  // halfway from 0.4 to 0.6 m/s
  J.setZero();
  v[1] = 3.75;
  judge(1000);
  EXPECT_NEAR(against.ceiling, 0.5, 1e-3);  // halfway from 3 to 4.5 rad/s
  v[1] = 0;
  x[0] = -0.55;  // halfway from 0.5 to 0.6 rad
  EXPECT_EQ(judge(1000), ForceState::too_far);
  EXPECT_NEAR(against.ceiling, 0.5, 1e-9);
  x[0] = 0.49;
  EXPECT_EQ(judge(), ForceState::on);
  put_out = 0.36 * T;
  EXPECT_EQ(judge(5000), ForceState::energy);
  EXPECT_EQ(safety->tip_force(), 2);
}

TEST_F(SafeArm, CannotBeHeldToHigherLimitsThanItsOwn) {
  constexpr double kMost = std::numeric_limits<double>::max();
  for (const double bad : {kMost, std::numeric_limits<double>::infinity(), std::nan("")}) {
    const SafetyLimits least = allowed({bad, bad, bad, bad, bad});
    EXPECT_EQ(least.joint_speed, 15);
    EXPECT_EQ(least.tip_speed, 2);
    EXPECT_EQ(least.tip_force, 10);
    EXPECT_EQ(least.energy, 1.5);
    EXPECT_EQ(least.range, 1);
    safety->limit({bad, bad, bad, bad, bad});
    v[1] = 2.5;
    judge(1000);
    EXPECT_NEAR(against.ceiling, 0.5, 1e-3);
  }
  EXPECT_GT(allowed({-1, -1, -1, -1, -1}).tip_force, 0);
}

// An arm that pushes with 0.2 N m of 0.4 to 0.8 unless the test changes that; its readings stand
// still.
struct SafeArmThatPushes : SafeArm {
  SafeArmThatPushes() { tau = Vec3(0.2, -0.1, 0).head(2); }
};

TEST_F(SafeArmThatPushes, FadesAndTripsWhereNoReadingMovesForThreeTenthsOfASecond) {
  EXPECT_EQ(judge(299), ForceState::on);
  EXPECT_EQ(against.ceiling, 1);
  EXPECT_EQ(judge(151), ForceState::frozen);
  EXPECT_NEAR(against.ceiling, 0.5, 1e-6);  // halfway from 0.3 to 0.6 s
  EXPECT_EQ(against.fault, ForceState::on);
  judge(149);
  EXPECT_NEAR(against.ceiling, 1.0 / 300, 1e-6);
  EXPECT_EQ(against.fault, ForceState::on);
  judge(2);
  EXPECT_EQ(against.ceiling, 0);
  EXPECT_EQ(against.fault, ForceState::frozen);
}

TEST_F(SafeArmThatPushes, HasItsForceBackAsSoonAsAnyReadingMovesByTheLeast) {
  for (const int joint : {0, 1}) {
    judge(500);
    EXPECT_EQ(against.limited, ForceState::frozen);
    x[joint] = std::nextafter(x[joint], 1);
    EXPECT_EQ(judge(300), ForceState::on) << joint;
    EXPECT_EQ(against.ceiling, 1);
    x[joint] = std::nextafter(x[joint], 1);
    judge();
  }
}

// The fade goes on at small torques; otherwise the force would come back.
TEST_F(SafeArmThatPushes, FadesOnWhenTheTorqueHasBecomeSmall) {
  judge(350);
  tau.setZero();
  judge(250);
  EXPECT_EQ(against.fault, ForceState::frozen);
}

TEST_F(SafeArmThatPushes, StaysWithoutForceUntilSomethingHasMoved) {
  judge(600);
  tau.setZero();
  EXPECT_EQ(judge(5000), ForceState::frozen);
  health.gap = true;
  judge();
  health.gap = false;
  EXPECT_EQ(judge(), ForceState::frozen) << "a stall is no sign of life";
  x[1] += 1e-6;
  EXPECT_EQ(judge(), ForceState::on);
}

TEST_F(SafeArmThatPushes, CountsTheTimeInWhichItPushesAlone) {
  for (int k = 0; k < 299; ++k) {
    tau[0] = 0.2;
    EXPECT_EQ(judge(), ForceState::on) << k;
    tau[0] = 0;
    tau[1] = 0;
    EXPECT_EQ(judge(), ForceState::on) << k;
  }
  tau[0] = -0.2;
  EXPECT_EQ(judge(10), ForceState::frozen);
}

TEST_F(SafeArmThatPushes, MayStandStillForEverWithLittleTorque) {
  tau = 0.04 * of_joints<kAnyDof>(arm, &Joint::effort);
  EXPECT_EQ(judge(20000), ForceState::on);
}

// 5 % of its 20 N m would be 10 N at a tenth of a metre.
TEST_F(SafeArmThatPushes, JudgesStrongMotorsByTheForceAtTheTip) {
  for (Joint& joint : arm.joints) joint.effort = 20;
  safety = std::make_unique<Safety<kAnyDof>>(arm);
  J *= 0.1;
  tau = Vec3(0, 0.04, 0).head(2);  // 0.4 N
  EXPECT_EQ(judge(5000), ForceState::on);
  tau = Vec3(0, 0.06, 0).head(2);  // 0.6 N
  EXPECT_EQ(judge(400), ForceState::frozen);
}

TEST_F(SafeArmThatPushes, IsNotJudgedWhereItIsNotGuarded) {
  health.guarded = false;
  EXPECT_EQ(judge(5000), ForceState::on);
}

TEST_F(SafeArmThatPushes, StandsStillAlsoAfterAnotherStart) {
  judge(600);
  EXPECT_EQ(against.fault, ForceState::frozen);
  safety->start();
  judge();
  EXPECT_EQ(against.fault, ForceState::frozen) << "nothing has moved";
}

TEST(ForceState, IsExplainedInWords) {
  for (int i = 0; i <= static_cast<int>(ForceState::wrong); ++i) {
    EXPECT_STRNE(explain(static_cast<ForceState>(i)), "") << i;
  }
}

}  // namespace
}  // namespace limpid
