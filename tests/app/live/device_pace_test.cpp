#include "app/live/device_pace.h"

#include <gtest/gtest.h>

#include "tests/support/random_arm.h"

namespace limpid {
namespace {

TEST(DevicePace, IsNothingBeforeTwoReadings) {
  DevicePace pace;
  EXPECT_EQ(pace.figures().intervals, 0u);
  pace.note(0, 0, 1);
  pace.note(7, 0.0002, 1.001);
  pace.note(7, 0.0012, 1.002);
  EXPECT_EQ(pace.figures().intervals, 0u);
  EXPECT_EQ(pace.figures().rate, 0);
}

// Ticks of 1 ms take readings that arrive every 2 ms, alternately a little early and late.
TEST(DevicePace, MeasuresWhenReadingsArrivedNotWhenTheyWereLookedAt) {
  DevicePace pace;
  test::Random random(81);
  double sum = 0, squares = 0, before = 0;
  int n = 0;
  for (int k = 0; k < 4000; ++k) {
    const double now = 10 + 1e-3 * k;
    const int reading = k / 2 + 1;
    static double arrived = 0;
    if (k % 2 == 0) {
      arrived = now - 3e-4 + random.between(-1e-4, 1e-4);
      if (reading > 1) {
        sum += arrived - before;
        squares += (arrived - before) * (arrived - before);
        ++n;
      }
      before = arrived;
    }
    pace.note(static_cast<std::uint64_t>(reading), now - arrived, now);
  }
  const DevicePace::Figures f = pace.figures();
  EXPECT_EQ(f.intervals, static_cast<std::uint64_t>(n));
  EXPECT_NEAR(f.mean, sum / n, 1e-9);
  EXPECT_NEAR(f.jitter, std::sqrt(squares / n - sum * sum / n / n), 1e-8);
  EXPECT_NEAR(f.rate, 500, 0.5);
  EXPECT_NEAR(pace.intervals().quantile(0.5), 2e-3, 1.5e-4);
}

TEST(DevicePace, CountsReadingsThatCameBetweenTwoTicksIntoTheRateAlone) {
  DevicePace pace;
  for (int k = 0; k < 1000; ++k) pace.note(static_cast<std::uint64_t>(4 * k + 1), 0, 1e-3 * k);
  EXPECT_EQ(pace.figures().intervals, 0u) << "when each of them came nobody knows";
  pace.note(4001, 0, 1.0);
  pace.note(4002, 0, 1.001);
  EXPECT_EQ(pace.figures().intervals, 1u);
  EXPECT_NEAR(pace.figures().rate, 4000, 10);
}

TEST(DevicePace, ForgetsTheDeviceBefore) {
  DevicePace pace;
  for (int k = 0; k < 10; ++k) pace.note(static_cast<std::uint64_t>(k + 1), 0, 0.01 * k);
  pace.start();
  EXPECT_EQ(pace.figures().intervals, 0u);
  EXPECT_EQ(pace.intervals().count(), 0u);
  pace.note(500, 0, 20);
  EXPECT_EQ(pace.figures().intervals, 0u) << "the first reading of another one";
}

}  // namespace
}  // namespace limpid
