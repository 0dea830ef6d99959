#include <gtest/gtest.h>

#include "devices/simulated/hands.h"
#include "tests/support/tick.h"

namespace limpid {
namespace {

using test::T;
constexpr double kFastest = 0.25;  // [m/s]

DeviceReading cap(double x, double y, double z) {
  DeviceReading reading;
  reading.x = {x, y, z};
  return reading;
}

Vec3 after_a_second(const DeviceReading& reading) {
  GuidedHand hand;
  hand.reset(Vec3::Zero());
  for (int k = 0; k < 1000; ++k) hand.step(reading, T);
  return hand.goal();
}

// On the cap X points right, Y to the user, Z down; on the arm x away, y left, z up.
TEST(GuidedHand, GoesWhereTheCapIsPushed) {
  EXPECT_LT((after_a_second(cap(1, 0, 0)) - Vec3(0, -kFastest, 0)).norm(), 1e-9);
  EXPECT_LT((after_a_second(cap(0, 1, 0)) - Vec3(-kFastest, 0, 0)).norm(), 1e-9);
  EXPECT_LT((after_a_second(cap(0, 0, 1)) - Vec3(0, 0, -kFastest)).norm(), 1e-9);
  EXPECT_LT((after_a_second(cap(0, 0, -9)) - Vec3(0, 0, kFastest)).norm(), 1e-9);
}

TEST(GuidedHand, StaysWhenTheCapRests) {
  GuidedHand hand;
  hand.reset(Vec3(1, 2, 3));
  EXPECT_FALSE(hand.step(cap(0.05, -0.05, 0.05), T));
  EXPECT_EQ(hand.goal(), Vec3(1, 2, 3));
  EXPECT_TRUE(hand.step(cap(0.2, 0, 0), T));
}

TEST(GuidedHand, IsFineNearTheMiddle) {
  EXPECT_LT(after_a_second(cap(0.5, 0, 0)).norm(), kFastest / 4);
}

TEST(GuidedHand, DoesNotWanderOff) {
  GuidedHand hand;
  hand.reset(Vec3(0.1, 0, 0));
  hand.stay_near(Vec3::Zero(), 0.03);
  EXPECT_LT((hand.goal() - Vec3(0.03, 0, 0)).norm(), 1e-12);
  hand.stay_near(Vec3(0.01, 0, 0), 0.03);
  EXPECT_LT((hand.goal() - Vec3(0.03, 0, 0)).norm(), 1e-12);
}

}  // namespace
}  // namespace limpid
