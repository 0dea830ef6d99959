#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "app/experiments/signals.h"

namespace limpid {
namespace {

TEST(Harmonics, FindAmplitudeAndPhaseOfEveryLineAmongTheOthers) {
  const double T = 0.001;
  std::vector<double> samples;
  for (int k = 0; k < 2000; ++k) {
    const double t = k * T;
    samples.push_back(7 + 0.3 * std::cos(2 * std::numbers::pi * 5 * t + 0.4) +
                      2e-4 * std::cos(2 * std::numbers::pi * 123.5 * t - 1.2));
  }
  const auto low = amplitude_at(samples, T, 5);
  EXPECT_NEAR(std::abs(low), 0.3, 1e-12);
  EXPECT_NEAR(std::arg(low), 0.4, 1e-11);
  const auto high = amplitude_at(samples, T, 123.5);
  EXPECT_NEAR(std::abs(high), 2e-4, 1e-13);
  EXPECT_NEAR(std::arg(high), -1.2, 1e-8);
  EXPECT_NEAR(std::abs(amplitude_at(samples, T, 20)), 0, 1e-12);
}

TEST(Harmonics, FindWhereAStraightLineInLogFrequencyFallsThroughALevel) {
  std::vector<double> f, value;
  for (double x = 1; x < 100; x *= 1.7) {
    f.push_back(x);
    value.push_back(1 - 0.2 * std::log(x));
  }
  EXPECT_NEAR(falls_through(f, value, 0.5), std::exp(2.5), 1e-9);
  EXPECT_EQ(falls_through(f, value, -5), 0);
  EXPECT_EQ(falls_through({1, 2, 4}, {1, 0.5, 1}, 0.5), 0);  // a touch of the limit is no fall
  EXPECT_EQ(falls_through({1, 2, 4}, {1, 0.5, 0.2}, 0.5), 2);
}

TEST(Harmonics, FindTheRateOfAnExponentialAlsoInAnEvenRipple) {
  std::vector<double> decaying, rippled;
  for (int k = 0; k < 400; ++k) {
    const double t = k * 0.01;
    decaying.push_back(3 * std::exp(-1.7 * t));
    rippled.push_back(3 * std::exp(0.4 * t) * (k % 2 == 0 ? 1.01 : 1 / 1.01));
  }
  EXPECT_NEAR(growth_rate(decaying, 0.01), -1.7, 1e-12);
  EXPECT_NEAR(growth_rate(rippled, 0.01), 0.4, 1e-3);
}

TEST(Multisine, HasItsLinesAtWholeMultiplesAndNothingBetween) {
  const Multisine signal = multisine(0.5, 1, 100, 12, 0.01, 3);
  const double T = 0.001;
  std::vector<double> samples;
  for (int k = 0; k < 2000; ++k) samples.push_back(signal.at(k * T));
  ASSERT_GE(signal.lines.size(), 10u);
  EXPECT_NEAR(signal.frequency(signal.lines.front()), 1, 1e-12);
  EXPECT_NEAR(signal.frequency(signal.lines.back()), 100, 0.5);
  for (const Multisine::Line& line : signal.lines) {
    const double f = signal.frequency(line);
    const auto seen = amplitude_at(samples, T, f);
    EXPECT_NEAR(2 * std::numbers::pi * f * std::abs(seen), 0.01, 1e-9);
    EXPECT_NEAR(
        std::remainder(std::arg(seen) + std::numbers::pi / 2 - line.phase, 2 * std::numbers::pi), 0,
        1e-6);
  }
}

TEST(Multisine, IsDecidedByItsSeed) {
  const Multisine a = multisine(0.5, 1, 100, 12, 0.01, 3), b = multisine(0.5, 1, 100, 12, 0.01, 3);
  const Multisine c = multisine(0.5, 1, 100, 12, 0.01, 4);
  EXPECT_EQ(a.at(0.123), b.at(0.123));
  EXPECT_NE(a.at(0.123), c.at(0.123));
}

TEST(MinimumJerk, StartsAndEndsAtRestAndIsHalfwayInTheMiddle) {
  EXPECT_EQ(minimum_jerk(-1), 0);
  EXPECT_EQ(minimum_jerk(2), 1);
  EXPECT_DOUBLE_EQ(minimum_jerk(0.5), 0.5);
  EXPECT_NEAR(minimum_jerk(1e-3), 0, 2e-8);
  EXPECT_NEAR(minimum_jerk(1 - 1e-3), 1, 2e-8);
}

TEST(HandPath, GivesTheSignalItselfAtEveryTick) {
  const auto at = [](double t) { return Vec3(0.2 + 0.01 * std::sin(30 * t), t, 0); };
  const HandPath path = hand_path("sine", 0.002, 0.5, at);
  ASSERT_EQ(path.time.size(), 250u);
  EXPECT_EQ(path.duration(), 0.5);
  for (std::size_t k = 0; k < path.time.size(); k += 17) {
    EXPECT_EQ(path.sample(k, 0.002), at(static_cast<double>(k) * 0.002));
    EXPECT_NEAR(path.velocity[k].y(), 1, 1e-9);
  }
}

}  // namespace
}  // namespace limpid
