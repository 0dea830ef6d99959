#include <gtest/gtest.h>

#include "devices/simulated/hands.h"
#include "tests/support/tick.h"

namespace limpid {
namespace {

using test::T;
constexpr double kGrip = 10;  // [N/m]: so soft that the hand's strength sets no bound
const Vec3 kTipAt(0.1, -0.2, 0.3);
const Vec3 kGoal(0.15, -0.1, 0.25);

TEST(MouseHand, StaysWithTheTipUntilItGrabs) {
  MouseHand hand;
  hand.reset(Vec3::Zero());
  const HandInput input = hand.step(false, kGoal, kTipAt, kGrip, T);
  EXPECT_EQ(input.target, kTipAt);
  EXPECT_EQ(input.grip, 0);
}

TEST(MouseHand, ClosesAndOpensItsGripWithinATwentiethOfASecond) {
  MouseHand hand;
  hand.reset(kTipAt);
  for (int k = 1; k <= 50; ++k) {
    EXPECT_NEAR(hand.step(true, kTipAt, kTipAt, kGrip, T).grip, k / 50.0, 1e-12);
  }
  EXPECT_EQ(hand.step(true, kTipAt, kTipAt, kGrip, T).grip, 1);
  for (int k = 49; k >= 0; --k) {
    EXPECT_NEAR(hand.step(false, kTipAt, kTipAt, kGrip, T).grip, k / 50.0, 1e-12);
  }
  EXPECT_EQ(hand.step(false, kTipAt, Vec3::Zero(), kGrip, T).grip, 0);
}

TEST(MouseHand, MovesAsACriticallyDampedSecondOrderSystem) {
  constexpr double w = 2 * 3.14159265358979323846 * 8;
  MouseHand hand;
  hand.reset(kTipAt);
  for (int k = 1; k <= 300; ++k) {
    const double t = k * T;
    const Vec3 wanted = kGoal + (kTipAt - kGoal) * (1 + w * t) * std::exp(-w * t);
    ASSERT_LT((hand.step(true, kGoal, kTipAt, kGrip, T).target - wanted).norm(), 1e-13);
  }
}

TEST(MouseHand, GoesTheSameWayWhateverTheTick) {
  MouseHand coarse, fine;
  coarse.reset(kTipAt);
  fine.reset(kTipAt);
  Vec3 a, b;
  for (int k = 0; k < 20; ++k) {
    a = coarse.step(true, kGoal, kTipAt, kGrip, 4 * T).target;
    for (int i = 0; i < 4; ++i) b = fine.step(true, kGoal, kTipAt, kGrip, T).target;
    ASSERT_LT((a - b).norm(), 1e-13);
  }
}

TEST(MouseHand, PullsNoHarderThanAHand) {
  MouseHand hand;
  hand.reset(kTipAt);
  for (int k = 0; k < 500; ++k) {
    const HandInput input = hand.step(true, kGoal, kTipAt, 1000, T);
    ASSERT_LE(1000 * (input.target - kTipAt).norm(), 3 * (1 + 1e-12));
  }
  const Vec3 pull = hand.step(true, kGoal, kTipAt, 1000, T).target - kTipAt;
  EXPECT_NEAR(1000 * pull.norm(), 3, 1e-9);
  EXPECT_GT(pull.dot(kGoal - kTipAt), 0);
}

}  // namespace
}  // namespace limpid
