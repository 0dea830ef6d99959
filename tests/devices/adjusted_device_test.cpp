#include "devices/adjusted_device.h"

#include <gtest/gtest.h>

#include "tests/support/fake_device.h"

namespace limpid {
namespace {

// Two joints: the first turned round, twice as far and with its zero moved; the second unchanged.
struct Adjusted : testing::Test {
  Adjusted() {
    auto inner = std::make_unique<test::FakeDevice>(2);
    fake = inner.get();
    const std::array<AxisAdjustment, 1> axes{{{.zero = 0.25, .scale = 2, .inverted = true}}};
    device = std::make_unique<AdjustedDevice>(std::move(inner), axes);
  }
  test::FakeDevice* fake = nullptr;
  std::unique_ptr<AdjustedDevice> device;
  DeviceReading reading;
};

TEST_F(Adjusted, SaysAnglesAsItsUserWantsThem) {
  fake->reading.x = {0.25, 0.5};
  fake->reading.buttons = 5;
  fake->reading.orientation = {0, 1, 0, 0};
  ASSERT_TRUE(device->read(reading));
  EXPECT_DOUBLE_EQ(reading.x[0], 0);
  EXPECT_DOUBLE_EQ(reading.x[1], 0.5);
  EXPECT_EQ(reading.buttons, 5u);
  EXPECT_EQ(reading.orientation, fake->reading.orientation);
  fake->reading.x[0] = 0.5;
  device->read(reading);
  EXPECT_DOUBLE_EQ(reading.x[0], -0.5);
  fake->here = false;
  EXPECT_FALSE(device->read(reading));
}

TEST_F(Adjusted, TurnsItsRangeRoundWithIt) {
  const DeviceTraits& traits = device->traits();
  EXPECT_DOUBLE_EQ(traits.lower.at(0), -1.5);  // this is the device's upper end, 1
  EXPECT_DOUBLE_EQ(traits.upper.at(0), 2.5);
  EXPECT_DOUBLE_EQ(traits.resolution.at(0), 2e-4);
  EXPECT_DOUBLE_EQ(traits.effort.at(0), 0.25);
  EXPECT_DOUBLE_EQ(traits.lower.at(1), -1);
  EXPECT_DOUBLE_EQ(traits.effort.at(1), 0.5);
}

TEST_F(Adjusted, PushesWithTheSamePowerAsItIsTold) {
  const std::array<double, 2> torque{0.1, -0.2};
  device->read(reading);
  const auto before = reading.x;
  fake->reading.x = {0.01, 0.02};
  device->read(reading);
  device->write(torque);
  double wanted = 0, real = 0;  // [J]
  for (std::size_t i = 0; i < 2; ++i) {
    wanted += torque[i] * (reading.x[i] - before[i]);
    real += fake->told[i] * fake->reading.x[i];
  }
  EXPECT_NEAR(real, wanted, 1e-15);
  EXPECT_DOUBLE_EQ(fake->told[1], -0.2);
}

// The motors give twice the commanded torque. The joint's torque is the wanted one, and its limit
// is the most that the device accepts.
TEST(AdjustedTorque, IsWhatTheMotorsGive) {
  constexpr double kScale = 2;
  auto inner = std::make_unique<test::FakeDevice>(2);
  test::FakeDevice& fake = *inner;
  const double most = inner->traits().effort.at(1);
  AdjustedDevice device(std::move(inner), {}, kScale);
  device.write(std::array<double, 2>{0.1, -0.2});
  EXPECT_DOUBLE_EQ(kScale * fake.told[0], 0.1);
  EXPECT_DOUBLE_EQ(kScale * fake.told[1], -0.2);
  device.write(std::array<double, 2>{0, device.traits().effort.at(1)});
  EXPECT_DOUBLE_EQ(fake.told[1], most);
}

TEST_F(Adjusted, Stops) {
  device->stop();
  EXPECT_TRUE(fake->stopped);
}

// The command is reversed, so the device does what is asked; its readings stay.
TEST(AdjustedDevice, TurnsTheTorqueOfAReversedMotorRoundAndNothingElse) {
  auto inner = std::make_unique<test::FakeDevice>(3);
  test::FakeDevice& fake = *inner;
  const std::array<AxisAdjustment, 3> axes{
      {{.reversed = true}, {}, {.scale = 2, .inverted = true, .reversed = true}}};
  AdjustedDevice device(std::move(inner), axes, 0.5);
  fake.reading.x = {0.1, 0.2, 0.3};
  DeviceReading reading;
  device.read(reading);
  EXPECT_EQ(reading.x[0], 0.1);
  EXPECT_EQ(reading.x[2], -0.6);
  device.write(std::array{0.1, 0.2, 0.05});
  EXPECT_DOUBLE_EQ(fake.told[0], -0.1 / 0.5);
  EXPECT_DOUBLE_EQ(fake.told[1], 0.2 / 0.5);
  EXPECT_DOUBLE_EQ(fake.told[2], 2 * 0.05 / 0.5);
  EXPECT_EQ(device.traits().effort, (std::vector{0.25, 0.25, 0.125}));
}

}  // namespace
}  // namespace limpid
