#include "devices/hid/axis_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace limpid {
namespace {

DeviceTraits traits(int joints) {
  const auto n = static_cast<std::size_t>(joints);
  DeviceTraits one;
  one.dof = joints;
  one.pushes = true;
  one.lower.assign(n, -0.5);
  one.upper.assign(n, 0.5);
  one.resolution.assign(n, 1e-4);
  one.effort.assign(n, 2.0);
  return one;
}

// Joints that move in proportion to their torque, by a given angle per newton metre.
struct Springs {
  std::vector<double> give;
  std::vector<double> x = std::vector<double>(give.size());
  double most = 0, time = 0;

  void tick(AxisCheck& check, bool well = true) {
    const auto torque = check.step({x, 1e-3, well});
    ASSERT_EQ(torque.size(), x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = give[i] * torque[i];
      most = std::max(most, std::abs(torque[i]));
    }
    time += 1e-3;
  }
  void run(AxisCheck& check) {
    while (!check.done() && time < 100) tick(check);
  }
  bool pushes(AxisCheck& check) {
    for (int i = 0; i < 2000 && !check.done(); ++i) {
      tick(check);
      for (const double one : x) {
        if (std::abs(one) > 1e-6) return true;
      }
    }
    return false;
  }
};

// The gimbal of a pen has no motors, and turns as the hand likes.
TEST(AxisCheck, LeavesJointsWithoutAMotorAlone) {
  DeviceTraits pen = traits(4);
  pen.effort = {0, 2, 0, 0};
  AxisCheck check(pen);
  EXPECT_EQ(check.axis(), 1);
  Springs springs{{0, 0.2, 0, 0}};
  while (!check.done() && springs.time < 100) {
    springs.tick(check);
    springs.x[0] = springs.x[3] = 0.4 * std::sin(20 * springs.time);
  }
  EXPECT_TRUE(check.passed());
  EXPECT_EQ(check.finding(0).verdict, AxisVerdict::no_motor);
  EXPECT_EQ(check.finding(1).verdict, AxisVerdict::right);
  EXPECT_EQ(check.finding(3).verdict, AxisVerdict::no_motor);
}

TEST(AxisCheck, FindsTheSignAndTheGiveOfEachJoint) {
  AxisCheck check(traits(3));
  Springs springs{{0.2, -0.4, 0.3}};
  springs.run(check);
  EXPECT_TRUE(check.passed());
  EXPECT_EQ(check.finding(0).verdict, AxisVerdict::right);
  EXPECT_EQ(check.finding(1).verdict, AxisVerdict::reversed);
  EXPECT_EQ(check.finding(2).verdict, AxisVerdict::right);
  EXPECT_NEAR(check.finding(1).moved_per_torque, 0.4, 1e-9);
  EXPECT_LE(springs.time, 3 * 3.0);
}

// Full force is 2 N m. A joint that takes all the time yields too little.
TEST(AxisCheck, AsksForATenthOfFullForceAndThreeSecondsAtMost) {
  AxisCheck check(traits(1));
  Springs firm{{0.049}};
  firm.run(check);
  EXPECT_EQ(check.finding(0).verdict, AxisVerdict::nothing_moved);
  EXPECT_LE(firm.most, 0.2 + 1e-12);
  EXPECT_GT(firm.most, 0.19);
  EXPECT_LE(firm.time, 3.0);
  AxisCheck again(traits(1));
  Springs slack{{0.0501}};
  slack.run(again);
  EXPECT_TRUE(again.passed());
  EXPECT_LE(slack.time, 3.0);
}

TEST(AxisCheck, FadesIn) {
  AxisCheck check(traits(1));
  Springs firm{{0.0}};
  double before = 0, steepest = 0;
  for (int i = 0; i < 5000 && !check.done(); ++i) {
    const double torque = check.step({firm.x, 1e-3, true})[0];
    steepest = std::max(steepest, torque - before);
    before = torque;
  }
  EXPECT_LE(steepest, 0.2 * 1e-3 / 0.5 + 1e-12) << "half a second to a tenth of 2 N m";
}

// The first push has a torque above zero, the second one below.
TEST(AxisCheck, SaysWhichOfTheTwoPushesIsUnderWay) {
  AxisCheck check(traits(2));
  Springs springs{{0.2, -0.4}};
  std::vector<AxisStage> pushes;
  while (!check.done() && springs.time < 100) {
    const AxisStage stage = check.stage();
    const auto axis = static_cast<std::size_t>(check.axis());
    springs.tick(check);
    const double torque = springs.x[axis] / springs.give[axis];
    if (torque == 0) continue;
    EXPECT_EQ(stage, torque > 0 ? AxisStage::pushing : AxisStage::pushing_back);
    if (pushes.empty() || pushes.back() != stage) pushes.push_back(stage);
  }
  using enum AxisStage;
  EXPECT_EQ(pushes, (std::vector{pushing, pushing_back, pushing, pushing_back}));
  EXPECT_EQ(check.stage(), done);
}

// A loop that stood still has no idea what the device did meanwhile.
TEST(AxisCheck, BeginsAPushAgainFromNothingAfterAStall) {
  AxisCheck check(traits(1));
  Springs springs{{0.2}};
  double asked = 0;
  while (asked < 0.08) {
    asked = check.step({springs.x, 1e-3, true})[0];
    ASSERT_FALSE(check.done());
  }
  EXPECT_EQ(check.stage(), AxisStage::pushing);
  EXPECT_EQ(check.step({springs.x, 0.5, true, true})[0], 0);
  EXPECT_EQ(check.stage(), AxisStage::resting) << "a rest is as long as ever";
  double before = 0, steepest = 0;
  while (!check.done() && springs.time < 100) {
    springs.tick(check);
    const double moved = std::abs(springs.x[0]);
    steepest = std::max(steepest, (moved - before) / 0.2);
    before = moved;
  }
  EXPECT_LE(steepest, 0.2 * 1e-3 / 0.5 + 1e-12);
  EXPECT_TRUE(check.passed());
}

// A device that reports a lapse with each reading has no force of its own.
TEST(AxisCheck, EndsWhereEachPushIsInterrupted) {
  AxisCheck check(traits(1));
  const std::vector<double> x{0.0};
  int ticks = 0;
  for (; !check.done() && ticks < 10000; ++ticks) {
    EXPECT_EQ(check.step({x, 1e-3, true, true})[0], 0);
  }
  EXPECT_TRUE(check.done());
  EXPECT_EQ(check.finding(0).verdict, AxisVerdict::stalled);
}

TEST(AxisCheck, IsWithoutTorqueOnceCancelled) {
  AxisCheck check(traits(2));
  Springs springs{{0.06, 0.06}};
  ASSERT_TRUE(springs.pushes(check));
  EXPECT_EQ(check.stage(), AxisStage::pushing);
  check.cancel();
  EXPECT_TRUE(check.done());
  EXPECT_FALSE(check.passed());
  EXPECT_EQ(check.finding(0).verdict, AxisVerdict::given_up);
  for (int i = 0; i < 10; ++i) springs.tick(check);
  EXPECT_EQ(springs.x, (std::vector<double>{0, 0}));
}

TEST(AxisCheck, IsWithoutTorqueAsSoonAsTheDeviceIsNotWell) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> at_rest{0, 0}, broken{0, nan}, too_few{0};
  const AxisCheck::Tick ills[] = {{at_rest, 1e-3, false},
                                  {broken, 1e-3, true},
                                  {too_few, 1e-3, true},
                                  {at_rest, 0, true},
                                  {at_rest, nan, true}};
  for (const AxisCheck::Tick& ill : ills) {
    AxisCheck check(traits(2));
    Springs springs{{0.06, 0.06}};
    ASSERT_TRUE(springs.pushes(check));
    const auto torque = check.step(ill);
    EXPECT_EQ(torque[0], 0);
    EXPECT_EQ(torque[1], 0);
    EXPECT_EQ(check.finding(0).verdict, AxisVerdict::given_up);
    springs.run(check);
    EXPECT_FALSE(check.passed()) << "it does not go on by itself";
  }
}

