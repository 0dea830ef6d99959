// A device that is only looked at gets no torque, and what its readings showed is told.
#include "app/live/device_look.h"

#include <gtest/gtest.h>

#include <cmath>

namespace limpid {
namespace {

DeviceTraits two_joints() {
  return {.name = "stick",
          .id = "stick:1",
          .dof = 2,
          .pushes = true,
          .lower = {-1, -1},
          .upper = {1, 1},
          .resolution = {1e-3, 1e-3},
          .effort = {1, 1}};
}

// Notes whatever reaches it.
class Noting final : public Device {
 public:
  explicit Noting(int& told) : told_(told) {}
  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading& newest) noexcept override {
    newest.count = 1;
    return true;
  }
  void write(std::span<const double>) noexcept override { ++told_; }
  void stop() noexcept override { ++told_; }

 private:
  DeviceTraits traits_ = two_joints();
  int& told_;
};

TEST(OnlyLooked, PassesOnReadingsAndNeverATorque) {
  int told = 0;
  const auto seen = std::make_shared<DeviceSeen>();
  OnlyLooked device(std::make_unique<Noting>(told), seen);
  DeviceReading reading;
  EXPECT_TRUE(device.read(reading));
  device.write(std::array{0.5, -0.5});
  device.stop();
  EXPECT_EQ(told, 0);
  EXPECT_EQ(seen->readings(), 1u);
}

TEST(OnlyLooked, NotesNothingBesideTheTimeThatCounts) {
  int told = 0;
  const auto seen = std::make_shared<DeviceSeen>();
  seen->noting = false;
  OnlyLooked device(std::make_unique<Noting>(told), seen);
  DeviceReading reading;
  EXPECT_TRUE(device.read(reading));
  EXPECT_EQ(seen->readings(), 0u);
}

// Feeds readings at `rate` [Hz] that are looked at every millisecond.
struct Looking {
  DeviceTraits traits = two_joints();
  DeviceSeen seen;
  DeviceReading reading;
  double now = 100;  // [s]

  void look(double age) {
    reading.age = age;
    seen.take(reading, true, traits, now);
  }
};

TEST(ADeviceSeen, HasRangeAndSmallestStepOfEachJoint) {
  Looking at;
  for (int k = 0; k < 1000; ++k, at.now += 1e-3) {
    ++at.reading.count;
    at.reading.x[0] = 0.25 * std::floor(k / 100);  // to 2.25, which no range hides
    at.reading.x[1] = -0.5;
    at.look(2e-4);
  }
  EXPECT_EQ(at.seen.joint(0).least, 0);
  EXPECT_EQ(at.seen.joint(0).most, 2.0) << "farther than 1 rad beyond the range is not believed";
  EXPECT_EQ(at.seen.joint(0).step, 0.25);
  EXPECT_EQ(at.seen.joint(1).most, -0.5);
  EXPECT_TRUE(std::isinf(at.seen.joint(1).step)) << "it never moved";
  EXPECT_EQ(at.seen.unbelieved, 100u);
}

TEST(ADeviceSeen, CountsReadingsBetweenTwoTicksAndTellsThePauses) {
  Looking at;
  for (int k = 0; k < 4000; ++k, at.now += 1e-3) {
    if (k < 2000 || k >= 2050) at.reading.count += 2;  // 2000 a second, and silence for 50 ms
    at.look(k < 2000 || k >= 2050 ? 1e-4 : 1e-4 + 1e-3 * (k - 1999));
  }
  EXPECT_EQ(at.seen.readings(), 2 * 3950u - 1);
  EXPECT_NEAR(at.seen.median_gap(), 5e-4, 5e-5);
  EXPECT_NEAR(at.seen.worst_gap(), 0.05, 1.1e-3);
  EXPECT_NEAR(at.seen.rate(), 2 * 3950 / 4.0, 2);
}

TEST(ADeviceSeen, DoesNotTakePausesOfItsOwnForThoseOfTheDevice) {
  Looking at;
  for (int k = 0; k < 1000; ++k, at.now += k == 501 ? 0.03 : 1e-3) {
    at.reading.count += k == 501 ? 30 : 1;
    at.look(1e-4);
  }
  EXPECT_LT(at.seen.worst_gap(), 1.5e-3);
}

TEST(ADeviceSeen, AddsUpHowLongTheDeviceComplained) {
  Looking at;
  for (int k = 0; k <= 1000; ++k, at.now += 1e-3) {
    ++at.reading.count;
    at.reading.hand = k <= 250;
    at.reading.fault = k > 900;
    at.reading.no_force = k > 500 ? NoForce::warm : NoForce::none;
    at.reading.buttons = k == 40 ? 2u : 0u;
    at.reading.warmth = k == 70 ? 0.5f : 0.1f;
    at.look(0);
  }
  EXPECT_NEAR(at.seen.without_hand, 0.75, 1e-9);
  EXPECT_NEAR(at.seen.fault, 0.1, 1e-9);
  EXPECT_NEAR(at.seen.no_force[static_cast<std::size_t>(NoForce::warm)], 0.5, 1e-9);
  EXPECT_EQ(at.seen.uncalibrated, 0);
  EXPECT_EQ(at.seen.buttons, 2u);
  EXPECT_EQ(at.seen.warmth, 0.5f);
}

constexpr double kStill = 0.01;

TEST(RestNoise, IsThatOfWindowsInWhichAJointStandsStill) {
  RestNoise noise;
  for (int k = 0; k < 4000; ++k) {
    const double t = 1e-3 * k;
    const bool moves = t > 1 && t < 2;
    noise.add(moves ? std::sin(3 * (t - 1)) : 5 + (k % 2 == 0 ? 1e-3 : -1e-3), t, kStill);
  }
  ASSERT_TRUE(noise.rms());
  EXPECT_NEAR(*noise.rms(), 1e-3, 1e-6);
  EXPECT_NEAR(noise.seconds(), 2.75, 0.26);
}

TEST(RestNoise, IsNotSeenWhereAJointCreeps) {
  RestNoise noise;
  for (int k = 0; k < 4000; ++k) noise.add(1e-5 * k, 1e-3 * k, kStill);
  EXPECT_FALSE(noise.rms());
}

TEST(RestNoise, IsNoneWhereEveryReadingIsTheSame) {
  RestNoise noise;
  for (int k = 0; k < 2000; ++k) noise.add(0.7, 1e-3 * k, kStill);
  ASSERT_TRUE(noise.rms());
  EXPECT_EQ(*noise.rms(), 0);
}

}  // namespace
}  // namespace limpid
