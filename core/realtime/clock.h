// The schedule of ticks: tick k is due at start + k T, to the nanosecond, for ever.
//
// Deadlines are never set from "now", so nothing adds up to a drift, and one tick is always one T.
// After a stall missed ticks run back to back, without sleeping, until the schedule is met again.
// At most kMaxCatchUp ticks run so, for at most as many periods. Ticks still overdue then are given
// up: the schedule slips, all later deadlines move by whole periods. Where ticks move motors,
// missed ones are given up at once.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace limpid {

using std::chrono::nanoseconds;

// CLOCK_MONOTONIC. Clock takes any class with the same two functions in its place.
struct MonotonicTime {
  nanoseconds now() const noexcept;
  void sleep_until(nanoseconds moment) const noexcept;  // returns at once if it has passed
};

inline double in_seconds(nanoseconds time) { return std::chrono::duration<double>(time).count(); }

struct Wake {
  std::int64_t tick;    // 0, 1, 2, ..., none left out
  nanoseconds moment;   // when the tick began
  nanoseconds latency;  // from the deadline to `moment`, slips not deducted
};

struct ClockCounts {
  std::int64_t late = 0;     // ticks that began more than Clock::kLate after their deadline
  std::int64_t missed = 0;   // late ticks that began after the next deadline
  std::int64_t slipped = 0;  // periods by which the schedule has moved
};

template <class Time = MonotonicTime>
class Clock {
 public:
  static constexpr nanoseconds kLate{200'000};
  static constexpr std::int64_t kMaxCatchUp = 20;  // ticks, and periods
  static constexpr nanoseconds kSpin{100'000};

  // start: deadline of tick 0; period: T > 0; catch_up: how many ticks may run back to back, 0 to
  // kMaxCatchUp. spin: how long before a deadline sleeping ends and watching the clock begins.
  // kSpin pays for motors under real-time scheduling; otherwise spinning does harm: 0.
  Clock(nanoseconds start, nanoseconds period, nanoseconds spin, Time time = {},
        std::int64_t catch_up = kMaxCatchUp)
      : deadline_(start), period_(period), spin_(spin), catch_up_(catch_up), time_(time) {}

  // Waits for the next tick's deadline.
  Wake wait() noexcept {
    const nanoseconds due = deadline_;
    nanoseconds now = wait_for_deadline();
    slip(now);
    if (now < deadline_) now = wait_for_deadline();
    count(now - due);
    deadline_ += period_;
    ++series_ticks_;
    return {tick_++, now, now - due};
  }

  nanoseconds next_deadline() const noexcept { return deadline_; }
  const ClockCounts& counts() const noexcept { return counts_; }

 private:
  // Returns the time at or after the deadline. Too near a deadline for spinning, it sleeps right up
  // to it: a real-time thread that never sleeps takes the processor from everybody.
  nanoseconds wait_for_deadline() noexcept {
    nanoseconds now = time_.now();
    if (now >= deadline_) {
      if (series_ticks_ <= 1) catch_up_start_ = now;
      return now;
    }
    time_.sleep_until(deadline_ - now > spin_ ? deadline_ - spin_ : deadline_);
    do now = time_.now();
    while (now < deadline_);
    catch_up_start_ = now;
    series_ticks_ = 0;
    return now;
  }

  // Moves the schedule when catching up takes too many ticks or too much time: ticks longer than a
  // period never catch up.
  void slip(nanoseconds now) noexcept {
    const std::int64_t overdue = (now - deadline_) / period_ + 1;
    const std::int64_t series = std::max(series_ticks_, (now - catch_up_start_) / period_);
    const std::int64_t allowed = std::max<std::int64_t>(1 + catch_up_ - series, 0);
    const std::int64_t given_up = std::max<std::int64_t>(overdue - allowed, 0);
    deadline_ += given_up * period_;
    counts_.slipped += given_up;
  }

  void count(nanoseconds latency) noexcept {
    if (latency > kLate) ++counts_.late;
    if (latency >= period_) ++counts_.missed;
  }

  nanoseconds deadline_;
  nanoseconds period_;
  nanoseconds spin_;
  std::int64_t catch_up_;
  Time time_;
  std::int64_t tick_ = 0;
  std::int64_t series_ticks_ = 0;  // since the last sleep: its tick, then those catching up
  nanoseconds catch_up_start_{0};
  ClockCounts counts_;
};

}  // namespace limpid
