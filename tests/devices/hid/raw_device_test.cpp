// The device's end of the raw protocol, against Limpid's end of it.
#include "devices/hid/raw_device.h"

#include <gtest/gtest.h>

#include <limits>

#include "devices/hid/raw_protocol.h"
#include "tests/support/fake_hid.h"

namespace limpid {
namespace {

constexpr std::size_t kJoints = 3;

RawDescription description() {
  RawDescription one{.name = "A device",
                     .made_by = "a library",
                     .pushes = true,
                     .rate = 1000,
                     .watchdog = 5,
                     .joints = {}};
  one.joints.assign(
      kJoints,
      {.slides = true, .lower = -0.2, .upper = 0.3, .resolution = 1e-5, .effort = 4, .speed = 5});
  return one;
}

// A packet as a report, behind its id.
template <class Bytes>
Report report_of(const Bytes& bytes) {
  Report report{0};
  report.insert(report.end(), bytes.begin(), bytes.end());
  return report;
}

struct RawDeviceAndLimpid : testing::Test {
  RawDeviceAndLimpid() {
    const auto device = std::make_shared<test::FakeHid>();
    device->features[0] = report_of(raw_feature(description()));
    test::FakeTransport transport(device);
    protocol.open(transport);
  }
  // Packet of a command by Limpid.
  std::vector<std::uint8_t> command(const std::vector<double>& torque) {
    std::vector<std::uint8_t> packet;
    protocol.encode(torque, {}, [&](auto all) { packet.assign(all.begin() + 1, all.end()); });
    return packet;
  }

  RawProtocol protocol;
};

TEST_F(RawDeviceAndLimpid, SayTheSameOfTheDevice) {
  const DeviceTraits& traits = protocol.traits();
  EXPECT_EQ(traits.name, "A device");
  EXPECT_EQ(protocol.traits().made_by, "a library");
  EXPECT_EQ(traits.dof, 3);
  EXPECT_NEAR(traits.lower[2], -2, 1e-6);
  EXPECT_NEAR(traits.upper[2], 3, 1e-6);
  EXPECT_NEAR(traits.effort[0], 0.4, 1e-6);
}

TEST_F(RawDeviceAndLimpid, SayTheSameOfAReading) {
  RawState state{.sequence = 7, .answered = 3, .time_stamp = 1000, .flags = RawFlag::calibrated};
  state.x = {0.1, -0.05, 0.2};
  state.buttons = 5;
  state.no_force = NoForce::dead_man;
  state.warmth = 0.5f;
  state.orientation = {0.5f, -0.5f, 0.5f, -0.5f};
  DeviceReading reading;
  ASSERT_EQ(protocol.decode(report_of(raw_reading(state, kJoints)), reading), Decoded::reading);
  EXPECT_NEAR(reading.x[0], 1, 1e-6);
  EXPECT_NEAR(reading.x[1], -0.5, 1e-6);
  EXPECT_NEAR(reading.x[2], 2, 1e-6);
  EXPECT_FALSE(reading.hand);
  EXPECT_FALSE(reading.fault);
  EXPECT_EQ(reading.buttons, 5u);
  EXPECT_EQ(reading.no_force, NoForce::dead_man);
  EXPECT_EQ(reading.warmth, 0.5f);
  EXPECT_EQ(reading.orientation, (std::array{0.5, -0.5, 0.5, -0.5}));
}

TEST_F(RawDeviceAndLimpid, SayTheSameOfAForce) {
  const auto order = raw_order(command({0.1, -0.2, 0}), kJoints, 0);
  ASSERT_TRUE(order);
  EXPECT_EQ(order->mode, RawMode::torque);
  EXPECT_EQ(order->sequence, 1u);
  EXPECT_NEAR(order->torque[0], 1, 1e-6);
  EXPECT_NEAR(order->torque[1], -2, 1e-6);
}

// The rules for firmware.
TEST_F(RawDeviceAndLimpid, ObeyOnlyWhatIsWhole) {
  const auto good = command({0.1, 0, 0});
  ASSERT_TRUE(raw_order(good, kJoints, 0));
  for (std::size_t i = 0; i < good.size(); ++i) {
    auto bad = good;
    bad[i] ^= 1;
    EXPECT_FALSE(raw_order(bad, kJoints, 0)) << i;
    EXPECT_FALSE(raw_order(std::span(good).first(i), kJoints, 0)) << i;
  }
  EXPECT_FALSE(raw_order(good, kJoints + 1, 0)) << "of another device";
  auto mode = good;
  mode[RawAt::flags] = 2;
  seal_raw_bytes(mode);
  EXPECT_FALSE(raw_order(mode, kJoints, 0));
  auto endless = good;
  store_float_le(endless, RawAt::values, std::numeric_limits<float>::infinity());
  seal_raw_bytes(endless);
  EXPECT_FALSE(raw_order(endless, kJoints, 0));
}

TEST_F(RawDeviceAndLimpid, ObeyAForceOnceAndItsEndAlways) {
  const auto force = command({0.1, 0, 0});
  EXPECT_TRUE(raw_order(force, kJoints, 0));
  EXPECT_TRUE(raw_order(force, kJoints, 0xFFFFFFFF)) << "the count begins anew";
  EXPECT_FALSE(raw_order(force, kJoints, 1)) << "it was obeyed already";
  EXPECT_FALSE(raw_order(force, kJoints, 2));
  const Report& stop = protocol.stop_reports().at(0);
  const auto end = raw_order(std::span(stop).subspan(1), kJoints, 1000);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->mode, RawMode::no_torque);
}

}  // namespace
}  // namespace limpid
