#include "app/device/axis_check_run.h"

#include <gtest/gtest.h>

#include <thread>

#include "app/device/device_book.h"
#include "tests/support/device_traits.h"
#include "tests/support/fake_device.h"

namespace limpid {
namespace {

using namespace std::chrono_literals;

// Joints that give way by so much a newton metre.
class Yielding final : public Device {
 public:
  explicit Yielding(std::vector<double> give)
      : give_(std::move(give)), traits_(test::pushing(static_cast<int>(give_.size()), 0.35)) {}
  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading& newest) noexcept override {
    for (std::size_t i = 0; i < give_.size(); ++i) newest.x[i] = give_[i] * told[i];
    newest.count = ++count_;
    return true;
  }
  void write(std::span<const double> torque) noexcept override {
    for (std::size_t i = 0; i < give_.size(); ++i) {
      told[i] = torque[i];
      largest = std::max(largest, std::abs(torque[i]));
    }
  }
  void stop() noexcept override { told.fill(0); }

  std::array<double, kMaxDof> told{};
  double largest = 0;

 private:
  std::vector<double> give_;
  DeviceTraits traits_;
  std::uint64_t count_ = 0;
};

// The window, as it is seen while it runs.
AxisCheck checked(Yielding& device, AxisCheckTalk& talk, bool window_hangs = false) {
  std::atomic<bool> done = false;
  std::thread window([&] {
    while (!done) {
      if (!window_hangs) talk.see_window();
      std::this_thread::sleep_for(16ms);
    }
  });
  AxisCheck check = run_axis_check(device, talk, {});
  done = true;
  window.join();
  return check;
}

TEST(AxisCheckRun, FindsOutWhichWayEachAxisMoves) {
  Yielding device({0.5, -0.5});
  AxisCheckTalk talk;
  const AxisCheck check = checked(device, talk);
  EXPECT_TRUE(check.passed()) << report_of(check);
  EXPECT_EQ(check.finding(0).verdict, AxisVerdict::right);
  EXPECT_EQ(check.finding(1).verdict, AxisVerdict::reversed);
  EXPECT_LE(device.largest, 0.05 + 1e-12) << "a tenth of 0.5 N m";
  EXPECT_EQ(device.told[0], 0);
  DeviceNotes notes;
  EXPECT_TRUE(remember_check(check, notes));
  EXPECT_TRUE(notes.checked);
  EXPECT_FALSE(notes.pid.reverse[0]);
  EXPECT_TRUE(notes.pid.reverse[1]);
}

TEST(AxisCheckRun, EndsWithoutForceWhenItIsCancelled) {
  Yielding device({0.5, 0.5});
  AxisCheckTalk talk;
  std::thread hand([&] {
    std::this_thread::sleep_for(150ms);
    talk.cancel = true;
  });
  const AxisCheck check = checked(device, talk);
  hand.join();
  EXPECT_FALSE(check.passed());
  EXPECT_EQ(check.finding(check.axis()).verdict, AxisVerdict::given_up);
  EXPECT_EQ(device.told, (std::array<double, kMaxDof>{}));
  DeviceNotes notes;
  EXPECT_FALSE(remember_check(check, notes));
}

TEST(AxisCheckRun, EndsWhenTheWindowHangs) {
  Yielding device({1e-9, 1e-9});  // it would push for seconds
  AxisCheckTalk talk;
  const AxisCheck check = checked(device, talk, true);
  EXPECT_EQ(check.finding(check.axis()).verdict, AxisVerdict::given_up);
  EXPECT_EQ(device.told, (std::array<double, kMaxDof>{}));
}

TEST(AxisCheckRun, EndsAtAnOldReadingAndStopsTheDevice) {
  test::FakeDevice device(2);
  device.reading.age = 0.006;
  AxisCheckTalk talk;
  talk.window_seen = std::chrono::steady_clock::now() + std::chrono::hours(1);
  const AxisCheck check = run_axis_check(device, talk, {});
  EXPECT_EQ(check.finding(0).verdict, AxisVerdict::given_up);
  EXPECT_TRUE(device.stopped);
}

}  // namespace
}  // namespace limpid
