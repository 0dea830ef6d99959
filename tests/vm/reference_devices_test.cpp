// The reference devices against their protocols and theory, in simulated time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/hid/pid_joystick_model.h"
#include "tests/support/hid/raw_device_model.h"
#include "tests/support/hid/space_mouse_model.h"

namespace limpid::test {
namespace {

using namespace std::chrono_literals;
using testing::IsEmpty;
using testing::SizeIs;

constexpr Time kStart = 100s;  // any time of the device's life

Report command(std::uint32_t sequence, float torque) {
  Report report(65);
  const auto message = std::span(report).subspan(1);
  message[0] = 0x4C;
  message[1] = 1;
  message[2] = 3;
  message[3] = 1;
  write_at(message, 4, sequence);
  write_at(message, 16, torque);
  write_at(message, 60, crc32_of(message.first(60)));
  return report;
}

// Advances the device from `from` to `until`; returns the newest report.
Report live(ReferenceDevice& device, Time from, Time until) {
  Report newest;
  for (Time now = from + 1ms; now <= until; now += 1ms) {
    for (const Report& report : device.input(now)) newest = report;
  }
  return newest;
}

// A host of the standard layout that uses only an effect of constant force along X.
struct PidHost {
  PidReports reports = pid_reports(PidLayout::standard());
  using Kind = DescriptorWriter::Kind;

