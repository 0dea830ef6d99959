// The one thread that must not wait: runs the tick once a period, as punctually as it is allowed.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "core/realtime/clock.h"
#include "core/realtime/latency.h"
#include "core/realtime/realtime.h"

namespace limpid {

struct TickTiming {
  std::int64_t tick;    // 0, 1, 2, ..., none left out
  double wake_latency;  // how long after its deadline the tick began [s]
  int periods = 1;      // since the tick before: more than 1 where ticks were given up
  double dt = 0;        // the same as it really passed, 0 for the first [s]
};

// What becomes of ticks that are late.
enum class Overdue : std::uint8_t {
  run,      // back to back, as far as Clock allows: one tick is one period of the world
  given_up  // for real motors
};

struct LoopStatus {
  bool running = false;
  std::string failure;     // what an exception said that stopped the loop; else empty
  double rate = 0;         // over the last second [Hz]; 0 when not running or stuck in a tick
  std::int64_t ticks = 0;  // that have begun since start(); the others as in ClockCounts
  std::int64_t late = 0;
  std::int64_t missed = 0;
  std::int64_t slipped = 0;
  RealtimeReport realtime;
};

// The thread lives as long as the object and rests between stop() and start(): what scheduling it
// has is settled once, in time for the caller to call yield_to_haptics() before OpenGL's threads
// come. All functions belong to the owner's thread, except for status() and the histograms, which
// are anybody's.
class HapticThread {
 public:
  using Body = std::function<void(const TickTiming&)>;

  // ask: see become_realtime(); called in the new thread. Throws std::system_error when there can
  // be no thread.
  explicit HapticThread(AskForPriority ask = {});
  ~HapticThread();  // stops

  // Runs `body` every period from now on; stops what ran before. Counts and histograms begin anew.
  // body: must not throw; if it does all the same the loop stops and status() tells why.
  void start(nanoseconds period, Body body, Overdue overdue = Overdue::run);

  // Returns when the last tick is over. Not to be called from within a tick.
  void stop();

  LoopStatus status() const;
  const LatencyHistogram& wake_latency() const { return wake_latency_; }
  const LatencyHistogram& compute_time() const { return compute_time_; }

 private:
  enum class Phase : std::uint8_t { settling, resting, running, quitting };

  void live(const AskForPriority& ask);
  std::string run_until_failure_or_stop() noexcept;
  void run();
  void publish(const Wake& wake, const ClockCounts& counts, double rate) noexcept;
  void forget_last_run() noexcept;

  // Under the mutex, which the thread never takes between two ticks.
  mutable std::mutex mutex_;
  std::condition_variable phase_changed_;
  Phase phase_ = Phase::settling;
  RealtimeReport realtime_;
  std::string failure_;

  // The owner's while the thread rests, the thread's while it runs.
  nanoseconds period_{0};
  Overdue overdue_ = Overdue::run;
  Body body_;

  // Both threads' at any time. Nothing hangs on the order of these numbers, hence relaxed.
  std::atomic<bool> stop_requested_{false};
  std::atomic<std::int64_t> ticks_{0};
  std::atomic<std::int64_t> late_{0};
  std::atomic<std::int64_t> missed_{0};
  std::atomic<std::int64_t> slipped_{0};
  std::atomic<double> rate_{0};
  std::atomic<nanoseconds> last_wake_{nanoseconds{0}};
  LatencyHistogram wake_latency_;
  LatencyHistogram compute_time_;

  std::thread thread_;
};

}  // namespace limpid
