// Ends of force at failures while the stick is pushed, measured by the reference device itself.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <numbers>
#include <tuple>

#include "devices/hid/hid_transport.h"
#include "tests/vm/desk.h"
#include "tests/vm/driver.h"
#include "tests/vm/models.h"

namespace limpid::test {
namespace {

template <class Model>
struct FailingLoop : testing::Test {
  static std::string name() { return kName<Model>; }
  void expect_zero(const std::string& what, std::optional<Time> zero, Time limit) {
    print_time(name() + ": " + what, zero, limit);
    ASSERT_TRUE(zero) << "it still pushes";
    EXPECT_LE(*zero, limit);
  }
  // A fault of the device while it pushes; force must not come back by itself.
  void expect_end(const std::string& what, Fault fault, ForceState state) {
    desk.open();
    ASSERT_TRUE(desk.push());
    const auto zero = desk.time_to_zero([&](Time) { desk.model->set_fault(fault); });
    expect_zero(what, zero, kReadingLife);
    EXPECT_EQ(desk.force_state(), state);
    desk.device->with([&](Time) { desk.model->set_fault(Fault::none); });
    wait(700ms);
    EXPECT_EQ(desk.torque(), 0) << "it pushes again without having been armed";
    EXPECT_EQ(desk.force_state(), state);
    desk.arm_force(false);
    wait(20ms);
    EXPECT_TRUE(desk.push());
  }

