#include "app/experiments/high_pass.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace limpid {
namespace {

// What is left of a sine of amplitude 1 once the filter has settled.
double gain(HighPass filter, double frequency, double rate) {
  const double seconds = 4;
  double most = 0;
  for (int k = 0; k < seconds * rate; ++k) {
    const double y = filter(std::sin(2 * std::numbers::pi * frequency * k / rate));
    if (k > seconds / 2 * rate) most = std::max(most, std::abs(y));
  }
  return most;
}

TEST(HighPass, IsButterworthsOfFourthOrder) {
  const double rate = 1000, corner = 20;
  for (const double f : {3.0, 8.0, 20.0, 35.0, 100.0}) {
    // The bilinear transform bends the axis of frequencies.
    const double w = std::tan(std::numbers::pi * f / rate);
    const double c = std::tan(std::numbers::pi * corner / rate);
    const double expected = 1 / std::sqrt(1 + std::pow(c / w, 8));
    EXPECT_NEAR(gain(HighPass(corner, rate), f, rate), expected, 2e-3 + 0.01 * expected) << f;
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
