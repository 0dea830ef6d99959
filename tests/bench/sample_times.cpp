#include "tests/bench/sample_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace limpid::bench {

double SampleTimes::quantile(double share) const {
  std::vector<double> sorted = seconds_;
  const auto last = static_cast<double>(sorted.size() - 1);
  const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(std::floor(share * last));
  std::nth_element(sorted.begin(), at, sorted.end());
  return 1e6 * *at;
}

std::string table_head() {
  return fmt::format("{:<34}{:>9}{:>9}{:>9}{:>10}{:>12}\n", "one tick of 1 ms, times in us",
                     "median", "p99", "p99.9", "max", "yardsticks");
}

std::string table_line(const std::string& what, const SampleTimes& times,
                       const SampleTimes* yardstick) {
  const double median = times.quantile(0.5);
  const std::string ratio =
      yardstick ? fmt::format("{:.2f}", median / yardstick->quantile(0.5)) : "";
  return fmt::format("{:<34}{:>9.2f}{:>9.2f}{:>9.2f}{:>10.1f}{:>12}\n", what, median,
                     times.quantile(0.99), times.quantile(0.999), times.quantile(1), ratio);
}

}  // namespace limpid::bench
