// Times of many runs of the same thing, and what they amount to.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace limpid::bench {

class SampleTimes {
 public:
  explicit SampleTimes(std::size_t expected) { seconds_.reserve(expected); }

  // Runs `work` once and keeps how long it took.
  template <class Work>
  void time(Work&& work) {
    const auto began = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
    seconds_.push_back(took.count());
  }

  // The time that a share of all runs stays below, 0.5 the median, 1 the longest [us].
  double quantile(double share) const;

 private:
  std::vector<double> seconds_;
};

// One line of the table: median, p99, p99.9, longest, and the median over that of `yardstick`.
std::string table_line(const std::string& what, const SampleTimes& times,
                       const SampleTimes* yardstick);
std::string table_head();

}  // namespace limpid::bench
