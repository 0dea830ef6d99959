#include "app/plot/range_figures.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace limpid {
namespace {

// 3 + 2 sin over ten whole periods, and a channel without numbers in the second half.
History waves() {
  History history({.channels = 2, .seconds = 12});
  for (int i = 0; i < 10'000; ++i) {
    const double t = 0.001 * i;
    history.append(
        t, std::array{3 + 2 * std::sin(2 * std::numbers::pi * t), i < 5000 ? -1.0 : std::nan("")});
  }
  return history;
}

TEST(RangeFigures, OfAWaveAreThoseOfTheory) {
  const RangeFigures found = figures_between(waves(), 0, 0, 9.9995);
  EXPECT_EQ(found.count, 10'000u);
  EXPECT_NEAR(found.mean, 3, 1e-6);
  EXPECT_NEAR(found.rms, std::sqrt(3 * 3 + 2 * 2 / 2.0), 1e-6);
  EXPECT_NEAR(found.low, 1, 1e-6);
  EXPECT_NEAR(found.high, 5, 1e-6);
}

// Both ends of the range count.
TEST(RangeFigures, AreOfTheRowsFromStartToStop) {
  EXPECT_EQ(figures_between(waves(), 0, 1, 1.01).count, 11u);
  EXPECT_EQ(figures_between(waves(), 0, 1.0001, 1.0009).count, 0u);
  EXPECT_EQ(figures_between(waves(), 0, -5, 0.0025).count, 3u);
  EXPECT_EQ(figures_between(waves(), 0, 9.9985, 50).count, 1u);
}

TEST(RangeFigures, LeaveOutWhatIsNoNumber) {
  const RangeFigures half = figures_between(waves(), 1, 4, 8);
  EXPECT_EQ(half.count, 1000u);
  EXPECT_EQ(half.mean, -1);
  EXPECT_EQ(half.rms, 1);
  const RangeFigures none = figures_between(waves(), 1, 6, 8);
  EXPECT_EQ(none.count, 0u);
  EXPECT_TRUE(std::isnan(none.mean) && std::isnan(none.rms) && std::isnan(none.low));
}

}  // namespace
}  // namespace limpid
