// When a real device may push, against the limits it is given.
#include "core/loop/safety.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/random_arm.h"

namespace limpid {
namespace {

constexpr double T = 1e-3;
using Vector = Vec<kAnyDof>;

// An arm of two joints, well, armed and at rest; the tip moves as the joints do, in x and y.
struct SafeArm : testing::Test {
  SafeArm() {
    for (Joint& joint : arm.joints) joint.lower = -1, joint.upper = 1;
    safety = std::make_unique<Safety<kAnyDof>>(arm);
  }
  // So many ticks with all that the test has changed.
  ForceState judge(int ticks = 1) {
    for (int i = 0; i < ticks; ++i) safety->judge(health, wanted, diverged, x, v, J, put_out, T);
    return safety->state();
  }
  void expect_tripped(ForceState reason) {
    EXPECT_EQ(judge(), reason);
    EXPECT_EQ(safety->ceiling(), 0);
  }
  // Force stays off when what was wrong is over, until it is armed anew.
  void expect_stays_off(ForceState reason) {
    EXPECT_EQ(judge(10000), reason);
    EXPECT_FALSE(safety->allowed());
    safety->start();
    EXPECT_EQ(judge(), reason) << "a restart of the loop is no arming";
    wanted = false;
    EXPECT_EQ(judge(), ForceState::off);
    EXPECT_FALSE(safety->allowed());
    wanted = true;
    EXPECT_EQ(judge(), ForceState::on);
    EXPECT_EQ(safety->ceiling(), 1);
  }

