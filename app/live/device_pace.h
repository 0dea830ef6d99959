// Punctuality of a device's reports: written by the loop, read by the window.
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>

#include "core/realtime/latency.h"

namespace limpid {

class DevicePace {
 public:
  struct Figures {
    std::uint64_t intervals = 0;  // between successive readings, so far
    double mean = 0;              // of the intervals [s]
    double jitter = 0;            // their standard deviation [s]
    double rate = 0;              // readings a second, also those between two ticks
  };

  // Begins anew, for another device or the same one. For the loop, like note().
  void start() noexcept {
    known_ = false;
    count_ = 0;
    intervals_.reset();
    readings_ = singles_ = 0;
    heard_ = sum_ = squares_ = 0;
  }
  // Notes at a tick the number of readings so far; the newest is `age` old at `now` [s]. Of several
  // readings since the last tick only the number is known.
  void note(std::uint64_t count, double age, double now) noexcept {
    const double arrived = now - age;
    if (known_ && count > count_) {
      const double interval = arrived - arrived_;
      add(readings_, count - count_);
      add(heard_, interval);
      if (count == count_ + 1) {
        add(singles_, std::uint64_t{1});
        add(sum_, interval);
        add(squares_, interval * interval);
        intervals_.add(interval);
      }
    }
    if (known_ && count == count_) return;
    known_ = count > 0;
    count_ = count;
    arrived_ = arrived;
  }

  // For any thread; a reading may be in one value and not yet in another.
  const LatencyHistogram& intervals() const { return intervals_; }
  Figures figures() const noexcept {
    Figures f;
    f.intervals = singles_.load(std::memory_order_relaxed);
    if (f.intervals == 0) return f;
    const auto n = static_cast<double>(f.intervals);
    f.mean = sum_.load(std::memory_order_relaxed) / n;
    f.jitter =
        std::sqrt(std::max(0.0, squares_.load(std::memory_order_relaxed) / n - f.mean * f.mean));
    const double heard = heard_.load(std::memory_order_relaxed);
    f.rate = heard > 0 ? static_cast<double>(readings_.load(std::memory_order_relaxed)) / heard : 0;
    return f;
  }

 private:
  // Adds without a lock: only one thread writes.
  template <class T>
  static void add(std::atomic<T>& to, T value) noexcept {
    to.store(to.load(std::memory_order_relaxed) + value, std::memory_order_relaxed);
  }

  LatencyHistogram intervals_;
  std::atomic<std::uint64_t> readings_{0}, singles_{0};
  std::atomic<double> heard_{0}, sum_{0}, squares_{0};
  // Used by the loop alone.
  bool known_ = false;
  std::uint64_t count_ = 0;
  double arrived_ = 0;
};

}  // namespace limpid
