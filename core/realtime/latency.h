// A histogram of short times, written by the haptic thread and read by the window, without locks.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>

namespace limpid {

// Bins grow by 6 % each, from 1 us to 100 ms; one more bin on either side holds the values beyond.
//
// Every counter is atomic by itself; their order does not matter, hence relaxed. A reader may see a
// tick in one counter and not yet in another, which shifts a quantile by one tick.
class LatencyHistogram {
 public:
  static constexpr int kBins = 200;
  static constexpr double kMinimum = 1e-6;  // [s]
  static constexpr double kMaximum = 0.1;   // [s]

  // Adds a time, from one thread. seconds: any; values that are not positive count as shorter than
  // 1 us.
  void add(double seconds) noexcept {
    bins_[bin(seconds)].fetch_add(1, std::memory_order_relaxed);
    double max = max_.load(std::memory_order_relaxed);
    while (seconds > max && !max_.compare_exchange_weak(max, seconds, std::memory_order_relaxed)) {
    }
  }

  // Number of times added; for any thread, at any time.
  std::uint64_t count() const noexcept {
    std::uint64_t sum = 0;
    for (const auto& b : bins_) sum += b.load(std::memory_order_relaxed);
    return sum;
  }

  // The longest time [s], exactly; 0 if there is none.
  double max() const noexcept { return max_.load(std::memory_order_relaxed); }

  // A time [s] that the share p, 0 to 1, of all times did not exceed: the upper edge of a bin, at
  // most 6 % too much, and never above max(); 0 if there is none.
  double quantile(double p) const noexcept {
    const std::uint64_t total = count();
    if (total == 0) return 0;
    const double wanted = std::max(1.0, std::ceil(p * static_cast<double>(total)));
    std::uint64_t seen = 0;
    for (int i = 0; i <= kBins; ++i) {
      seen += bins_[static_cast<std::size_t>(i)].load(std::memory_order_relaxed);
      if (static_cast<double>(seen) >= wanted) return std::min(upper_edge(i), max());
    }
    return max();
  }

  void reset() noexcept {
    for (auto& b : bins_) b.store(0, std::memory_order_relaxed);
    max_.store(0, std::memory_order_relaxed);
  }

  // Number of times in bin i, and the bin's upper edge [s]; i = 0 to kBins + 1, the last one has no
  // edge.
  std::uint64_t count_in(int i) const noexcept {
    return bins_[static_cast<std::size_t>(i)].load(std::memory_order_relaxed);
  }
  static double upper_edge(int i) noexcept {
    return kMinimum * std::pow(kMaximum / kMinimum, static_cast<double>(i) / kBins);
  }

 private:
  // First bin whose upper edge is not below `seconds`.
  static std::size_t bin(double seconds) noexcept {
    if (!(seconds > kMinimum)) return 0;
    if (seconds > kMaximum) return kBins + 1;
    const double decades = std::log10(seconds / kMinimum);
    const double all = std::log10(kMaximum / kMinimum);
    return std::min<std::size_t>(static_cast<std::size_t>(std::ceil(kBins * decades / all)), kBins);
  }

  std::array<std::atomic<std::uint64_t>, kBins + 2> bins_{};
  std::atomic<double> max_{0};
};

}  // namespace limpid
