#include "core/realtime/haptic_thread.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <future>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace limpid {
namespace {

using namespace std::chrono_literals;

// Waits until the loop has stopped by itself.
LoopStatus wait_for_the_end(const HapticThread& haptics) {
  while (haptics.status().running) std::this_thread::yield();
  return haptics.status();
}

TEST(HapticThread, RunsTheBodyTickByTickUntilStopped) {
  std::vector<TickTiming> ticks;
  std::promise<void> enough;
  HapticThread haptics;
  haptics.start(1ms, [&](const TickTiming& timing) {
    ticks.push_back(timing);
    if (timing.tick == 50) enough.set_value();
  });
  EXPECT_TRUE(haptics.status().running);
  enough.get_future().wait();
  haptics.stop();

  const LoopStatus status = haptics.status();
  EXPECT_FALSE(status.running);
  EXPECT_EQ(status.failure, "");
  EXPECT_EQ(status.rate, 0);
  ASSERT_GE(ticks.size(), 51u);
  EXPECT_EQ(status.ticks, static_cast<std::int64_t>(ticks.size()));
  EXPECT_EQ(haptics.wake_latency().count(), ticks.size());
  EXPECT_EQ(haptics.compute_time().count(), ticks.size());
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    EXPECT_EQ(ticks[k].tick, static_cast<std::int64_t>(k));
    EXPECT_GE(ticks[k].wake_latency, 0);
  }
}

TEST(HapticThread, DoesNotTickAfterStop) {
  std::atomic<int> ticks{0};
  HapticThread haptics;
  haptics.start(100us, [&](const TickTiming&) { ++ticks; });
  while (ticks == 0) std::this_thread::yield();
  haptics.stop();
  const int before = ticks;
  std::this_thread::sleep_for(5ms);
  EXPECT_EQ(ticks, before);
}

TEST(HapticThread, StopsOnAnExceptionAndKeepsItsMessage) {
  HapticThread haptics;
  haptics.start(1ms, [](const TickTiming& timing) {
    if (timing.tick == 3) throw std::runtime_error("joint 2: position is not a number");
  });
  const LoopStatus status = wait_for_the_end(haptics);
  EXPECT_EQ(status.failure, "joint 2: position is not a number");
  EXPECT_EQ(status.ticks, 4);
  haptics.stop();
  EXPECT_EQ(haptics.status().failure, status.failure);
}

TEST(HapticThread, StopsOnAnExceptionOfNoKnownKind) {
  HapticThread haptics;
  haptics.start(1ms, [](const TickTiming&) { throw 42; });
  EXPECT_FALSE(wait_for_the_end(haptics).failure.empty());
}

TEST(HapticThread, BeginsAnewAfterAFailure) {
  std::promise<std::int64_t> first;
  HapticThread haptics;
  haptics.start(1ms, [](const TickTiming&) { throw std::runtime_error("no"); });
  wait_for_the_end(haptics);
  haptics.start(1ms, [&, told = false](const TickTiming& timing) mutable {
    if (!told) first.set_value(timing.tick);
    told = true;
  });
  EXPECT_EQ(first.get_future().get(), 0);
  EXPECT_TRUE(haptics.status().running);
  EXPECT_EQ(haptics.status().failure, "");
}

TEST(HapticThread, ReplacesTheBodyThatRanBefore) {
  std::atomic<int> first{0};
  std::atomic<int> second{0};
  HapticThread haptics;
  haptics.start(100us, [&](const TickTiming&) { ++first; });
  while (first == 0) std::this_thread::yield();
  haptics.start(100us, [&](const TickTiming&) { ++second; });
  const int before = first;
  while (second < 10) std::this_thread::yield();
  EXPECT_EQ(first, before);
}

TEST(HapticThread, StopsWhenItIsDestroyed) {
  int ticks = 0;
  {
    std::promise<void> begun;
    HapticThread haptics;
    haptics.start(1ms, [&](const TickTiming& timing) {
      ++ticks;
      if (timing.tick == 0) begun.set_value();
    });
    begun.get_future().wait();
  }
  EXPECT_GE(ticks, 1);
}

TEST(HapticThread, MayBeStoppedAtAnyTime) {
  HapticThread haptics;
  haptics.stop();
  for (int i = 0; i < 20; ++i) {
    haptics.start(1ms, [](const TickTiming&) {});
    haptics.stop();
    haptics.stop();
  }
  EXPECT_FALSE(haptics.status().running);
}

TEST(HapticThread, RefusesAPeriodThatIsNotPositive) {
  HapticThread haptics;
  EXPECT_THROW(haptics.start(0ns, [](const TickTiming&) {}), std::invalid_argument);
}

