#include "core/math/high_pass.h"

#include <gtest/gtest.h>

namespace limpid {
namespace {

// Gain of the settled filter for a sine of amplitude 1, by its power over 2 s.
double gain(HighPass filter, int frequency, int rate) {
  double power = 0;
  for (int k = 0; k < 4 * rate; ++k) {
    const double y = filter(std::sin(2 * std::numbers::pi * frequency * k / rate));
    if (k >= 2 * rate) power += y * y;
  }
  return std::sqrt(power / rate);
}

TEST(HighPass, IsButterworthsOfFourthOrder) {
  constexpr int rate = 1000, corner = 20;
  for (const int f : {3, 8, 20, 35, 100}) {
    // The bilinear transform bends the axis of frequencies.
    const double w = std::tan(std::numbers::pi * f / rate);
    const double c = std::tan(std::numbers::pi * corner / rate);
    const double expected = 1 / std::sqrt(1 + std::pow(c / w, 8));
    EXPECT_NEAR(gain(HighPass(corner, rate), f, rate), expected, 1e-6) << f;
  }
}

TEST(HighPass, StopsWhatDoesNotChange) {
  HighPass filter(20, 1000);
  double y = 0;
  for (int k = 0; k < 2000; ++k) y = filter(5);
  EXPECT_NEAR(y, 0, 1e-9);
}

}  // namespace
}  // namespace limpid
