// A gamepad as a hand: effects of sticks, triggers and buttons.
#include "app/desktop/device/pad_hand.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/built_in.h"

namespace limpid {
namespace {

const PictureAxes kFront{Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(-1, 0, 0)};
const Vec3 kTip(0.19, 0, 0);

struct Held {
  ArmDescription arm = test::omni();
  Controls controls;
  PadHand hand;

  PadHand::Asked lead(const PadReading& now, double dt = 0.01) {
    return hand.lead(now, kFront, arm, kTip, dt, controls);
  }
};

TEST(PadPush, IsNothingWhereAWornStickRests) {
  for (const double x : {0.0, 0.05, -0.1, 0.149}) {
    EXPECT_EQ(pad_push({.left_x = x, .right_y = -x}), Vec3::Zero()) << x;
  }
  EXPECT_EQ(pad_push({.left_trigger = 0.04}), Vec3::Zero());
}

TEST(PadPush, IsWholeAtTheEndOfAStickInEveryDirection) {
  EXPECT_TRUE(pad_push({.left_x = 1}).isApprox(Vec3(1, 0, 0)));
  EXPECT_TRUE(pad_push({.left_y = -1}).isApprox(Vec3(0, 1, 0)));
  const double slant = std::sqrt(0.5);
  EXPECT_NEAR(pad_push({.left_x = slant, .left_y = slant}).norm(), 1, 1e-12);
  EXPECT_NEAR(pad_push({.left_x = 1, .left_y = 1}).norm(), 1, 1e-12) << "a square gate's corner";
}

TEST(PadPush, GrowsFasterThanTheStickSoThatItLeadsFinely) {
  const double half = pad_push({.left_x = 0.575}).x();  // half of the way beyond the dead zone
  EXPECT_NEAR(half, 0.25, 1e-12);
}

TEST(PadPush, GoesAwayByTheRightTriggerOrStickAndNearerByTheLeft) {
  EXPECT_NEAR(pad_push({.right_trigger = 1}).z(), 1, 1e-12);
  EXPECT_NEAR(pad_push({.left_trigger = 1}).z(), -1, 1e-12);
  EXPECT_NEAR(pad_push({.right_y = -1}).z(), 1, 1e-12);
  EXPECT_NEAR(pad_push({.right_y = -1, .right_trigger = 1}).z(), 1, 1e-12) << "no faster by both";
}

TEST(PadHand, TakesHoldAtTheTipAndMovesInThePicture) {
  Held held;
  held.lead({});
  EXPECT_FALSE(held.controls.grab);
  held.lead({.left_y = -1});
  EXPECT_TRUE(held.controls.grab);
  EXPECT_GT(held.controls.goal.z(), kTip.z());
  EXPECT_EQ(held.controls.goal.y(), kTip.y());
  held.lead({});
  EXPECT_TRUE(held.controls.grab) << "a stick that rests holds on";
}

TEST(PadHand, StaysNearATipThatCannotFollow) {
  Held held;
  for (int i = 0; i < 1000; ++i) held.lead({.left_x = 1});
  EXPECT_LE((held.controls.goal - kTip).norm(), 0.1 + 1e-9);
}

TEST(PadHand, LetsGoByAButtonUntilTheStickHasRested) {
  Held held;
  held.lead({.left_x = 1});
  held.lead({.left_x = 1, .a = true});
  EXPECT_FALSE(held.controls.grab);
  held.lead({.left_x = 1});
  EXPECT_FALSE(held.controls.grab) << "still pushed";
  held.lead({});
  held.lead({.left_x = 1});
  EXPECT_TRUE(held.controls.grab);
}

TEST(PadHand, AsksOnceAPress) {
  Held held;
  EXPECT_TRUE(held.lead({.b = true}).cut);
  EXPECT_FALSE(held.lead({.b = true}).cut);
  EXPECT_TRUE(held.lead({.y = true}).next_law);
  EXPECT_TRUE(held.lead({.x = true}).magnet);
  EXPECT_FALSE(held.lead({.x = true}).magnet);
}

TEST(PadHand, LetsGoWhenItIsUnpluggedOfWhatItHeldAlone) {
  Held held;
  held.lead({.left_x = 1});
  held.hand.lose(held.controls);
  EXPECT_FALSE(held.controls.grab);
  held.controls.grab = true;  // the mouse takes hold
  held.hand.lose(held.controls);
  EXPECT_TRUE(held.controls.grab);
}

// Anyone else's letting go ends the pad's hold; a later hold is not the pad's.
TEST(PadHand, LeavesTheHandToWhoTookItAfterSomebodyLetGo) {
  Held held;
  held.lead({.left_x = 1});
  ASSERT_TRUE(held.controls.grab);
  held.controls.grab = false;  // the mouse lets go, or the loop has started over
  held.lead({});
  held.controls.grab = true;  // the mouse takes hold
  held.lead({});
  held.hand.lose(held.controls);
  EXPECT_TRUE(held.controls.grab);
}

TEST(PadHand, HoldsAloneWhatItTookFromTheMouseByPushing) {
  Held held;
  held.controls.grab = true;  // the mouse takes hold
  held.controls.goal = kTip;
  held.lead({.left_x = 1});
  held.hand.lose(held.controls);
  EXPECT_FALSE(held.controls.grab);
}

TEST(PadHand, LetsGoOfWhatTheMouseHoldsByItsButtonToo) {
  Held held;
  held.controls.grab = true;
  held.lead({.a = true});
  EXPECT_FALSE(held.controls.grab);
  held.controls.grab = true;  // the mouse takes hold again
  held.hand.lose(held.controls);
  EXPECT_TRUE(held.controls.grab) << "the pad holds nothing";
}

TEST(PadHand, TakesHoldWhereTheTipIsByItsButtonAndHeldDownDoesNothingMore) {
  Held held;
  held.controls.goal = kTip + Vec3(0.05, 0, 0);  // from an earlier hold
  held.lead({.a = true});
  EXPECT_TRUE(held.controls.grab);
  EXPECT_EQ(held.controls.goal, kTip);
  held.lead({.a = true});
  EXPECT_TRUE(held.controls.grab);
  held.lead({});
  held.lead({.a = true});
  EXPECT_FALSE(held.controls.grab);
}

// A pad that comes back with a stick pushed takes hold like a new one.
TEST(PadHand, ForgetsWithItsPlugThatItsStickHadToRest) {
  Held held;
  held.lead({.left_x = 1});
  held.lead({.left_x = 1, .a = true});
  held.hand.lose(held.controls);
  held.lead({.left_x = 1});
  EXPECT_TRUE(held.controls.grab);
}

}  // namespace
}  // namespace limpid
