// Identification of sticks behind the kernel's HID stack: they are moved, and the force ends in
// time whatever ends the motion.
#include <gtest/gtest.h>

#include "app/device/identify_run.h"
#include "tests/vm/desk.h"
#include "tests/vm/unlike_stick.h"

namespace limpid::test {
namespace {

// A stick on the desk, the run that moves it, and the thread that watches.
class Identification {
 public:
  explicit Identification(const UnlikeStick& stick) : model(stick.made()), device(*model) {
    model->forces().expect(60000);
  }

  void begin() {
    connection_ = open_device(find_device("raw"));
    await_reading(*connection_, 200ms);
    stalling_ = std::make_unique<Stalling>(std::move(connection_), stalled);
    watcher_ = std::jthread([this](const std::stop_token& gone) {
      for (; !gone.stop_requested(); wait(20ms)) {
        if (watched) talk.see();
      }
    });
    runner_ = std::jthread([this] {
      run = run_identification(*stalling_, joystick_arm(), {}, talk, {});
      over = true;
    });
  }
  void finish() {
    runner_.join();
    stalling_.reset();
  }

  std::unique_ptr<RawDeviceModel> model;
  UhidDevice device;
  IdentifyProgress talk;
  IdentifyRun run;
  std::atomic<bool> watched = true, stalled = false, over = false;

 private:
  std::unique_ptr<Device> connection_;
  std::unique_ptr<Stalling> stalling_;
  std::jthread watcher_, runner_;
};

void expect_found(unsigned seed, int bits, Time lag) {
  const UnlikeStick stick(seed, bits, lag);
  Identification identification(stick);
  identification.begin();
  identification.finish();
  const IdentifyRun& run = identification.run;
  ASSERT_EQ(run.end, ExcitationEnd::complete) << explain(run.end) << ", " << explain(run.objection);
  const Identified found = identify(joystick_arm(), run.record, {.gravity = Vec3(0, 0, -9.81)});
  stick.expect_found(found, 1e-3);
  EXPECT_NEAR(run.timing.rate, 1000, 10);
  std::printf("| %2d bits, lag %.0f ms | delay %.2f ms |", bits, in_ms(lag),
              1e3 * found.delay.value);
  for (std::size_t i = 0; i < 2; ++i) {
    std::printf(" inertia %+.1f %%, friction %+.1f %% |",
                100 * (found.joints[i].inertia.value / stick.axes[i].inertia - 1),
                100 * (found.joints[i].coulomb.value / stick.axes[i].coulomb - 1));
  }
  std::printf("\n");
}

TEST(Identify, FindsAStickOfSixteenBitsWithALagOfOneMillisecond) { expect_found(1, 16, 1ms); }
TEST(Identify, FindsAStickOfTenBitsWithALagOfFourMilliseconds) { expect_found(4, 10, 4ms); }

// Ends the motion by `failure` four seconds after its start; no force may act later than `limit`
// after that.
void expect_end(const char* what, const std::function<void(Identification&)>& failure, Time limit,
                ExcitationEnd end) {
  Identification identification(UnlikeStick(1, 16, 0ms));
  RawDeviceModel& model = *identification.model;
  identification.begin();
  wait(4s);
  const Time moment = identification.device.with([](Time now) { return now; });
  failure(identification);
  wait_until([&] { return identification.over.load(); }, 4s);
  wait(100ms);
  const auto zero =
      identification.device.with([&](Time) { return model.forces().zero_after(moment); });
  identification.stalled = false;
  identification.finish();
  print_time(what, zero, limit);
  ASSERT_TRUE(zero);
  EXPECT_GT(*zero, Time{}) << "it did not push";
  EXPECT_LE(*zero, limit);
  EXPECT_EQ(identification.run.end, end) << explain(identification.run.end);
}

TEST(IdentifyEnds, WhenItIsCancelled) {
  expect_end(
      "cancelled", [](Identification& i) { i.talk.cancel = true; }, kTickLife,
      ExcitationEnd::cancelled);
}

TEST(IdentifyEnds, WhenTheStickFallsSilent) {
  expect_end(
      "silent",
      [](Identification& i) { i.device.with([&](Time) { i.model->set_fault(Fault::silent); }); },
      kReadingLife + kReport, ExcitationEnd::not_well);
}

TEST(IdentifyEnds, WhenItsHandSwitchOpens) {
  expect_end(
      "hand switch open",
      [](Identification& i) { i.device.with([&](Time) { i.model->hand().hold(false); }); },
      kTickLife, ExcitationEnd::let_go);
}

TEST(IdentifyEnds, WhenAHandHoldsOn) {
  expect_end(
      "held",
      [](Identification& i) {
        i.device.with([&](Time) {
          for (int axis = 0; axis < 2; ++axis) {
            const double here = i.model->hand().position(axis);
            i.model->hand().axis(axis).path = [here](double) { return here; };
            i.model->hand().axis(axis).stiffness = 20;
            i.model->hand().axis(axis).damping = 0.1;
          }
        });
      },
      3500ms, ExcitationEnd::held);
}

TEST(IdentifyEnds, WhenNobodyWatches) {
  expect_end(
      "unwatched", [](Identification& i) { i.watched = false; }, 230ms, ExcitationEnd::limit);
}

TEST(IdentifyEnds, WhenTheTicksStandStill) {
  expect_end(
      "ticks stand still",
      [](Identification& i) {
        i.stalled = true;
        wait(50ms);
        i.stalled = false;
      },
      kTickLife, ExcitationEnd::not_well);
}

}  // namespace
}  // namespace limpid::test
