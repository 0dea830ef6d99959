#include "core/realtime/latency.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <thread>
#include <vector>

namespace limpid {
namespace {

TEST(LatencyHistogram, IsZeroWhenEmpty) {
  const LatencyHistogram histogram;
  EXPECT_EQ(histogram.count(), 0u);
  EXPECT_EQ(histogram.quantile(0.5), 0);
  EXPECT_EQ(histogram.max(), 0);
}

TEST(LatencyHistogram, HasBinsFromOneMicrosecondToATenthOfASecond) {
  EXPECT_NEAR(LatencyHistogram::upper_edge(0), 1e-6, 1e-15);
  EXPECT_NEAR(LatencyHistogram::upper_edge(LatencyHistogram::kBins), 0.1, 1e-10);
}

TEST(LatencyHistogram, PutsEveryTimeBetweenTheEdgesOfItsBin) {
  for (double t = 1.5e-6; t < 0.1; t *= 1.0071) {
    LatencyHistogram histogram;
    histogram.add(t);
    int bin = 0;
    while (histogram.count_in(bin) == 0) ++bin;
    EXPECT_LE(t, histogram.upper_edge(bin) * (1 + 1e-12));
    EXPECT_GT(t, histogram.upper_edge(bin - 1) * (1 - 1e-12));
  }
}

TEST(LatencyHistogram, AgreesWithTheSortedTimesToSixPercent) {
  std::mt19937 random(1);
  std::lognormal_distribution<double> times(std::log(50e-6), 1.2);
  std::vector<double> all(20'001);
  LatencyHistogram histogram;
  for (double& t : all) histogram.add(t = times(random));
  std::ranges::sort(all);
  EXPECT_EQ(histogram.count(), all.size());
  EXPECT_EQ(histogram.max(), all.back());
  for (const double p : {0.1, 0.5, 0.9, 0.99, 0.999}) {
    const double exact = all[static_cast<std::size_t>(std::ceil(p * 20'001)) - 1];
    EXPECT_GE(histogram.quantile(p), exact * (1 - 1e-12)) << p;
    EXPECT_LE(histogram.quantile(p), exact * 1.06) << p;
  }
  EXPECT_EQ(histogram.quantile(1), all.back());
}

TEST(LatencyHistogram, KeepsTimesBeyondItsBins) {
  LatencyHistogram histogram;
  histogram.add(0);
  histogram.add(-1);
  histogram.add(3e-8);
  EXPECT_EQ(histogram.count_in(0), 3u);
  EXPECT_EQ(histogram.quantile(1), 3e-8);
  histogram.add(2.5);
  EXPECT_EQ(histogram.count_in(LatencyHistogram::kBins + 1), 1u);
  EXPECT_EQ(histogram.max(), 2.5);
  EXPECT_EQ(histogram.quantile(1), 2.5);
}

TEST(LatencyHistogram, ForgetsEverythingOnReset) {
  LatencyHistogram histogram;
  histogram.add(1e-3);
  histogram.reset();
  EXPECT_EQ(histogram.count(), 0u);
  EXPECT_EQ(histogram.max(), 0);
}

TEST(LatencyHistogram, LosesNothingWhileAnotherThreadReads) {
  constexpr std::uint64_t kTimes = 100'000;
  LatencyHistogram histogram;
  std::thread writer([&] {
    for (std::uint64_t i = 0; i < kTimes; ++i) histogram.add(1e-6 * static_cast<double>(i % 1000));
  });
  std::uint64_t before = 0;
  while (before < kTimes) {
    const std::uint64_t now = histogram.count();
    ASSERT_GE(now, before);
    ASSERT_LE(histogram.quantile(0.99), 1e-3);
    before = now;
  }
  writer.join();
  EXPECT_EQ(histogram.count(), kTimes);
}

}  // namespace
}  // namespace limpid