TEST(AxisCheck, KeepsWhatItHasFoundWhenCancelledAtItsEnd) {
  AxisCheck check(traits(1));
  Springs springs{{0.2}};
  springs.run(check);
  ASSERT_TRUE(check.passed());
  check.cancel();
  EXPECT_TRUE(check.passed());
}

// The motor turns the joint by seven steps of its encoder.
TEST(AxisCheck, WantsMoreThanTheNoiseOfACoarseEncoder) {
  DeviceTraits coarse = traits(1);
  coarse.resolution = {0.004};
  AxisCheck check(coarse);
  std::vector<double> x{0};
  for (int i = 0; i < 10'000 && !check.done(); ++i) {
    const double torque = check.step({x, 1e-3, true})[0];
    x[0] = 0.004 * std::round(7 * torque / 0.2);
  }
  EXPECT_EQ(check.finding(0).verdict, AxisVerdict::nothing_moved);
}

TEST(AxisCheck, WaitsUntilTheDeviceIsAtRest) {
  AxisCheck check(traits(1));
  std::vector<double> x{0};
  for (int i = 0; i < 10'000 && !check.done(); ++i) {
    x[0] = 0.03 * std::sin(0.05 * i);
    EXPECT_EQ(check.step({x, 1e-3, true})[0], 0);
  }
  EXPECT_EQ(check.finding(0).verdict, AxisVerdict::restless);
}