  Report control(int what) const {
    Report report = reports.writer.blank(Kind::output, reports.control.id);
    put(report, reports.control, what);
    return report;
  }
  Report create() const {
    Report report = reports.writer.blank(Kind::feature, reports.create_type->id);
    put(report, *reports.create_type, 1);
    return report;
  }
  Report effect(int index, int milliseconds) const {
    Report report = reports.writer.blank(Kind::output, reports.effect_index.id);
    put(report, reports.effect_index, index);
    put(report, reports.effect_type, 1);
    put(report, reports.duration, milliseconds);
    put(report, reports.gain, reports.gain.max);
    put(report, *reports.axes, 1);
    return report;
  }
  Report magnitude(int index, int value) const {
    Report report = reports.writer.blank(Kind::output, reports.constant_index.id);
    put(report, reports.constant_index, index);
    put(report, reports.magnitude, value);
    return report;
  }
  Report start(int index) const {
    Report report = reports.writer.blank(Kind::output, reports.operation.id);
    put(report, reports.operation_index, index);
    put(report, reports.operation, 1);
    return report;
  }
};

TEST(CrcOfTheReferences, IsTheOneOfTheStandard) {
  const std::string check = "123456789";  // its check value is published
  EXPECT_EQ(crc32_of({reinterpret_cast<const std::uint8_t*>(check.data()), 9}), 0xCBF43926U);
}

TEST(SprungHand, SwingsAsTheTheorySays) {
  AxisPhysics axis{.inertia = 2e-3, .friction = 0, .stiffness = 2, .damping = 0};
  SprungHand hand({axis});
  hand.begin(kStart);
  const double torque = 0.2, omega = std::sqrt(axis.stiffness / axis.inertia);
  hand.run(kStart + 500ms, [&](Time) { return Torque{torque}; });
  const double expected = torque / axis.stiffness * (1 - std::cos(omega * 0.5));
  EXPECT_NEAR(hand.position(0), expected, 0.01 * torque / axis.stiffness);
}

TEST(RawDeviceModel, GivesWayToTheTorque) {
  RawDeviceModel device({.resolution = 0});
  device.power(true, kStart);
  Report newest;
  for (int i = 1; i <= 1000; ++i) {
    newest = device.input(kStart + i * 1ms).at(0);
    device.output(command(static_cast<std::uint32_t>(i), 0.3F), kStart + i * 1ms + 200us);
  }
  EXPECT_NEAR(read_at<float>(newest, 16), 0.3 / AxisPhysics{}.stiffness, 1e-6);
  EXPECT_THAT(device.violations(), IsEmpty());
  EXPECT_EQ(device.gaps(), 0);
}

TEST(RawDeviceModel, CutsTheTorqueWhenCommandsStop) {
  RawDeviceModel device({.watchdog = 10ms});
  device.power(true, kStart);
  device.output(command(1, 0.3F), kStart + 5ms);
  const Report newest = live(device, kStart + 5ms, kStart + 50ms);
  const auto zero = device.forces().zero_after(kStart + 5ms);
  ASSERT_TRUE(zero);
  EXPECT_GE(*zero, 10ms);
  EXPECT_LE(*zero, 10ms + 2 * SprungHand::kStep);
  EXPECT_EQ(newest[3] & 16, 16) << "its status";
}

TEST(RawDeviceModel, UsesNoCommandWithAFlaw) {
  RawDeviceModel device;
  device.power(true, kStart);
  for (const std::size_t flaw : {1, 2, 3, 20, 61}) {
    Report report = command(1, 0.3F);
    report[flaw] ^= 0x40;
    device.output(report, kStart);
  }
  device.output(command(1, std::nanf("")), kStart);
  device.output(Report(10), kStart);
  EXPECT_EQ(device.rejected(), 7);
  EXPECT_EQ(device.forces().largest(), 0);
}

TEST(RawDeviceModel, TellsWhatAGoodHostDoesNotDo) {
  RawDeviceModel device({.torque_limit = 0.2});
  device.power(true, kStart);
  Report report = command(1, 0.3F);
  report[1 + 50] = 1;  // reserved
  write_at(report, 1 + 40, std::uint32_t{7});
  write_at(report, 1 + 60, crc32_of(std::span(report).subspan(1, 60)));
  device.output(report, kStart);
  EXPECT_THAT(device.violations(), SizeIs(3));
  EXPECT_EQ(device.forces().largest(), 0.2) << "it never does more than it can";
}

TEST(RawDeviceModel, SpoilsItsReportsWhenTold) {
  RawDeviceModel device;
  device.power(true, kStart);
  device.set_fault(Fault::not_a_number);
  EXPECT_TRUE(std::isnan(read_at<float>(device.input(kStart + 1ms).at(0), 16)));
  device.set_fault(Fault::stuck);
  EXPECT_EQ(device.input(kStart + 2ms), device.input(kStart + 3ms));
  device.set_fault(Fault::cut_short);
  EXPECT_EQ(device.input(kStart + 4ms).at(0).size(), 32U);
  device.set_fault(Fault::silent);
  EXPECT_THAT(device.input(kStart + 5ms), IsEmpty());
}

TEST(RawDeviceModel, KeepsItsTorqueWhenItsFirmwareHangs) {
  RawDeviceModel device;
  device.power(true, kStart);
  device.output(command(1, 0.3F), kStart);
  device.set_fault(Fault::frozen);
  device.output(command(2, 0), kStart + 1ms);
  live(device, kStart + 1ms, kStart + 100ms);
  EXPECT_FALSE(device.forces().zero_after(kStart));
  device.power(false, kStart + 101ms);
  EXPECT_EQ(device.forces().zero_after(kStart), 101ms);
}

TEST(PidJoystickModel, EndsAnEffectByItself) {
  PidJoystickModel device;
  const PidHost host;
  device.power(true, kStart);
  ASSERT_TRUE(device.set_feature(host.create(), kStart));
  for (const Report& report : {host.control(1), host.effect(1, 20), host.magnitude(1, -5000)}) {
    device.output(report, kStart);
  }
  device.output(host.start(1), kStart + 2ms);
  EXPECT_EQ(device.acting(kStart + 3ms)[0], -0.5);
  device.output(host.start(1), kStart + 12ms);
  live(device, kStart + 12ms, kStart + 60ms);
  const auto zero = device.forces().zero_after(kStart + 12ms);
  ASSERT_TRUE(zero);
  EXPECT_GE(*zero, 20ms);
  EXPECT_LE(*zero, 20ms + 2 * SprungHand::kStep);
  EXPECT_THAT(device.violations(), IsEmpty());
}

TEST(PidJoystickModel, PushesOnlyWithItsActuatorsOn) {
  PidJoystickModel device;
  const PidHost host;
  device.power(true, kStart);
  ASSERT_TRUE(device.set_feature(host.create(), kStart));
  for (const Report& report : {host.effect(1, 0), host.magnitude(1, 10000), host.start(1)}) {
    device.output(report, kStart);
  }
  EXPECT_EQ(device.acting(kStart)[0], 0);
  device.output(host.control(1), kStart);
  EXPECT_EQ(device.acting(kStart)[0], 1);
  device.output(host.control(3), kStart);
  EXPECT_EQ(device.acting(kStart)[0], 0);
}

TEST(PidJoystickModel, HasAFullPoolAtItsEnd) {
  PidJoystickModel device({.capacity = 2});
  const PidHost host;
  device.power(true, kStart);
  for (const int status : {1, 1, 2}) {
    ASSERT_TRUE(device.set_feature(host.create(), kStart));
    const Report load = device.feature(host.reports.load_index.id, kStart).value();
    EXPECT_EQ(get(load, host.reports.load_status), status);
  }
}

TEST(SpaceMouseModel, FallsSilentAtRestAfterOneReportOfZeros) {
  SpaceMouseModel device({.joined = true, .silent_at_rest = true});
  device.move([](double t) { return SpaceMouseModel::Cap{t < 0.0025 ? 1.0 : 0.0}; });
  device.power(true, kStart);
  Time now = kStart;
  for (const int expected : {350, 350, 0}) {
    const auto reports = device.input(now += 1ms);
    ASSERT_EQ(reports.size(), 1U);
    EXPECT_EQ(read_at<std::int16_t>(reports[0], 1), expected);
  }
  EXPECT_THAT(device.input(now += 1ms), IsEmpty());
}

}  // namespace
}  // namespace limpid::test
