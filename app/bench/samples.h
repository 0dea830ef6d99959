// Times of many runs of the same thing, and what they amount to.
#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

namespace limpid::bench {

class Samples {
 public:
  explicit Samples(std::size_t expected) { values_.reserve(expected); }

  // Runs `work` once and keeps how long it took [us].
  template <class Work>
  void time(Work&& work) {
    const auto began = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - began;
    add(took.count());
  }
  void add(double value) { values_.push_back(value); }

  // What a share of all values stays below, 0.5 the median, 1 the largest; there must be one.
  double quantile(double share) const;

 private:
  std::vector<double> values_;
};

}  // namespace limpid::bench