// Each push moves the joint, but always the same way: a hand did that.
TEST(AxisCheck, BelievesOnlyWhatMovesBothWays) {
  AxisCheck check(traits(1));
  std::vector<double> x{0};
  for (int i = 0; i < 10'000 && !check.done(); ++i) {
    x[0] = 0.2 * std::abs(check.step({x, 1e-3, true})[0]);
  }
  EXPECT_EQ(check.finding(0).verdict, AxisVerdict::restless);
  EXPECT_FALSE(check.passed());
}

// After a push the joint goes on by itself, at 1 rad/s, over a range of 1 rad.
TEST(AxisCheck, GivesUpADeviceThatRunsOn) {
  AxisCheck check(traits(1));
  std::vector<double> x{0};
  bool running = false;
  for (int i = 0; i < 10'000 && !check.done(); ++i) {
    const double torque = check.step({x, 1e-3, true})[0];
    running = running || torque > 0.05;
    x[0] += running ? 1e-3 : 0;
  }
  EXPECT_EQ(check.finding(0).verdict, AxisVerdict::too_far);
  EXPECT_LT(x[0], 0.16);
}

// The joint moves by more than a hundredth of its range before a fiftieth of the torque acts: its
// motor is too strong, or something else moved it.
TEST(AxisCheck, GivesUpADeviceThatMovesAtOnce) {
  AxisCheck check(traits(1));
  Springs springs{{10}};
  springs.run(check);
  EXPECT_EQ(check.finding(0).verdict, AxisVerdict::too_far);
}

TEST(AxisCheck, NeedsMotorsAndARange) {
  DeviceTraits mouse = traits(3);
  mouse.pushes = false;
  EXPECT_THROW(AxisCheck{mouse}, std::invalid_argument);
  DeviceTraits weak = traits(1);
  weak.effort = {0};
  EXPECT_THROW(AxisCheck{weak}, std::invalid_argument);
  DeviceTraits narrow = traits(1);
  narrow.upper = narrow.lower;
  EXPECT_THROW(AxisCheck{narrow}, std::invalid_argument);
}

TEST(AxisCheck, HasAWordForEverything) {
  for (int i = 0; i <= static_cast<int>(AxisVerdict::given_up); ++i) {
    EXPECT_GT(std::string(explain(static_cast<AxisVerdict>(i))).size(), 10u);
  }
  using enum AxisStage;
  const std::set<std::string> said{what_to_do(resting), what_to_do(pushing),
                                   what_to_do(pushing_back)};
  EXPECT_EQ(said.size(), 3u) << "each is told apart";
}

}  // namespace
}  // namespace limpid
