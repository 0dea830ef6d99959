// Belief in readings, against the numbers of safety_limits.h written out.
#include "devices/reading_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/support/device_traits.h"

namespace limpid {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

// A device of two joints, each between -1 and 1 rad, or without an end, read every millisecond.
struct Watched : testing::Test {
  // Gives another reading, with the first joint at x [rad], after so long [s]; whether it is
  // believed.
  bool says(double x, double after = 1e-3) {
    ++reading.count;
    reading.x[0] = x;
    return again(after);
  }
  bool again(double after = 1e-3) {
    watch.wait(after);
    return watch.believes(reading, traits);
  }
  void endless() { traits.lower.clear(), traits.upper.clear(); }

  DeviceTraits traits = test::pushing(2);
  DeviceReading reading;
  ReadingWatch watch;
};

TEST_F(Watched, MayBeAnywhereWithinARadianOfItsRange) {
  for (const double side : {-1.0, 1.0}) {
    watch.start();
    EXPECT_TRUE(says(side * 1.99));
    watch.start();
    EXPECT_FALSE(says(side * 2.01));
    EXPECT_FALSE(says(side * 1e6));
    EXPECT_TRUE(says(side * 1.99));
  }
  reading.x[1] = 2.01;
  EXPECT_FALSE(says(0)) << "each joint is judged";
}

TEST_F(Watched, IsSomewhere) {
  endless();
  for (const double x : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(says(x));
    EXPECT_FALSE(says(-x));
    EXPECT_FALSE(again(10)) << "however long it says so";
    EXPECT_TRUE(says(0));
  }
}

// 100 rad/s for the millisecond, and for the 5 ms that the previous reading may have been old.
TEST_F(Watched, MovesByNoMoreThanTheFastestJointDoesBetweenTwoReadings) {
  endless();
  for (const double way : {0.59, -0.59}) {
    EXPECT_TRUE(says(0, 1));
    EXPECT_TRUE(says(way));
    EXPECT_TRUE(says(2 * way));
  }
  for (const double way : {0.61, -0.61, kTurn, -kTurn, 1e6}) {
    EXPECT_TRUE(says(0, 1));
    EXPECT_FALSE(says(way)) << way;
    EXPECT_TRUE(says(0.01)) << "and was never there";
  }
}

TEST_F(Watched, MayHaveGoneFurtherSinceAReadingThatIsLate) {
  endless();
  EXPECT_TRUE(says(0, 1));
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(again());  // ticks without a new reading
  EXPECT_TRUE(says(0.99));
  EXPECT_TRUE(says(0, 1));
  EXPECT_TRUE(says(0.99, 0.005)) << "in one tick that was as long";
  EXPECT_FALSE(says(2.0, 0.005));
  EXPECT_FALSE(says(0.99 + kTurn, 0.04)) << "a turn is none for 57 ms";
}

// An encoder that has lost a turn for good looks like a device that was turned.
TEST_F(Watched, IsBelievedToBeElsewhereOnceItCanHaveGoneThere) {
  endless();
  EXPECT_TRUE(says(0, 1));
  int wrong = 0;
  while (!says(kTurn)) ++wrong;
  EXPECT_EQ(wrong, 57);
  EXPECT_TRUE(says(kTurn + 0.1));
}

TEST_F(Watched, StaysWrongUntilAnotherReadingComes) {
  EXPECT_TRUE(says(0));
  EXPECT_FALSE(says(0.9));
  for (int i = 0; i < 1000; ++i) ASSERT_FALSE(again());
  EXPECT_TRUE(says(0.9)) << "it says so still, and has had the time";
}

TEST_F(Watched, MayBeAnywhereInItsRangeWhenItIsPluggedIn) {
  EXPECT_TRUE(says(-0.9));
  EXPECT_FALSE(says(0.9));
  watch.start();
  EXPECT_TRUE(says(0.9));
}

}  // namespace
}  // namespace limpid
