#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/sweep/read_axes.h"

namespace limpid {
namespace {

double round_the_circle(double x) { return x - std::floor(x); }

TEST(Sampling, OfALatinHypercubeHasOneValueInEachInterval) {
  constexpr std::size_t count = 37;
  for (const auto& dimension : latin_samples(5, count, 3)) {
    std::set<int> intervals;
    for (const double x : dimension) intervals.insert(static_cast<int>(x * count));
    EXPECT_EQ(intervals.size(), count);
    EXPECT_EQ(*intervals.begin(), 0);
    EXPECT_EQ(*intervals.rbegin(), static_cast<int>(count) - 1);
  }
}

// The first points of the sequence by Joe and Kuo, in Gray's order, with the shift undone.
TEST(Sampling, OfSobolIsHisSequenceTurnedRound) {
  const UnitSamples samples = sobol_samples(2, 7, 11);
  const double first[] = {0.5, 0.75, 0.25, 0.375, 0.875, 0.625, 0.125};
  const double second[] = {0.5, 0.25, 0.75, 0.375, 0.875, 0.125, 0.625};
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_NEAR(round_the_circle(samples[0][i] - samples[0][0] + 0.5), first[i], 1e-12);
    EXPECT_NEAR(round_the_circle(samples[1][i] - samples[1][0] + 0.5), second[i], 1e-12);
  }
}

TEST(Sampling, IsTheSameForOneSeedAndNotForAnother) {
  for (const auto draw : {&random_samples, &latin_samples, &sobol_samples}) {
    EXPECT_EQ(draw(3, 20, 5), draw(3, 20, 5));
    EXPECT_NE(draw(3, 20, 5), draw(3, 20, 6));
    for (const auto& dimension : draw(3, 500, 5)) {
      EXPECT_GE(std::ranges::min(dimension), 0);
      EXPECT_LE(std::ranges::max(dimension), 1);
      double sum = 0;
      for (const double x : dimension) sum += x;
      EXPECT_NEAR(sum / 500, 0.5, 4 / std::sqrt(12 * 500.0));
    }
  }
}

// Spearman's rank correlation of independent orders has the deviation 1 / sqrt(n - 1).
TEST(Sampling, OfALatinHypercubePutsEachDimensionInAnOrderOfItsOwn) {
  constexpr std::size_t count = 101, dimensions = 4;
  const UnitSamples samples = latin_samples(dimensions, count, 3);
  const auto rank = [&](std::size_t d, std::size_t i) { return std::floor(samples[d][i] * count); };
  for (std::size_t a = 0; a < dimensions; ++a) {
    // The samples' own order is not that of a dimension, either.
    for (std::size_t b = a + 1; b <= dimensions; ++b) {
      double off = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const double other = b < dimensions ? rank(b, i) : static_cast<double>(i);
        off += std::pow(rank(a, i) - other, 2);
      }
      const double n = count, correlation = 1 - 6 * off / (n * (n * n - 1));
      EXPECT_LT(std::abs(correlation), 4 / std::sqrt(n - 1)) << a << ", " << b;
    }
  }
}

}  // namespace
}  // namespace limpid
