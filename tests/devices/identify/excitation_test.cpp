// Ends of the motion, and no torque from then on.
#include "devices/identify/excitation.h"

#include <gtest/gtest.h>

#include <limits>
#include <optional>

#include "devices/identify/unlike_device.h"
#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

class AnExcitation : public testing::Test {
 protected:
  // Makes one tick; returns its torque.
  Eigen::VectorXd step(const DeviceHealth& health = {.guarded = true}) {
    const DeviceReading now = reading();
    const auto sent = motion_.step({std::span(now.x).first(3), 0.001, health});
    device_.write(sent);
    return Eigen::Map<const Eigen::VectorXd>(sent.data(), 3);
  }
  DeviceReading reading() {
    DeviceReading now;
    device_.read(now);
    return now;
  }
  void run(double seconds) {
    for (int i = 0; i < 1000 * seconds && motion_.end() == ExcitationEnd::running; ++i) step();
  }
  void expect_nothing_leaves_after(ExcitationEnd end) {
    EXPECT_EQ(motion_.end(), end) << explain(motion_.end());
    for (int i = 0; i < 100; ++i) EXPECT_EQ(step().norm(), 0);
    EXPECT_EQ(motion_.end(), end);
  }

  ArmDescription arm_ = test::omni();
  UnlikeDevice device_{arm_, {.gravity = Vec3(0, 0, -9.81), .encoder_step = 1e-4}};
  ExcitationPlan plan_{};
  Excitation motion_{arm_, device_.traits(), plan_};
};

TEST_F(AnExcitation, StaysWithinItsPartOfTheMotorsAndTheRange) {
  Eigen::VectorXd last = Eigen::VectorXd::Zero(3);
  while (motion_.end() == ExcitationEnd::running) {
    const Eigen::VectorXd torque = step();
    const DeviceReading now = reading();
    for (Eigen::Index j = 0; j < 3; ++j) {
      const Joint& joint = arm_.joints[static_cast<std::size_t>(j)];
      ASSERT_LE(std::abs(torque[j]), plan_.torque * joint.effort * (1 + 1e-12));
      const bool turned = torque[j] * last[j] < 0;
      ASSERT_LE(std::abs(torque[j]) - (turned ? 0 : std::abs(last[j])),
                plan_.torque * joint.effort * 0.001 / SafetyLimits::kSlew * (1 + 1e-9));
      ASSERT_GT(now.x[static_cast<std::size_t>(j)], joint.lower);
      ASSERT_LT(now.x[static_cast<std::size_t>(j)], joint.upper);
    }
    last = torque;
  }
  expect_nothing_leaves_after(ExcitationEnd::complete);
  EXPECT_NEAR(motion_.time(), motion_.duration(), 0.002);
}

TEST_F(AnExcitation, FadesIn) {
  EXPECT_EQ(motion_.stage(), ExcitationStage::approach);
  for (int i = 0; i < 100; ++i) {
    const double part = 0.001 * (i + 1) / ForceGate::kFade;
    EXPECT_LE(step().cwiseAbs().maxCoeff(), part * plan_.torque * arm_.joints[0].effort + 1e-12);
  }
}

TEST_F(AnExcitation, EndsWhenItIsCancelled) {
  run(4);
  motion_.cancel();
  expect_nothing_leaves_after(ExcitationEnd::cancelled);
}

TEST_F(AnExcitation, EndsWhenTheDeviceFallsSilent) {
  run(4);
  EXPECT_EQ(step({.guarded = true, .age = 0.006}).norm(), 0);
  expect_nothing_leaves_after(ExcitationEnd::not_well);
}

TEST_F(AnExcitation, EndsWhenTheDeviceIsLostOrAtFaultOrTheLoopStoodStill) {
  for (const DeviceHealth& health :
       {DeviceHealth{.guarded = true, .lost = true}, DeviceHealth{.guarded = true, .fault = true},
        DeviceHealth{.guarded = true, .gap = true}}) {
    UnlikeDevice device(arm_, {});
    Excitation motion(arm_, device.traits(), plan_);
    const std::array<double, 3> x{0, -0.5, 1.5};
    for (int i = 0; i < 300; ++i) motion.step({x, 0.001, {.guarded = true}});
    const auto sent = motion.step({x, 0.001, health});
    EXPECT_EQ(motion.end(), ExcitationEnd::not_well);
    for (const double torque : sent) EXPECT_EQ(torque, 0);
  }
}

TEST_F(AnExcitation, EndsWhenTheHandSwitchOpens) {
  run(4);
  EXPECT_EQ(step({.guarded = true, .hand = false}).norm(), 0);
  expect_nothing_leaves_after(ExcitationEnd::let_go);
}

TEST_F(AnExcitation, EndsWhenTheWindowThatShowsItIsSilent) {
  run(4);
  step({.guarded = true, .silence = 0.3});
  expect_nothing_leaves_after(ExcitationEnd::limit);
}

