#include "app/device/axis_check_run.h"

#include <gmock/gmock.h>

#include <thread>

#include "app/device/device_store.h"
#include "core/dynamics/arm.h"
#include "devices/files/urdf_file.h"
#include "tests/support/device_traits.h"
#include "tests/support/fake_device.h"

namespace limpid {
namespace {

using namespace std::chrono_literals;

// A device whose joints yield by a given angle per newton metre.
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

ArmDescription stick() { return read_urdf(LIMPID_ASSETS_DIR "/devices/joystick.urdf"); }

// Runs the check, with a thread that plays the window.
AxisCheck checked(Yielding& device, AxisCheckProgress& progress, bool window_hangs = false,
                  const SafetyLimits& limits = {}) {
  std::atomic<bool> done = false;
  std::thread window([&] {
    while (!done) {
      if (!window_hangs) progress.see_window();
      std::this_thread::sleep_for(16ms);
    }
  });
  AxisCheck check = run_axis_check(device, stick(), limits, progress, {});
  done = true;
  window.join();
  return check;
}

TEST(AxisCheckRun, FindsOutWhichWayEachAxisMoves) {
  Yielding device({0.5, -0.5});
  AxisCheckProgress progress;
  const AxisCheck check = checked(device, progress);
  EXPECT_TRUE(check.passed()) << report_of(check);
  EXPECT_EQ(check.finding(0).verdict, AxisVerdict::right);
  EXPECT_EQ(check.finding(1).verdict, AxisVerdict::reversed);
  EXPECT_LE(device.largest, 0.05 + 1e-12) << "a tenth of 0.5 N m";
  EXPECT_EQ(device.told[0], 0);
  DeviceNotes notes;
  EXPECT_TRUE(remember_check(check, notes));
  EXPECT_TRUE(notes.checked);
  EXPECT_FALSE(notes.axes.at(0).reversed);
  EXPECT_TRUE(notes.axes.at(1).reversed);
}

TEST(AxisCheckRun, EndsWithoutForceWhenItIsCancelled) {
  Yielding device({0.5, 0.5});
  AxisCheckProgress progress;
  std::thread hand([&] {
    std::this_thread::sleep_for(150ms);
    progress.cancel = true;
  });
  const AxisCheck check = checked(device, progress);
  hand.join();
  EXPECT_FALSE(check.passed());
  EXPECT_EQ(progress.end, CheckEnd::stopped);
  EXPECT_EQ(check.finding(check.axis()).verdict, AxisVerdict::given_up);
  EXPECT_EQ(device.told, (std::array<double, kMaxDof>{}));
  DeviceNotes notes;
  EXPECT_FALSE(remember_check(check, notes));
}

TEST(AxisCheckRun, EndsWhenTheWindowHangs) {
  Yielding device({1e-9, 1e-9});  // a hard axis, which takes seconds
  AxisCheckProgress progress;
  const AxisCheck check = checked(device, progress, true);
  EXPECT_EQ(progress.end, CheckEnd::no_window);
  EXPECT_EQ(check.finding(check.axis()).verdict, AxisVerdict::given_up);
  EXPECT_EQ(device.told, (std::array<double, kMaxDof>{}));
}

TEST(AxisCheckRun, EndsAtAnOldReadingAndStopsTheDevice) {
  test::FakeDevice device(2);
  device.reading.age = 0.006;
  AxisCheckProgress progress;
  progress.window_seen = std::chrono::steady_clock::now() + std::chrono::hours(1);
  const AxisCheck check = run_axis_check(device, stick(), {}, progress, {});
  EXPECT_EQ(check.finding(0).verdict, AxisVerdict::given_up);
  EXPECT_THAT(report_of(check, progress.end), testing::HasSubstr("no reading for 5 ms"));
  EXPECT_TRUE(device.stopped);
}

// A device whose own watchdog cut once, in the first push.
TEST(AxisCheckRun, BeginsAPushAgainAfterALapse) {
  class Lapsing final : public Device {
   public:
    const DeviceTraits& traits() const override { return device_.traits(); }
    bool read(DeviceReading& newest) noexcept override {
      if (lapses == 0 && device_.told[0] > 0.005) lapses = 1;
      newest.lapses = lapses;
      return device_.read(newest);
    }
    void write(std::span<const double> torque) noexcept override {
      if (lapses == 1 && after < 0) after = torque[0];
      device_.write(torque);
    }
    void stop() noexcept override { device_.stop(); }
    std::uint32_t lapses = 0;
    double after = -1;  // torque of the tick that sees the lapse [N m]

   private:
    Yielding device_{{0.5, 0.5}};
  } device;
  AxisCheckProgress progress;
  progress.window_seen = std::chrono::steady_clock::now() + std::chrono::hours(1);
  const AxisCheck check = run_axis_check(device, stick(), {}, progress, {});
  EXPECT_EQ(device.lapses, 1u);
  EXPECT_EQ(device.after, 0);
  EXPECT_TRUE(check.passed()) << report_of(check, progress.end);
}

// The device notes when it was told which torque. Warmth by its definition: the torque's square
// over the continuous one's, over the time constant, while it is still far from its end.
TEST(AxisCheckRun, TellsByHowMuchTheMotorsWereWarmedUp) {
  ArmDescription arm = stick();
  constexpr double kContinuous = 0.02, kTime = 600;
  arm.joints[0].continuous = kContinuous;
  arm.joints[0].warming = kTime;
  class Noting final : public Device {
   public:
    const DeviceTraits& traits() const override { return device_.traits(); }
    bool read(DeviceReading& newest) noexcept override { return device_.read(newest); }
    void write(std::span<const double> torque) noexcept override {
      const auto now = std::chrono::steady_clock::now();
      heat += std::chrono::duration<double>(now - since_).count() * told_ * told_;
      since_ = now;
      told_ = torque[0];
      device_.write(torque);
    }
    void stop() noexcept override { device_.stop(); }
    double heat = 0;  // [N^2 m^2 s]

   private:
    Yielding device_{{0.5, 0.5}};
    std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
    double told_ = 0;
  } device;
  AxisCheckProgress progress;
  progress.window_seen = std::chrono::steady_clock::now() + std::chrono::hours(1);
  EXPECT_TRUE(run_axis_check(device, arm, {}, progress, {}).passed());
  ASSERT_EQ(progress.warmth.size(), 2);
  ASSERT_GT(device.heat, 0);
  const double expected = device.heat / (kContinuous * kContinuous) / kTime;
  EXPECT_NEAR(progress.warmth[0], expected, 0.2 * expected);
  EXPECT_EQ(progress.warmth[1], 0) << "no model";
}

// The stick's tip is on a lever [m]: a torque tau is a force of tau over the lever.
TEST(AxisCheckRun, PushesWithNoMoreThanTheForceThatIsSet) {
  const ArmDescription arm = stick();
  double reach = 0;  // distance of the second joint's axis, straight up
  {
    Arm<kAnyDof> frames_of(arm);
    Arm<kAnyDof>::Frames frames;
    frames_of.frames(rest_pose(arm), frames);
    Jacobian<kAnyDof> J;
    frames_of.point_jacobian(frames, 1, frames_of.tip(frames), J);
    reach = J.colwise().norm().minCoeff();
  }
  ASSERT_GT(reach, 0.01);
  Yielding device({0.5, 0.5});
  AxisCheckProgress progress;
  checked(device, progress);
  const double usual = device.largest;
  ASSERT_GT(usual, 0.1 * reach);
  Yielding gentle({0.5, 0.5});
  AxisCheckProgress again;
  const AxisCheck check = checked(gentle, again, false, {.tip_force = 0.1});
  EXPECT_GT(gentle.largest, 0);
  EXPECT_LE(gentle.largest, 0.1 * reach * 1.1) << report_of(check);
}

TEST(AxisCheckRun, EndsAtALimitThatIsSet) {
  // A stick outside of the allowed part of its range.
  class Astray final : public Device {
   public:
    const DeviceTraits& traits() const override { return traits_; }
    bool read(DeviceReading& newest) noexcept override {
      newest.x[0] = newest.x[1] = 0.3;
      newest.count = ++count_;
      return true;
    }
    void write(std::span<const double> torque) noexcept override {
      for (const double tau : torque) largest = std::max(largest, std::abs(tau));
    }
    void stop() noexcept override {}
    double largest = 0;

   private:
    DeviceTraits traits_ = test::pushing(2, 0.35);
    std::uint64_t count_ = 0;
  } device;
  AxisCheckProgress progress;
  progress.window_seen = std::chrono::steady_clock::now() + std::chrono::hours(1);
  const AxisCheck check = run_axis_check(device, stick(), {.range = 0.5}, progress, {});
  EXPECT_EQ(check.finding(0).verdict, AxisVerdict::beyond_limit);
  EXPECT_EQ(device.largest, 0);
}

TEST(AxisCheckRun, IsOfAnArmWithAsManyJoints) {
  test::FakeDevice device(3);
  AxisCheckProgress progress;
  EXPECT_THROW(run_axis_check(device, stick(), {}, progress, {}), std::invalid_argument);
}

}  // namespace
}  // namespace limpid