  ArmDescription arm = test::random_arm(2, 1);
  std::unique_ptr<Safety<kAnyDof>> safety;
  DeviceHealth health{.real = true};
  bool wanted = true, diverged = false;
  Vector x = Vector::Zero(2), v = Vector::Zero(2);
  Jacobian<kAnyDof> J = Jacobian<kAnyDof>::Identity(3, 2);
  double put_out = 0;
};

TEST_F(SafeArm, MayPushWhenAllIsWell) {
  EXPECT_EQ(judge(), ForceState::on);
  EXPECT_EQ(safety->ceiling(), 1);
}

TEST_F(SafeArm, DoesNotPushUnlessArmed) {
  wanted = false;
  EXPECT_EQ(judge(), ForceState::off);
  EXPECT_FALSE(safety->allowed());
}

TEST_F(SafeArm, StaysOffAfterALoss) {
  health.lost = true;
  expect_tripped(ForceState::lost);
  health.lost = false;
  expect_stays_off(ForceState::lost);
}

TEST_F(SafeArm, StaysOffAfterAFault) {
  health.fault = true;
  expect_tripped(ForceState::fault);
  health.fault = false;
  expect_stays_off(ForceState::fault);
}

TEST_F(SafeArm, StaysOffAfterFiveMillisecondsWithoutAReading) {
  health.age = 0.0049;
  EXPECT_EQ(judge(), ForceState::on);
  health.age = 0.0051;
  expect_tripped(ForceState::stale);
  health.age = 0;
  expect_stays_off(ForceState::stale);
}

TEST_F(SafeArm, TakesAnAgeThatIsNoNumberForStale) {
  for (const double age : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    health.age = age;
    expect_tripped(ForceState::stale);
  }
}

TEST_F(SafeArm, StaysOffWhenTheLoopWasUnstable) {
  diverged = true;
  expect_tripped(ForceState::diverged);
  diverged = false;
  expect_stays_off(ForceState::diverged);
}

// One's own dead-man switch is no failure.
TEST_F(SafeArm, PushesAgainWhenTheHandIsBack) {
  health.hand = false;
  EXPECT_EQ(judge(), ForceState::no_hand);
  EXPECT_FALSE(safety->allowed());
  health.hand = true;
  EXPECT_EQ(judge(), ForceState::on);
}

TEST_F(SafeArm, FadesWithTheSpeedOfAJoint) {
  const double limit = safety->limits.joint_speed;
  J.setZero();
  v[1] = -0.99 * limit;
  judge(1000);
  EXPECT_EQ(safety->ceiling(), 1);
  v[1] = -1.25 * limit;  // halfway to 1.5
  EXPECT_EQ(judge(1000), ForceState::too_fast);
  EXPECT_NEAR(safety->ceiling(), 0.5, 1e-3);
  v[1] = 1.5 * limit;
  judge(1000);
  EXPECT_NEAR(safety->ceiling(), 0, 1e-3);
  v[1] = 0;
  EXPECT_EQ(judge(1000), ForceState::on) << "it comes back by itself";
}

TEST_F(SafeArm, FadesWithTheSpeedOfTheTip) {
  v = Vec3(0.6, 0.8, 0).head(2) * (1.25 * safety->limits.tip_speed);
  EXPECT_EQ(judge(1000), ForceState::too_fast);
  EXPECT_NEAR(safety->ceiling(), 0.5, 1e-3);
}

TEST_F(SafeArm, IsGoneAtASingleJumpFromEndToEnd) {
  v[0] = 2.0 / T;
  EXPECT_EQ(judge(), ForceState::too_fast);
  EXPECT_EQ(safety->ceiling(), 0);
}

TEST_F(SafeArm, FadesBeyondTheRangeOfAJoint) {
  const double overrun = safety->limits.overrun;
  for (const double side : {-1.0, 1.0}) {
    x[1] = side;
    EXPECT_EQ(judge(), ForceState::on);
    x[1] = side * (1 + overrun / 4);
    EXPECT_EQ(judge(), ForceState::too_far);
    EXPECT_NEAR(safety->ceiling(), 0.75, 1e-9);
    x[1] = side * (1 + 2 * overrun);
    judge();
    EXPECT_EQ(safety->ceiling(), 0);
  }
}

TEST_F(SafeArm, TripsWhenTheMotorsPutOutTooMuchEnergy) {
  put_out = safety->limits.energy / 2 * T;  // [J] a tick: half the limit in a second
  EXPECT_EQ(judge(5000), ForceState::on) << "it is forgotten within a second";
  put_out = 3 * safety->limits.energy * T;
  EXPECT_EQ(judge(3000), ForceState::energy);
  EXPECT_FALSE(safety->allowed());
  put_out = 0;
  expect_stays_off(ForceState::energy);
}

TEST_F(SafeArm, LetsTheHandPutEnergyIn) {
  put_out = -1;
  EXPECT_EQ(judge(1000), ForceState::on);
}

TEST_F(SafeArm, DoesNotJudgeAVirtualDevice) {
  health = {.real = false, .hand = false, .fault = true, .lost = true, .age = 1};
  v[0] = 1e6;
  x[0] = 1e6;
  EXPECT_EQ(judge(), ForceState::on);
  diverged = true;
  EXPECT_EQ(judge(), ForceState::diverged);
}

// tau = J^T F: the force is the torque where J is the identity.
TEST_F(SafeArm, KeepsTheForceAtTheTipWithinItsLimit) {
  const double limit = safety->limits.tip_force;
  const Vector direction = Vec3(0.6, -0.8, 0).head(2);
  EXPECT_EQ(safety->within_tip_force(0.9 * limit * direction, J), 0.9 * limit * direction);
  const Vector held = safety->within_tip_force(7 * limit * direction, J);
  EXPECT_NEAR((held - limit * direction).norm(), 0, 1e-6 * limit);
}

TEST_F(SafeArm, ScalesTheTorquesOfAnyArmByTheForceTheyMake) {
  test::Random random(7);
  for (int i = 0; i < 200; ++i) {
    const Vec3 force = 100 * Vec3(random.vector(3, 1));
    Eigen::Matrix3d square;
    for (int c = 0; c < 3; ++c) square.col(c) = Vec3(random.vector(3, 1));
    if (std::abs(square.determinant()) < 1e-2) continue;
    const Jacobian<kAnyDof> jacobian = square;
    const Vector tau = jacobian.transpose() * force;
    const double part = std::min(1.0, safety->limits.tip_force / force.norm());
    EXPECT_LT((safety->within_tip_force(tau, jacobian) - part * tau).norm(), 1e-3 * tau.norm());
  }
}

TEST(ForceState, IsExplainedInWords) {
  for (int i = 0; i <= static_cast<int>(ForceState::diverged); ++i) {
    EXPECT_STRNE(explain(static_cast<ForceState>(i)), "") << i;
  }
}

}  // namespace
}  // namespace limpid