  Desk<Model> desk;
};
TYPED_TEST_SUITE(FailingLoop, Models);

TYPED_TEST(FailingLoop, EndsForceWhenTheDeviceFallsSilent) {
  this->expect_end("no readings, no answers", Fault::silent, ForceState::stale);
}

TYPED_TEST(FailingLoop, EndsForceWhenTheDeviceSendsNaN) {
  this->expect_end("NaN (PID: null values)", Fault::not_a_number, ForceState::stale);
}

TYPED_TEST(FailingLoop, EndsForceWhenTheDeviceSendsHalfReports) {
  this->expect_end("half reports", Fault::cut_short, ForceState::stale);
}

// The encoders' wires are broken: new reports arrive with the same angles.
TYPED_TEST(FailingLoop, EndsForceWhenReadingsStandStillThoughReportsGoOn) {
  this->desk.open();
  ASSERT_TRUE(this->desk.push());
  wait(700ms);
  const double full = std::abs(this->desk.torque());
  const Time moment = this->desk.device->with([&](Time now) {
    this->desk.model->hand().break_encoders(true);
    return now;
  });
  wait(800ms);
  this->expect_zero("readings stand still", this->desk.zero_after(moment), 620ms);
  EXPECT_EQ(this->desk.force_state(), ForceState::frozen);
  EXPECT_GT(full, 0.1);
  this->desk.device->with([&](Time) { this->desk.model->hand().break_encoders(false); });
  wait(700ms);
  EXPECT_EQ(this->desk.torque(), 0) << "it pushes again without having been armed";
  EXPECT_EQ(this->desk.force_state(), ForceState::frozen);
  this->desk.arm_force(false);
  wait(20ms);
  EXPECT_TRUE(this->desk.push());
}

TYPED_TEST(FailingLoop, EndsForceWhenTheDeviceSendsGarbage) {
  this->desk.open();
  ASSERT_TRUE(this->desk.push());
  const auto zero =
      this->desk.time_to_zero([&](Time) { this->desk.model->set_fault(Fault::garbage); });
  this->expect_zero("garbage", zero, kReadingLife);
}

// The motors keep their last torque; nobody outside can help, but no command is sent any more.
TYPED_TEST(FailingLoop, GivesUpADeviceWhoseFirmwareHangs) {
  this->desk.open();
  ASSERT_TRUE(this->desk.push());
  const auto unheard =
      this->desk.time_to_zero([&](Time) { this->desk.model->set_fault(Fault::frozen); });
  EXPECT_FALSE(unheard);
  EXPECT_EQ(this->desk.force_state(), ForceState::stale);
  const Time back = this->desk.device->with([&](Time now) {
    this->desk.model->set_fault(Fault::none);
    return now;
  });
  wait(100ms);
  this->expect_zero("firmware hung, from when it hears again", this->desk.zero_after(back),
                    kReadingLife);
}

TYPED_TEST(FailingLoop, IsWithoutForceWhenUnplugged) {
  this->desk.open();
  ASSERT_TRUE(this->desk.push());
  this->desk.device->unplug();
  EXPECT_TRUE(wait_until([&] { return this->desk.force_state() == ForceState::lost; }, 10ms));
  EXPECT_TRUE(this->desk.loop.status().running);
}

TYPED_TEST(FailingLoop, EndsForceWhenTheLoopIsClosed) {
  this->desk.open();
  ASSERT_TRUE(this->desk.push());
  const Time moment = steady_now();
  this->desk.loop.close();
  this->expect_zero("closed", this->desk.zero_after(moment), kTickLife);
}

TYPED_TEST(FailingLoop, EndsForceWhenNoTickComes) {
  std::atomic<bool> stalled = false;
  this->desk.open(std::make_unique<Stalling>(this->desk.connect(), stalled));
  ASSERT_TRUE(this->desk.push());
  const Time moment = steady_now();
  stalled = true;
  wait(100ms);
  this->expect_zero("no tick", this->desk.zero_after(moment), kTickLife);
  stalled = false;
  this->desk.loop.close();
}

// SIGABRT stands for an exception in the loop, too.
TYPED_TEST(FailingLoop, EndsForceWhenTheProcessIsInterruptedOrDies) {
  for (const int signal : {SIGINT, SIGTERM, SIGKILL, SIGSEGV, SIGABRT}) {
    const pid_t driver = start_driver(this->name());
    ASSERT_GT(driver, 0);
    ASSERT_TRUE(wait_until([&] { return this->desk.torque() < -0.1; }));
    wait(50ms);
    const Time moment = steady_now();
    kill(driver, signal);
    wait(100ms);
    // The next frame notices an interrupt.
    const bool heard = signal == SIGINT || signal == SIGTERM;
    this->expect_zero(std::string("killed, SIG") + sigabbrev_np(signal),
                      this->desk.zero_after(moment), heard ? 30ms : 10ms);
    waitpid(driver, nullptr, 0);
    // The guardian's hold on the device ends with the device; the hand begins anew.
    this->desk.device->unplug();
    wait(50ms);
    this->desk.device->replug();
  }
}

// The first program pushes; a second one tries to open the device, again and again. Any report from
// the second would show: as a zero torque, a feature read or set, or, on a raw device, a command
// out of order.
TYPED_TEST(FailingLoop, IsLeftAloneByASecondProgramAndFreeOnceTheFirstIsKilled) {
  constexpr int kAttempts = 20;
  const pid_t owner = start_driver(this->name());
  ASSERT_GT(owner, 0);
  ASSERT_TRUE(wait_until([&] { return this->desk.torque() < -0.1; }));
  wait(700ms);
  const auto state = [&] {
    return this->desk.device->with([&](Time) {
      const TypeParam& model = *this->desk.model;
      int refused = 0;
      if constexpr (!Desk<TypeParam>::kPid) refused = model.rejected() + model.gaps();
      return std::tuple(model.features_used(), model.violations().size(), refused);
    });
  };
  const auto before = state();
  const Time begun = steady_now();
  for (int i = 0; i < kAttempts; ++i) {
    try {
      this->desk.connect();
      ADD_FAILURE() << "two programs have it";
    } catch (const HidError& error) {
      EXPECT_NE(std::string(error.what()).find("process " + std::to_string(owner)),
                std::string::npos)
          << error.what();
    }
  }
  const Time ended = steady_now();
  EXPECT_EQ(state(), before);
  int zeros = 0;
  const Time silence = this->desk.device->with([&](Time) {
    for (const ForceSample& sample : this->desk.model->forces().samples()) {
      const bool meanwhile = sample.time >= begun && sample.time <= ended;
      const bool told_none = sample.cause == ForceCause::told && sample.torque[0] == 0;
      zeros += meanwhile && told_none ? 1 : 0;
    }
    return this->desk.model->forces().longest_silence(begun, ended);
  });
  EXPECT_EQ(zeros, 0) << "its torque was broken off";
  std::printf("| %-48s | %7d    | %5d    |\n",
              (this->name() + ": reports of a second program").c_str(), zeros, 0);
  print_time(this->name() + ": longest pause of the first one's", silence, kTickLife);
  const Time moment = steady_now();
  kill(owner, SIGKILL);
  std::unique_ptr<Device> mine;
  EXPECT_TRUE(wait_until([&] {
    try {
      mine = this->desk.connect();
    } catch (const HidError&) {
    }
    return mine != nullptr;
  }));
  print_time(this->name() + ": killed, until it can be had again", steady_now() - moment, 3s);
  this->expect_zero("killed, and another program waits", this->desk.zero_after(moment), 10ms);
  waitpid(owner, nullptr, 0);
}

struct FailingRawLoop : FailingLoop<RawDeviceModel> {};

TEST_F(FailingRawLoop, EndsForceWhenReadingsRepeatThemselves) {
  expect_end("the same reading again and again", Fault::stuck, ForceState::stale);
}

// The device's counter is off by a turn for one report, which arrives whole.
TEST_F(FailingRawLoop, EndsForceAtOneWrongReading) {
  desk.open();
  ASSERT_TRUE(desk.push());
  const Time moment = desk.device->with([&](Time now) {
    desk.model->hand().miscount(2 * std::numbers::pi);
    return now;
  });
  wait(2ms);
  desk.device->with([&](Time) { desk.model->hand().miscount(0); });
  wait(100ms);
  expect_zero("a reading that is off by a turn", desk.zero_after(moment), 4ms);
  EXPECT_EQ(desk.force_state(), ForceState::wrong);
  wait(700ms);
  EXPECT_EQ(desk.torque(), 0) << "it pushes again without having been armed";
  EXPECT_EQ(desk.force_state(), ForceState::wrong);
  desk.arm_force(false);
  wait(20ms);
  EXPECT_TRUE(desk.push());
}

TEST_F(FailingRawLoop, EndsForceWhenTheDeviceReportsAFault) {
  desk.open();
  ASSERT_TRUE(desk.push());
  const auto zero = desk.time_to_zero([&](Time) { desk.model->set_unwell(true); });
  expect_zero("fault bit", zero, 3 * kReport);
  EXPECT_EQ(desk.force_state(), ForceState::fault);
}

// No report reaches the device for 40 ms, and its watchdog cuts; then all arrive again.
TEST_F(FailingRawLoop, FadesInFromNothingAfterTheDevicesWatchdogHasCut) {
  desk.open();
  ASSERT_TRUE(desk.push());
  wait(700ms);
  const double full = std::abs(desk.torque());
  desk.device->with([&](Time) { desk.model->set_fault(Fault::deaf); });
  wait(40ms);
  EXPECT_EQ(desk.torque(), 0);
  const Time heard = desk.device->with([&](Time now) {
    desk.model->set_fault(Fault::none);
    return now;
  });
  wait(900ms);
  double first = 0, before = 0;
  desk.device->with([&](Time) {
    for (const ForceSample& sample : desk.model->forces().samples()) {
      const double now = std::abs(sample.torque[0]);
      if (sample.time >= heard) {
        const double t = std::chrono::duration<double>(sample.time - heard).count();
        EXPECT_LE(now, kEffort * (t + 0.003) / 0.5 + 1e-3) << t << " s after";
        if (first == 0) first = now;
      }
      before = now;
    }
  });
  std::printf("| %-48s | %7.3f N m in the first report, of %.3f |\n", "raw: its watchdog has cut",
              first, full);
  EXPECT_NEAR(before, full, 0.3 * full) << "it is still armed";
}

// The dead-man switch: force comes back with the hand, slowly.
TEST_F(FailingRawLoop, EndsForceWhileNoHandIsThere) {
  desk.open();
  ASSERT_TRUE(desk.push());
  const auto zero = desk.time_to_zero([&](Time) { desk.model->hand().hold(false); });
  expect_zero("dead-man switch let go", zero, 3 * kReport);
  EXPECT_EQ(desk.force_state(), ForceState::no_hand);
  desk.device->with([&](Time) { desk.model->hand().hold(true); });
  EXPECT_TRUE(wait_until([&] { return desk.force_state() == ForceState::on; }));
}

}  // namespace
}  // namespace limpid::test
