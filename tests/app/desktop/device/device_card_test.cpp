// The device's card: which step is done, is to do, or has failed, in each situation.
#include "app/desktop/device/device_card.h"

#include <gtest/gtest.h>

namespace limpid {
namespace {

using enum StepState;

TEST(DeviceCard, BeginsWithFindingTheDevice) {
  const DeviceSteps none = steps_of({});
  EXPECT_EQ(none.found, now);
  for (const StepState other : {none.arm, none.axes, none.measured, none.force}) {
    EXPECT_EQ(other, later);
  }
  EXPECT_EQ(steps_of({.present = true}).found, done) << "it is being connected";
  EXPECT_EQ(steps_of({.problem = true}).found, failed);
  EXPECT_EQ(steps_of({.present = true, .problem = true}).found, failed) << "it cannot be opened";
}

TEST(DeviceCard, SaysAtTheAxesThatTheirCheckFailed) {
  const DeviceSteps asked = steps_of({.present = true, .awaits_check = true, .problem = true});
  EXPECT_EQ(asked.found, done);
  EXPECT_EQ(asked.arm, done) << "it was chosen";
  EXPECT_EQ(asked.axes, now);
  EXPECT_EQ(asked.force, later);
  const DeviceSteps broken =
      steps_of({.present = true, .check_failed = true, .awaits_check = true, .problem = true});
  EXPECT_EQ(broken.found, done);
  EXPECT_EQ(broken.axes, failed);
  EXPECT_EQ(steps_of({.present = true, .checking = true}).axes, now);
}

TEST(DeviceCard, EndsWithForceInTheHand) {
  const DeviceSteps there = steps_of({.present = true, .in_place = true});
  EXPECT_EQ(there.axes, done);
  EXPECT_EQ(there.arm, done);
  EXPECT_EQ(there.measured, now);
  EXPECT_EQ(there.force, now);
  const DeviceSteps armed =
      steps_of({.present = true, .in_place = true, .measured = true, .pushes = true});
  EXPECT_EQ(armed.measured, done);
  EXPECT_EQ(armed.force, done);
  EXPECT_EQ(steps_of({.present = true, .asks_for_arm = true, .in_place = true}).arm, now);
}

}  // namespace
}  // namespace limpid
