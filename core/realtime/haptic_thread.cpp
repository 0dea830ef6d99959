#include "core/realtime/haptic_thread.h"

#include <pthread.h>

#include <array>
#include <cstddef>
#include <exception>
#include <stdexcept>
#include <utility>

namespace limpid {
namespace {

constexpr auto relaxed = std::memory_order_relaxed;
constexpr nanoseconds kSecond{1'000'000'000};

// Ticks per second over the last second, updated ten times a second.
class RateMeter {
 public:
  explicit RateMeter(nanoseconds start) : newest_(start) { marks_.fill({start, 0}); }

  double update(const Wake& wake) noexcept {
    if (wake.moment - newest_ < kSecond / 10) return rate_;
    Mark& oldest = marks_[next_];
    rate_ = static_cast<double>(wake.tick - oldest.tick) / in_seconds(wake.moment - oldest.moment);
    oldest = {wake.moment, wake.tick};
    newest_ = wake.moment;
    next_ = (next_ + 1) % marks_.size();
    return rate_;
  }

 private:
  struct Mark {
    nanoseconds moment;
    std::int64_t tick;
  };
  std::array<Mark, 10> marks_;
  std::size_t next_ = 0;
  nanoseconds newest_;
  double rate_ = 0;
};

}  // namespace

HapticThread::HapticThread(AskForPriority ask)
    : thread_([this, asking = std::move(ask)] { live(asking); }) {
  std::unique_lock lock(mutex_);
  phase_changed_.wait(lock, [this] { return phase_ == Phase::resting; });
}

HapticThread::~HapticThread() {
  stop();
  {
    const std::lock_guard lock(mutex_);
    phase_ = Phase::quitting;
  }
  phase_changed_.notify_all();
  thread_.join();
}

void HapticThread::start(nanoseconds period, Body body, Overdue overdue) {
  if (period <= nanoseconds::zero())
    throw std::invalid_argument("the haptic thread's period must be positive");
  stop();
  period_ = period;
  overdue_ = overdue;
  body_ = std::move(body);
  forget_last_run();
  {
    const std::lock_guard lock(mutex_);
    failure_.clear();
    phase_ = Phase::running;
  }
  phase_changed_.notify_all();
}

void HapticThread::stop() {
  stop_requested_.store(true, relaxed);
  std::unique_lock lock(mutex_);
  phase_changed_.wait(lock, [this] { return phase_ == Phase::resting; });
  stop_requested_.store(false, relaxed);
}

LoopStatus HapticThread::status() const {
  LoopStatus status;
  {
    const std::lock_guard lock(mutex_);
    status.running = phase_ == Phase::running;
    status.failure = failure_;
    status.realtime = realtime_;
  }
  const bool alive = MonotonicTime{}.now() - last_wake_.load(relaxed) < kSecond;
  status.rate = status.running && alive ? rate_.load(relaxed) : 0;
  status.ticks = ticks_.load(relaxed);
  status.late = late_.load(relaxed);
  status.missed = missed_.load(relaxed);
  status.slipped = slipped_.load(relaxed);
  return status;
}

void HapticThread::live(const AskForPriority& ask) {
  pthread_setname_np(pthread_self(), "haptics");
  RealtimeReport report = become_realtime(ask);

  std::unique_lock lock(mutex_);
  realtime_ = std::move(report);
  while (phase_ != Phase::quitting) {
    phase_ = Phase::resting;
    phase_changed_.notify_all();
    phase_changed_.wait(lock, [this] { return phase_ != Phase::resting; });
    if (phase_ != Phase::running) continue;
    lock.unlock();
    std::string failure = run_until_failure_or_stop();
    lock.lock();
    failure_ = std::move(failure);
  }
}

// Returns an exception's text and keeps it from ending the process: the motors have yet to be
// switched off elsewhere.
std::string HapticThread::run_until_failure_or_stop() noexcept {
  try {
    run();
    return {};
  } catch (const std::exception& e) {
    return e.what();
  } catch (...) {
    return "the tick ended with an unknown error";
  }
}

void HapticThread::run() {
  const MonotonicTime time;
  const nanoseconds start = time.now() + period_;
  // Watching the clock costs a tenth of a period, for microseconds that only motors can feel.
  const bool motors = overdue_ == Overdue::given_up;
  Clock<> clock(start, period_,
                motors && realtime_.realtime() ? Clock<>::kSpin : nanoseconds::zero(), time,
                motors ? 0 : Clock<>::kMaxCatchUp);
  RateMeter meter(start);
  nanoseconds before = start;
  std::int64_t slipped = 0;
  while (!stop_requested_.load(relaxed)) {
    const Wake wake = clock.wait();
    publish(wake, clock.counts(), meter.update(wake));
    const std::int64_t all_slipped = clock.counts().slipped;
    const auto periods = static_cast<int>(1 + all_slipped - std::exchange(slipped, all_slipped));
    const double dt = wake.tick == 0 ? 0 : in_seconds(wake.moment - before);
    before = wake.moment;
    body_({wake.tick, in_seconds(wake.latency), periods, dt});
    compute_time_.add(in_seconds(time.now() - wake.moment));
  }
}

void HapticThread::publish(const Wake& wake, const ClockCounts& counts, double rate) noexcept {
  wake_latency_.add(in_seconds(wake.latency));
  ticks_.store(wake.tick + 1, relaxed);
  late_.store(counts.late, relaxed);
  missed_.store(counts.missed, relaxed);
  slipped_.store(counts.slipped, relaxed);
  rate_.store(rate, relaxed);
  last_wake_.store(wake.moment, relaxed);
}

void HapticThread::forget_last_run() noexcept {
  publish({-1, MonotonicTime{}.now(), nanoseconds::zero()}, {}, 0);
  wake_latency_.reset();
  compute_time_.reset();
}

}  // namespace limpid
