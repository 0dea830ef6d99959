// The one thread that must not wait: it runs the tick once a period, as punctually as the system
// allows.
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
  double wake_latency;  // from the deadline to the tick's begin [s]
  int periods = 1;      // since the previous tick: more than 1 where ticks were given up
  double dt = 0;        // measured time since the previous tick, 0 for the first [s]
};

// Treatment of late ticks.
enum class Overdue : std::uint8_t {
  run,      // they run back to back, as far as Clock allows: one tick is one period of the world
  given_up  // they are left out: for real motors
};

struct LoopStatus {
  bool running = false;
  std::string failure;     // text of the exception that stopped the loop, or empty
  double rate = 0;         // over the last second [Hz]; 0 when not running or stuck in a tick
  std::int64_t ticks = 0;  // begun since start(); the next three as in ClockCounts
  std::int64_t late = 0;
  std::int64_t missed = 0;
  std::int64_t slipped = 0;
  RealtimeReport realtime;
};

// The thread lives as long as the object and rests between stop() and start(). Its scheduling is
// settled once, so the caller can call yield_to_haptics() before OpenGL's threads come. All
// functions belong to the owner's thread; any thread may call status() and read the histograms.
class HapticThread {
 public:
  using Body = std::function<void(const TickTiming&)>;

  // ask: see become_realtime(); called in the new thread. Errors: std::system_error if no thread
  // can be made.
  explicit HapticThread(AskForPriority ask = {});
  ~HapticThread();  // stops

  // Runs `body` every period from now on; stops an earlier one. Counts and histograms begin anew.
  // body: must not throw; if it does the loop stops and status() tells why.
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

  // Guarded by the mutex, which the thread never takes between two ticks.
  mutable std::mutex mutex_;
  std::condition_variable phase_changed_;
  Phase phase_ = Phase::settling;
  RealtimeReport realtime_;
  std::string failure_;

  // Used by the owner while the thread rests, by the thread while it runs.
  nanoseconds period_{0};
  Overdue overdue_ = Overdue::run;
  Body body_;

  // Used by both threads at any time, relaxed because no order between these numbers matters.
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
