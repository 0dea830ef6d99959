// Torque of the device after the loop, the whole program or the window has stood still: never from
// nothing to full force in one report.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include "tests/vm/desk.h"
#include "tests/vm/driver.h"
#include "tests/vm/models.h"

namespace limpid::test {
namespace {

constexpr std::array kStalls{6ms, 9ms, 20ms, 100ms, 1000ms};

template <class Model>
struct StalledLoop : testing::Test {
  static std::string name() { return kName<Model>; }

  // Expects a slow return: from `resumed` on, the force may keep its value for a few reports or be
  // gone, but grows at most by the slew's part of the time in each report, and overall as the
  // fade-in allows.
  void expect_slow_return(const std::string& what, Time resumed, double full) {
    std::vector<ForceSample> samples;
    desk.device->with([&](Time) {
      const auto all = desk.model->forces().samples();
      samples.assign(all.begin(), all.end());
    });
    double before = 0, largest_step = 0;
    Time last = resumed;
    for (const ForceSample& sample : samples) {
      const double now = std::abs(sample.torque[0]);
      if (sample.time >= resumed) {
        const double dt = std::chrono::duration<double>(sample.time - last).count();
        const double t = std::chrono::duration<double>(sample.time - resumed).count();
        largest_step = std::max(largest_step, now - before);
        ASSERT_LE(now - before, kEffort * (std::min(dt, 0.001) + 0.001) / 0.02 + 1e-3) << what;
        if (t > 0.004) {
          ASSERT_LE(now, kEffort * (t + 0.003) / 0.5 + 1e-3) << what << ", " << t << " s after";
        }
      }
      before = now;
      last = sample.time;
    }
    std::printf("| %-48s | %7.3f N m in one report, of %.3f |\n", (name() + ": " + what).c_str(),
                largest_step, full);
  }
  // Torque of the push before the stall [N m].
  double full() { return std::abs(desk.torque()); }

  Desk<Model> desk;
};
TYPED_TEST_SUITE(StalledLoop, Models);

TYPED_TEST(StalledLoop, FadesInAgainAfterTheLoopStoodStill) {
  std::atomic<bool> stalled = false;
  this->desk.open(std::make_unique<Stalling>(this->desk.connect(), stalled));
  for (const auto stall : kStalls) {
    ASSERT_TRUE(this->desk.push());
    wait(700ms);
    const double full = this->full();
    ASSERT_GT(full, 0.1);
    stalled = true;
    wait(stall);
    const Time resumed = steady_now();
    stalled = false;
    wait(900ms);
    this->expect_slow_return("loop stood still " + std::to_string(stall.count()) + " ms", resumed,
                             full);
    EXPECT_NEAR(this->full(), full, 0.3 * full) << "it is still armed";
  }
  this->desk.loop.close();
}

TYPED_TEST(StalledLoop, FadesInAgainAfterTheWholeProgramStoodStill) {
  const pid_t driver = start_driver(this->name());
  ASSERT_GT(driver, 0);
  ASSERT_TRUE(wait_until([&] { return this->desk.torque() < -0.1; }));
  for (const auto stall : kStalls) {
    wait(900ms);
    const double full = this->full();
    ASSERT_GT(full, 0.1);
    const Time stopped = steady_now();
    kill(driver, SIGSTOP);
    wait(stall);
    if (stall >= 100ms) {
      const auto zero = this->desk.zero_after(stopped);
      print_time(this->name() + ": program stopped", zero, 22ms);
      ASSERT_TRUE(zero);
      EXPECT_LE(*zero, 22ms) << "the device's own watchdog";
    }
    const Time resumed = steady_now();
    kill(driver, SIGCONT);
    wait(50ms);
    this->expect_slow_return("program stopped for " + std::to_string(stall.count()) + " ms",
                             resumed, full);
  }
  kill(driver, SIGKILL);
  waitpid(driver, nullptr, 0);
}

TYPED_TEST(StalledLoop, TakesTheForceAwayWhenTheWindowHangs) {
  this->desk.open();
  ASSERT_TRUE(this->desk.push());
  wait(700ms);
  const double full = this->full();
  const Time hung = steady_now();
  this->desk.hangs = true;
  wait(190ms);
  EXPECT_GT(this->full(), 0.8 * full) << "a slow frame is none that hangs";
  wait(310ms);
  const auto zero = this->desk.zero_after(hung);
  print_time(this->name() + ": window hangs", zero, 450ms);
  ASSERT_TRUE(zero);
  EXPECT_LE(*zero, 450ms);
  EXPECT_EQ(this->desk.force_state(), ForceState::unwatched);
  this->desk.hangs = false;
  const Time back = steady_now();
  wait(1s);
  EXPECT_EQ(this->desk.zero_after(back), Time{}) << "it pushes again without having been armed";
  EXPECT_TRUE(this->desk.push());
}

}  // namespace
}  // namespace limpid::test