TEST(HapticThread, ReportsTheSchedulingItReallyHas) {
  std::promise<std::pair<int, int>> scheduling;
  HapticThread haptics;
  haptics.start(1ms, [&](const TickTiming& timing) {
    if (timing.tick > 0) return;
    int policy = 0;
    sched_param param{};
    pthread_getschedparam(pthread_self(), &policy, &param);
    scheduling.set_value({policy, param.sched_priority});
  });
  const auto [policy, priority] = scheduling.get_future().get();
  const RealtimeReport report = haptics.status().realtime;
  EXPECT_EQ(report.realtime(), policy == SCHED_FIFO || policy == SCHED_RR);
  EXPECT_EQ(report.priority, priority);
  EXPECT_FALSE(report.explanation.empty());
}

// A process without privileges must ask, and gets nothing without a limit of its time.
TEST(BecomeRealtime, LimitsItsTimeBeforeItAsks) {
  const pid_t child = fork();
  if (child == 0) {
    const rlimit none{0, 0}, endless{RLIM_INFINITY, RLIM_INFINITY};
    setrlimit(RLIMIT_RTTIME, &endless);
    setrlimit(RLIMIT_RTPRIO, &none);
    if (geteuid() == 0 && setuid(65534) != 0) _exit(2);
    bool limited = false;
    const RealtimeReport report = become_realtime([&](pid_t, int) {
      rlimit limit{};
      getrlimit(RLIMIT_RTTIME, &limit);
      limited = limit.rlim_cur <= 200'000;
      return true;
    });
    _exit(limited && report.scheduling == Scheduling::rtkit ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(YieldToHaptics, PutsTheCallingThreadAndItsChildrenBehindAllOthers) {
  std::thread([] {
    ASSERT_TRUE(yield_to_haptics());
    EXPECT_EQ(sched_getscheduler(0), SCHED_IDLE);
    std::thread([] { EXPECT_EQ(sched_getscheduler(0), SCHED_IDLE); }).join();
  }).join();
}

TEST(HapticThread, TellsEachTickHowManyPeriodsHavePassed) {
  std::atomic<std::int64_t> periods = 0, ticks = 0, stalls = 0;
  HapticThread haptics;
  haptics.start(
      1ms,
      [&](const TickTiming& timing) {
        if (timing.tick == 0) {
          EXPECT_EQ(timing.dt, 0);
        } else {
          periods += timing.periods;
          EXPECT_GT(timing.dt, 0);
        }
        if (ticks++ % 20 != 10 || stalls == 3) return;
        ++stalls;
        std::this_thread::sleep_for(30ms);
      },
      Overdue::given_up);
  while (ticks < 100) std::this_thread::sleep_for(1ms);
  haptics.stop();
  const LoopStatus status = haptics.status();
  EXPECT_EQ(periods, status.ticks - 1 + status.slipped);
  EXPECT_GE(status.slipped, 3 * 28);
}

TEST(HapticThread, SaysThatNothingRunsWhileItIsStuckInATick) {
  std::atomic<bool> stuck = false, go_on = false;
  HapticThread haptics;
  haptics.start(1ms, [&](const TickTiming& timing) {
    if (timing.tick < 400) return;
    stuck = true;
    while (!go_on) std::this_thread::sleep_for(1ms);
  });
  while (!stuck) std::this_thread::sleep_for(1ms);
  EXPECT_GT(haptics.status().rate, 0);
  std::this_thread::sleep_for(1200ms);
  EXPECT_EQ(haptics.status().rate, 0);
  EXPECT_TRUE(haptics.status().running);
  go_on = true;
}

TEST(HapticThread, CountsAnewAtEachStartAndKeepsTheCountsAfterTheEnd) {
  std::atomic<std::int64_t> ticks = 0;
  HapticThread haptics;
  haptics.start(100us, [&](const TickTiming&) {
    if (++ticks == 10) std::this_thread::sleep_for(20ms);
  });
  while (ticks < 500) std::this_thread::sleep_for(1ms);
  haptics.stop();
  const LoopStatus ended = haptics.status();
  EXPECT_FALSE(ended.running);
  EXPECT_EQ(ended.ticks, ticks);
  EXPECT_GE(ended.missed, 1);
  EXPECT_EQ(ended.rate, 0);
  EXPECT_EQ(haptics.wake_latency().count(), static_cast<std::uint64_t>(ended.ticks));
  std::promise<std::int64_t> first;
  haptics.start(1s, [&](const TickTiming& timing) {
    if (timing.tick == 0) first.set_value(haptics.status().ticks);
  });
  EXPECT_EQ(first.get_future().get(), 1);
  EXPECT_EQ(haptics.wake_latency().count(), 1u);
  haptics.stop();
}

}  // namespace
}  // namespace limpid