// A hand that holds a joint firmly: a stiff spring to its place.
TEST_F(AnExcitation, EndsWhenAHandHoldsOn) {
  run(4);
  const DeviceReading held = reading();
  int ticks = 0;
  while (motion_.end() == ExcitationEnd::running && ticks < 10000) {
    const DeviceReading now = reading();
    device_.push = Eigen::VectorXd::Zero(3);
    for (std::size_t j = 0; j < 3; ++j) {
      device_.push[static_cast<Eigen::Index>(j)] = 20 * (held.x[j] - now.x[j]);
    }
    step();
    ++ticks;
  }
  EXPECT_LT(ticks, 4000);
  expect_nothing_leaves_after(ExcitationEnd::held);
}

TEST_F(AnExcitation, EndsWhenSomethingThrowsIt) {
  run(4);
  device_.push = Eigen::VectorXd::Constant(3, 2);
  run(1);
  EXPECT_TRUE(motion_.end() == ExcitationEnd::limit || motion_.end() == ExcitationEnd::held);
  expect_nothing_leaves_after(motion_.end());
}

// The motion's controller then pushes the joint away from its target.
TEST_F(AnExcitation, EndsWhereAnAxisIsTheWrongWayRound) {
  for (int i = 0; i < 10000 && motion_.end() == ExcitationEnd::running; ++i) {
    const DeviceReading now = reading();
    const auto sent =
        motion_.step({std::span(now.x).first(3), 0.001, DeviceHealth{.guarded = true}});
    std::array<double, 3> turned{};
    for (std::size_t j = 0; j < 3; ++j) turned[j] = j == 1 ? -sent[j] : sent[j];
    device_.write(turned);
  }
  EXPECT_LT(motion_.time(), 4);
  EXPECT_TRUE(motion_.end() == ExcitationEnd::limit || motion_.end() == ExcitationEnd::held);
  expect_nothing_leaves_after(motion_.end());
}

TEST_F(AnExcitation, NeedsMotorsAndAnArmOfAsManyJoints) {
  DeviceTraits traits = device_.traits();
  EXPECT_THROW(Excitation(test::random_arm(2, 1), traits, plan_), std::invalid_argument);
  traits.pushes = false;
  EXPECT_THROW(Excitation(arm_, traits, plan_), std::invalid_argument);
}

// A pose at rest need not be in the middle: here a stop lies a tenth of a radian beside it.
TEST(Excitation, KeepsOffAStopNearItsMiddleOnWhicheverSide) {
  for (const double side : {-1.0, 1.0}) {
    const ArmDescription free = test::omni();
    ArmDescription arm = free;
    Joint& joint = arm.joints[0];
    constexpr double kFar = std::numeric_limits<double>::infinity();
    joint.lower = side < 0 ? -0.1 : -kFar;
    joint.upper = side < 0 ? kFar : 0.1;
    ASSERT_EQ(rest_pose(arm)[0], 0);
    UnlikeDevice device(free, {.gravity = Vec3(0, 0, -9.81)});
    Excitation motion(arm, device.traits(), {});
    double farthest = 0;
    while (motion.end() == ExcitationEnd::running) {
      DeviceReading now;
      device.read(now);
      if (motion.stage() != ExcitationStage::approach) {
        farthest = std::max(farthest, side * now.x[0]);
      }
      device.write(motion.step({std::span(now.x).first(3), 0.001, {.guarded = true}}));
    }
    EXPECT_EQ(motion.end(), ExcitationEnd::complete);
    EXPECT_LT(farthest, 0.1);
    EXPECT_GT(farthest, 0.05) << "it moves all the same";
  }
}

// Only the last joint deviates: led aside by 0.07 rad, where 0.058 are too far.
class AJointAside : public testing::Test {
 protected:
  AJointAside() {
    for (Joint& joint : arm_.joints) joint.effort = 10;
    traits_.effort.assign(3, 10.0);
    motion_.emplace(arm_, traits_, ExcitationPlan{.amplitude = 0.01});
    const Eigen::VectorXd rest = rest_pose(arm_);
    std::copy_n(rest.data(), 3, x_.begin());
  }
  static DeviceTraits traits() {
    const UnlikeDevice device(test::omni(), {});
    return device.traits();
  }
  void step(int ticks, double speed) {
    for (int i = 0; i < ticks; ++i) {
      x_[2] += 0.001 * speed;
      motion_->step({x_, 0.001, {.guarded = true}});
    }
  }

  ArmDescription arm_ = test::omni();
  DeviceTraits traits_ = traits();
  std::optional<Excitation> motion_;
  std::array<double, 3> x_{};
};

TEST_F(AJointAside, IsWaitedForEachTimeAnew) {
  for (int time = 0; time < 2; ++time) {
    step(70, 1);
    step(400, 0);
    step(70, -1);
    step(150, 0);
    ASSERT_EQ(motion_->end(), ExcitationEnd::running) << explain(motion_->end());
  }
}

TEST_F(AJointAside, EndsItAfterSixTenthsOfASecond) {
  step(70, 1);
  step(500, 0);
  EXPECT_EQ(motion_->end(), ExcitationEnd::running) << explain(motion_->end());
  step(150, 0);
  EXPECT_EQ(motion_->end(), ExcitationEnd::held);
  EXPECT_EQ(motion_->joint(), 2);
}

}  // namespace
}  // namespace limpid
