#include "core/realtime/clock.h"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <thread>
#include <vector>

namespace limpid {
namespace {

using namespace std::chrono_literals;

// A world in which time passes only by sleeping, by reading the clock or by changing `now`.
struct World {
  nanoseconds now{0};
  nanoseconds look{0};                // time that reading the clock takes
  nanoseconds oversleep{0};           // delay of the end of every sleep
  std::vector<nanoseconds> sleeps{};  // their wanted ends
};

struct SimulatedTime {
  World* world;
  nanoseconds now() const { return world->now += world->look; }
  void sleep_until(nanoseconds moment) const {
    world->sleeps.push_back(moment);
    world->now = std::max(world->now, moment) + world->oversleep;
  }
};

using TestClock = Clock<SimulatedTime>;
constexpr nanoseconds kStart = 5s + 123'457ns;
constexpr nanoseconds kT = 1ms;

TestClock clock_in(World& world, nanoseconds period = kT, nanoseconds spin = 0ns) {
  return {kStart, period, spin, SimulatedTime{&world}};
}

// Number of ticks until the next sleep, at most `limit`.
int ticks_until_sleep(TestClock& clock, const World& world, int limit) {
  const auto sleeps = world.sleeps.size();
  int count = 0;
  while (count < limit) {
    clock.wait();
    if (world.sleeps.size() != sleeps) break;
    ++count;
  }
  return count;
}

TEST(Clock, SleepsUntilStartPlusKPeriodsToTheNanosecond) {
  World world{.oversleep = 17us};
  TestClock clock = clock_in(world, 333'333ns);
  for (std::int64_t k = 0; k < 100'000; ++k) {
    const Wake wake = clock.wait();
    ASSERT_EQ(wake.tick, k);
    ASSERT_EQ(world.sleeps.back(), kStart + k * 333'333ns);
    ASSERT_EQ(wake.latency, 17us);
    ASSERT_EQ(wake.moment, kStart + k * 333'333ns + 17us);
    world.now += 100us;
  }
  EXPECT_EQ(clock.counts().late, 0);
  EXPECT_EQ(clock.counts().missed, 0);
  EXPECT_EQ(clock.counts().slipped, 0);
}

TEST(Clock, DoesNotSleepForADeadlineThatHasPassed) {
  World world;
  TestClock clock = clock_in(world);
  clock.wait();
  world.now += 1200us;
  const Wake wake = clock.wait();
  EXPECT_EQ(world.sleeps.size(), 1u);
  EXPECT_EQ(wake.latency, 200us);
  clock.wait();
  EXPECT_EQ(world.sleeps.back(), kStart + 2 * kT);
}

TEST(Clock, CatchesUpAfterAStallAndKeepsTheSchedule) {
  World world;
  TestClock clock = clock_in(world);
  clock.wait();
  world.now += 13'500us;  // past the deadlines of ticks 1 to 13
  for (std::int64_t k = 1; k <= 13; ++k) {
    const Wake wake = clock.wait();
    ASSERT_EQ(wake.tick, k);
    ASSERT_EQ(wake.latency, 13'500us - k * kT);
    ASSERT_EQ(world.sleeps.size(), 1u);
  }
  EXPECT_EQ(clock.wait().latency, 0ns);
  EXPECT_EQ(world.sleeps.back(), kStart + 14 * kT);
  EXPECT_EQ(clock.counts().slipped, 0);
  EXPECT_EQ(clock.counts().missed, 12);  // tick 13 began before the deadline of tick 14
  EXPECT_EQ(clock.counts().late, 13);
}

TEST(Clock, CatchesUpOnExactlyTwentyTicksWithoutSlipping) {
  World world;
  TestClock clock = clock_in(world);
  clock.wait();
  world.now += 20'999us;
  EXPECT_EQ(ticks_until_sleep(clock, world, 100), 20);
  EXPECT_EQ(clock.counts().slipped, 0);
}

TEST(Clock, SlipsByWholePeriodsWhatTwentyTicksCannotCatchUp) {
  World world;
  TestClock clock = clock_in(world);
  clock.wait();
  world.now += 100'500us;  // past 100 deadlines
  const Wake first = clock.wait();
  EXPECT_EQ(first.tick, 1);
  EXPECT_EQ(first.latency, 99'500us);
  EXPECT_EQ(clock.counts().slipped, 80);
  EXPECT_EQ(ticks_until_sleep(clock, world, 100), 19);
  EXPECT_EQ(clock.counts().slipped, 80);
  // Tick 21 is due 80 periods later than planned, still on the grid.
  EXPECT_EQ(world.sleeps.back(), kStart + (21 + 80) * kT);
  EXPECT_EQ(clock.next_deadline(), kStart + (22 + 80) * kT);
}

TEST(Clock, LetsAStallWhileCatchingUpSlipRatherThanProlongTheSeries) {
  World world;
  TestClock clock = clock_in(world);
  clock.wait();
  world.now += 15'500us;  // past 15 deadlines
  for (int k = 1; k <= 10; ++k) clock.wait();
  world.now += 7ms;  // 5 + 7 overdue, with room for 10
  EXPECT_EQ(ticks_until_sleep(clock, world, 100), 10);
  EXPECT_EQ(clock.counts().slipped, 2);
}

TEST(Clock, SleepsAfterCatchingUpForTwentyPeriodsHoweverSlowTheTicksAre) {
  for (const nanoseconds compute :
       {nanoseconds(1050us), nanoseconds(1500us), nanoseconds(9ms), nanoseconds(60ms)}) {
    World world;
    TestClock clock = clock_in(world);
    clock.wait();
    for (int series = 0; series < 50; ++series) {
      const auto sleeps = world.sleeps.size();
      const nanoseconds begin = world.now;
      int ticks = 0;
      for (; world.sleeps.size() == sleeps; ++ticks) {
        ASSERT_LE(ticks, 20);
        world.now += compute;
        clock.wait();
      }
      // Bound: the tick before catching up, 20 periods, the last tick that began in time, and the
      // sleep at the end.
      EXPECT_LE(world.now - begin, compute + 20 * kT + compute + kT);
    }
  }
}

TEST(Clock, CountsEveryPeriodOfTimeAsATickOrASlip) {
  World world;
  TestClock clock = clock_in(world);
  std::int64_t ticks = 0;
  for (const int stall_us : {0, 300, 45'000, 700, 1'000'000, 20'000, 21'000, 1'500}) {
    world.now += std::chrono::microseconds(stall_us);
    for (int i = 0; i < 40; ++i, ++ticks) clock.wait();
  }
  EXPECT_EQ(clock.next_deadline(), kStart + (ticks + clock.counts().slipped) * kT);
  EXPECT_EQ(world.now, clock.next_deadline() - kT);
}

TEST(Clock, CallsATickLateAfterMoreThanAFifthOfAMillisecond) {
  World world{.oversleep = 200us};
  TestClock clock = clock_in(world);
  clock.wait();
  EXPECT_EQ(clock.counts().late, 0);
  world.oversleep += 1ns;
  clock.wait();
  EXPECT_EQ(clock.counts().late, 1);
  EXPECT_EQ(clock.counts().missed, 0);
}

TEST(Clock, CallsATickMissedFromTheNextDeadlineOn) {
  World world{.oversleep = kT - 1ns};
  TestClock clock = clock_in(world);
  clock.wait();
  EXPECT_EQ(clock.counts().missed, 0);
  World later{.oversleep = kT};
  TestClock late_clock = clock_in(later);
  late_clock.wait();
  EXPECT_EQ(late_clock.counts().missed, 1);
}

TEST(Clock, StopsSleepingEarlyAndSpinsToTheDeadline) {
  World world{.look = 30ns, .oversleep = 20us};
  TestClock clock = clock_in(world, kT, 100us);
  for (std::int64_t k = 0; k < 1000; ++k) {
    const Wake wake = clock.wait();
    ASSERT_EQ(world.sleeps.back(), kStart + k * kT - 100us);
    ASSERT_GE(wake.latency, 0ns);
    ASSERT_LT(wake.latency, 30ns);
  }
}

TEST(Clock, SleepsRightUpToADeadlineThatIsTooNearForSpinning) {
  World world{.look = 30ns};
  TestClock clock = clock_in(world, kT, 100us);
  clock.wait();
  world.now += 950us;
  clock.wait();
  EXPECT_EQ(world.sleeps.back(), kStart + kT);
}

TEST(MonotonicTime, NeverWakesBeforeTheMomentAskedFor) {
  const MonotonicTime time;
  for (int i = 0; i < 20; ++i) {
    const nanoseconds moment = time.now() + 100us;
    time.sleep_until(moment);
    EXPECT_GE(time.now(), moment);
  }
  time.sleep_until(time.now() - 1s);
}

TEST(MonotonicTime, SleepsOnWhenASignalComesMeanwhile) {
  struct sigaction old {
  }, ignore{};
  ignore.sa_handler = [](int) {};
  sigaction(SIGUSR1, &ignore, &old);
  std::atomic<bool> done = false;
  std::thread sleeper([&] {
    const MonotonicTime time;
    const nanoseconds moment = time.now() + 100ms;
    time.sleep_until(moment);
    EXPECT_GE(time.now(), moment);
    done = true;
  });
  while (!done) {
    pthread_kill(sleeper.native_handle(), SIGUSR1);
    std::this_thread::sleep_for(1ms);
  }
  sleeper.join();
  sigaction(SIGUSR1, &old, nullptr);
}

TEST(Clock, RunsNoTickBackToBackWhereNoneMayBe) {
  for (const nanoseconds stall : {1'100us, 6'300us, 20'900us, 1'000'400us}) {
    World world;
    TestClock clock(kStart, kT, 0ns, SimulatedTime{&world}, 0);
    for (int k = 0; k < 5; ++k) clock.wait();
    const nanoseconds before = world.now;
    world.now += stall;  // within a tick
    const Wake late = clock.wait();
    EXPECT_EQ(late.tick, 5);
    EXPECT_GE(late.moment, before + stall);
    EXPECT_LE(late.moment, before + stall + kT) << "as soon as one is due again";
    const auto sleeps = world.sleeps.size();
    const Wake next = clock.wait();
    EXPECT_EQ(world.sleeps.size(), sleeps + 1) << "then it waits";
    EXPECT_EQ((next.moment - kStart) % kT, 0ns) << "on the old schedule";
    EXPECT_EQ(next.moment - late.moment, kT);
    // Every period that has passed was either run or given up.
    EXPECT_EQ(next.tick + clock.counts().slipped, (next.moment - kStart) / kT);
  }
}

TEST(Clock, RunsOneTickAtOnceWhenItHasOverslept) {
  for (const nanoseconds late : {300us, 1'300us, 20'900us}) {
    World world;
    TestClock clock(kStart, kT, 0ns, SimulatedTime{&world}, 0);
    for (int k = 0; k < 5; ++k) clock.wait();
    world.oversleep = late;
    const Wake wake = clock.wait();
    world.oversleep = 0ns;
    EXPECT_EQ(wake.moment, kStart + 5 * kT + late);
    const Wake next = clock.wait();
    EXPECT_EQ((next.moment - kStart) % kT, 0ns);
    EXPECT_LE(next.moment - wake.moment, kT);
    EXPECT_EQ(next.tick + clock.counts().slipped, (next.moment - kStart) / kT);
  }
}

}  // namespace
}  // namespace limpid
