// Version 2 of the raw protocol: joints of both kinds, buttons, reasons, and what is checked.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "devices/hid/hid_exchange.h"
#include "devices/hid/hid_transport.h"
#include "devices/hid/raw_protocol.h"
#include "tests/support/fake_hid.h"
#include "tests/support/raw_reports.h"

namespace limpid {
namespace {

using test::byte;
using test::open_raw;
using test::Raw2Description;
using test::Raw2Joint;
using test::Raw2Report;
using test::raw_2_feature;
using test::raw_2_reading;
using test::sealed_2;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
// A joint that turns by +-1 rad at most at 10 rad/s, and one that slides by +-0.2 m at 2 m/s.
const std::vector<Raw2Joint> kTwoJoints{{false, 1, 0.5f, 10}, {true, 0.2f, 4, 2}};

std::string complaint_2(const Raw2Description& feature) {
  RawProtocol protocol;
  try {
    open_raw(protocol, sealed_2(feature));
  } catch (const HidError& error) {
    return error.what();
  }
  return "none";
}

struct OpenRaw2 : testing::Test {
  OpenRaw2() { open_raw(protocol, sealed_2(raw_2_feature(kTwoJoints))); }
  Decoded decode(const Raw2Report& report) { return protocol.decode(sealed_2(report), reading); }
  RawProtocol protocol;
  DeviceReading reading;
};

// A slide counts in units of 0.1 m, as in rows: its torque per unit is 0.1 m times its force.
TEST_F(OpenRaw2, KnowsWhatTheDeviceIs) {
  const DeviceTraits& traits = protocol.traits();
  EXPECT_EQ(traits.dof, 2);
  EXPECT_TRUE(traits.pushes);
  EXPECT_EQ(traits.name, "V2");
  EXPECT_EQ(protocol.traits().made_by, "f");
  EXPECT_EQ(traits.slides, (std::vector<bool>{false, true}));
  EXPECT_NEAR(traits.upper.at(0), 1, 1e-6);
  EXPECT_NEAR(traits.upper.at(1), 2, 1e-6);
  EXPECT_NEAR(traits.lower.at(1), -2, 1e-6);
  EXPECT_NEAR(traits.effort.at(0), 0.5, 1e-6);
  EXPECT_NEAR(traits.effort.at(1), 0.4, 1e-6);
  EXPECT_NEAR(traits.resolution.at(1), 1e-3, 1e-9);
}

// The report was made byte for byte by Python's struct; the CRC is zlib's.
TEST_F(OpenRaw2, ReadsAReportThatAnotherProgramMade) {
  Report report(129);
  const Report start{0,    0x4C, 2,    2,   0b0110, 7, 0,    0,    0,    0x40, 0xE2,
                     0x01, 0,    0,    0,   0,      0, 0x00, 0x00, 0x80, 0x3E,  // 0.25
                     0xCD, 0xCC, 0x4C, 0xBD};                                   // -0.05
  std::copy(start.begin(), start.end(), report.begin());
  report[byte(48)] = 3;
  report[byte(52)] = 2;
  report[byte(56)] = 7;
  store_le<std::uint32_t>(report, byte(60), 0x3F400000);  // 0.75
  store_le<std::uint32_t>(report, byte(64), 0x3F800000);  // 1
  store_le<std::uint32_t>(report, byte(84), 0x3FC00000);  // 1.5
  store_le<std::uint32_t>(report, byte(124), 0xAE4C213F);
  ASSERT_EQ(protocol.decode(report, reading), Decoded::reading);
  EXPECT_EQ(reading.x[0], 0.25);
  EXPECT_NEAR(reading.x[1], -0.5, 1e-6);
  EXPECT_TRUE(reading.hand);
  EXPECT_TRUE(reading.calibrated);
  EXPECT_FALSE(reading.fault);
  EXPECT_EQ(reading.buttons, 2u);
  EXPECT_EQ(reading.buttons_known, ~0u);
  EXPECT_EQ(reading.no_force, NoForce::warm);
  EXPECT_EQ(reading.warmth, 0.75f);
  EXPECT_EQ(reading.orientation, (std::array{1.0, 0.0, 0.0, 0.0}));
  EXPECT_EQ(protocol.extras().measured[1], 1.5f);
}

TEST_F(OpenRaw2, UsesNoDamagedReading) {
  const Report good = sealed_2(raw_2_reading(1, {0.1f, 0.02f}));
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      Report bad = good;
      bad[i] = static_cast<std::uint8_t>(bad[i] ^ 1 << bit);
      ASSERT_EQ(protocol.decode(bad, reading), Decoded::unusable) << i;
    }
  }
  for (std::size_t size = 0; size < good.size(); ++size) {
    const Report cut(good.begin(), good.begin() + static_cast<long>(size));
    EXPECT_EQ(protocol.decode(cut, reading), Decoded::unusable);
  }
  EXPECT_EQ(protocol.decode(good, reading), Decoded::reading);
}

TEST_F(OpenRaw2, UsesNoReportOfVersion1OrWithOtherJoints) {
  EXPECT_EQ(protocol.decode(test::sealed(test::raw_reading(1, {0, 0})), reading),
            Decoded::unusable);
  EXPECT_EQ(decode(raw_2_reading(1, {0, 0, 0})), Decoded::unusable);
  EXPECT_EQ(decode(raw_2_reading(1, {kNan, 0})), Decoded::unusable);
}

TEST_F(OpenRaw2, TakesAReasonForNoForceForALapse) {
  Raw2Report report = raw_2_reading(1, {0, 0});
  decode(report);
  EXPECT_EQ(reading.lapses, 0u);
  report = raw_2_reading(2, {0, 0});
  report[byte(56)] = 2;
  decode(report);
  EXPECT_EQ(reading.no_force, NoForce::velocity);
  EXPECT_EQ(reading.lapses, 1u);
  report = raw_2_reading(3, {0, 0});
  report[byte(56)] = 200;
  decode(report);
  EXPECT_EQ(reading.no_force, NoForce::other);
  EXPECT_EQ(reading.lapses, 2u);
  decode(raw_2_reading(4, {0, 0}));
  EXPECT_EQ(reading.no_force, NoForce::none);
  EXPECT_EQ(reading.lapses, 2u);
}

TEST_F(OpenRaw2, HearsOfHandFaultAndCalibration) {
  decode(raw_2_reading(1, {0, 0}, test::kRawCalibrated));
  EXPECT_FALSE(reading.hand);
  EXPECT_FALSE(reading.fault);
  decode(raw_2_reading(2, {0, 0}, test::kRawHand));
  EXPECT_TRUE(reading.fault);
  EXPECT_FALSE(reading.calibrated);
  decode(raw_2_reading(3, {0, 0}, test::kRawHand | test::kRawCalibrated | test::kRawFault));
  EXPECT_TRUE(reading.fault);
  EXPECT_TRUE(reading.calibrated);
}

TEST_F(OpenRaw2, TakesNoWarmthThatIsNone) {
  std::uint32_t sequence = 0;
  const auto with = [&](float warmth) {
    Raw2Report report = raw_2_reading(++sequence, {0, 0});
    store_float_le(report, byte(60), warmth);
    decode(report);
    return reading.warmth;
  };
  EXPECT_EQ(with(0.5f), 0.5f);
  EXPECT_EQ(with(7), 1);
  EXPECT_EQ(with(-1), 0);
  EXPECT_EQ(with(kNan), 0);
}

TEST_F(OpenRaw2, TakesNoOrientationThatIsNone) {
  std::uint32_t sequence = 0;
  const auto with = [&](std::array<float, 4> parts) {
    Raw2Report report = raw_2_reading(++sequence, {0, 0});
    for (std::size_t i = 0; i < 4; ++i) store_float_le(report, byte(64 + 4 * i), parts[i]);
    decode(report);
    return reading.oriented();
  };
  EXPECT_FALSE(with({0, 0, 0, 0}));
  EXPECT_TRUE(with({0, 1, 0, 0}));
  EXPECT_FALSE(with({2, 0, 0, 0}));
  EXPECT_FALSE(with({0.98f, 0, 0, 0}));
  EXPECT_FALSE(with({kNan, 0, 0, 1}));
  EXPECT_FALSE(with({0, 0, std::numeric_limits<float>::infinity(), 0}));
  // 1 / 0.995 is another length than 1, which counts as rounding.
  EXPECT_TRUE(with({0, 0, 0.6f / 0.995f, 0.8f / 0.995f}));
  EXPECT_NEAR(reading.orientation[2], 0.6, 1e-7);
  EXPECT_NEAR(reading.orientation[3], 0.8, 1e-7);
}

// The tenth of a range of 0.4 m is 0.04 m.
TEST_F(OpenRaw2, FindsAPlaceFaultyThatTheDeviceSaysItCannotReach) {
  EXPECT_EQ(decode(raw_2_reading(1, {0, 0.239f})), Decoded::reading);
  EXPECT_FALSE(reading.fault);
  EXPECT_EQ(decode(raw_2_reading(2, {0, 0.241f})), Decoded::status);
  EXPECT_TRUE(reading.fault);
  EXPECT_NEAR(reading.x[1], 2.39, 1e-5) << "where it was last";
  EXPECT_EQ(decode(raw_2_reading(3, {-1.21f, 0.239f})), Decoded::status);
  EXPECT_EQ(decode(raw_2_reading(400, {-1.19f, 0.239f})), Decoded::reading);
  EXPECT_FALSE(reading.fault);
}

// At 10 rad/s a joint goes 0.01 rad in a millisecond, at 2 m/s a slide 2 mm.
TEST_F(OpenRaw2, FindsAMotionFaultyThatTheDeviceSaysItCannotMake) {
  EXPECT_EQ(decode(raw_2_reading(1, {0.5f, 0})), Decoded::reading) << "the first one is anywhere";
  EXPECT_EQ(decode(raw_2_reading(2, {0.509f, 0})), Decoded::reading);
  EXPECT_EQ(decode(raw_2_reading(3, {0.53f, 0})), Decoded::status);
  EXPECT_TRUE(reading.fault);
  EXPECT_EQ(decode(raw_2_reading(4, {0.51f, 0.003f})), Decoded::reading);
  EXPECT_EQ(decode(raw_2_reading(5, {0.51f, 0.006f})), Decoded::status);
  EXPECT_EQ(decode(raw_2_reading(104, {0.01f, 0.1f})), Decoded::reading) << "half a rad in 100 ms";
}

// A clock of the device that stands still does not make every motion too fast.
TEST_F(OpenRaw2, CountsReportsWhereTheDevicesClockStandsStill) {
  for (std::uint32_t i = 1; i < 20; ++i) {
    Raw2Report report = raw_2_reading(i, {0.009f * static_cast<float>(i), 0});
    store_le(report, byte(8), std::uint64_t{77});
    EXPECT_EQ(decode(report), Decoded::reading) << i;
  }
}

TEST_F(OpenRaw2, SendsTorqueToAJointThatTurnsAndForceToOneThatSlides) {
  decode(raw_2_reading(9, {0, 0}));
  Report sent;
  const std::vector<double> torque{0.25, -0.2};
  protocol.encode(torque, {}, [&](auto report) { sent.assign(report.begin(), report.end()); });
  ASSERT_EQ(sent.size(), 65u);
  Report again = sent;
  seal_raw_report(again);
  EXPECT_EQ(sent, again);
  EXPECT_EQ(sent[byte(1)], 2);
  EXPECT_EQ(sent[byte(3)], 1);
  EXPECT_EQ(load_float_le(sent, byte(16)), 0.25f);
  EXPECT_EQ(load_float_le(sent, byte(20)), -2.f);
  EXPECT_EQ(load_le<std::uint32_t>(sent, byte(48)), 9u);
  EXPECT_EQ(protocol.stop_reports().at(0)[byte(3)], 0);
  EXPECT_EQ(protocol.stop_reports().at(0)[byte(1)], 2);
}

TEST(Raw2, GivesNoTorqueToAJointWithoutAMotor) {
  const auto device = std::make_shared<test::FakeHid>();
  device->features[0] = sealed_2(raw_2_feature({{false, 1, 0.5f}, {false, 1, 0}}));
  test::FakeTransport transport(device);
  RawProtocol protocol;
  protocol.open(transport);
  nanoseconds now = std::chrono::seconds(1);
  HidExchange exchange(transport, protocol, [&] { return now; });
  device->send(sealed_2(raw_2_reading(1, {0, 0})));
  exchange.step();
  DeviceReading reading;
  exchange.read(reading);
  exchange.write(std::vector<double>{0.3, 0.3});
  exchange.step();
  const Report sent = device->received().back();
  EXPECT_EQ(load_float_le(sent, byte(16)), 0.3f);
  EXPECT_EQ(load_float_le(sent, byte(20)), 0.f);
}

TEST(Raw2, RefusesDevicesThatAreNotFitForAHand) {
  using testing::HasSubstr;
  const Raw2Description good = raw_2_feature(kTwoJoints);
  EXPECT_EQ(complaint_2(good), "none");
  EXPECT_EQ(complaint_2(raw_2_feature(std::vector<Raw2Joint>(8, {true, 1, 1}))), "none");
  EXPECT_THAT(complaint_2(raw_2_feature(std::vector<Raw2Joint>(9))), HasSubstr("9 joints"));
  EXPECT_THAT(complaint_2(raw_2_feature({{false, 1, 0}})), HasSubstr("no joint has a motor"));
  EXPECT_EQ(complaint_2(raw_2_feature({{false, 1, 0}}, false)), "none");
  const auto with = [&](std::size_t at, float value) {
    Raw2Description bad = good;
    store_float_le(bad, byte(at), value);
    return complaint_2(bad);
  };
  Raw2Description kind = good;
  kind[byte(9)] = 2;
  EXPECT_THAT(complaint_2(kind), HasSubstr("joint 2 is of kind 2"));
  EXPECT_THAT(with(16, 2), HasSubstr("the range of joint 1 is 2 to 1 rad"));
  EXPECT_THAT(with(52, 11), HasSubstr("the range of joint 2 is"));
  EXPECT_THAT(with(52, kNan), HasSubstr("the range of joint 2 is"));
  EXPECT_THAT(with(80, 0), HasSubstr("resolution of joint 1"));
  EXPECT_THAT(with(112, -1), HasSubstr("joint 1 can push with -1 N m"));
  EXPECT_THAT(with(116, kNan), HasSubstr("joint 2 can push with"));
  EXPECT_THAT(with(144, -1), HasSubstr("the largest speed of joint 1 is"));
}

// Some firmware hangs if it is asked for more than it has.
TEST(Raw2, AsksADeviceOfVersion1ForNoMoreThanItHas) {
  struct Asked final : HidTransport {
    Report feature;
    std::vector<std::size_t> sizes;
    std::vector<std::uint8_t> none;

    int read(std::span<std::uint8_t>, int) noexcept override { return 0; }
    bool write(std::span<const std::uint8_t>) noexcept override { return true; }
    int get_feature(std::span<std::uint8_t> report) noexcept override {
      sizes.push_back(report.size());
      const std::size_t size = std::min(report.size(), feature.size());
      std::copy_n(feature.begin(), size, report.begin());
      return static_cast<int>(size);
    }
    bool set_feature(std::span<const std::uint8_t>) noexcept override { return false; }
    void ask(std::span<const std::uint8_t>) noexcept override {}
    const std::vector<std::uint8_t>& report_descriptor() const override { return none; }
  };
  Asked first, second;
  first.feature = test::sealed(test::raw_feature(2));
  second.feature = sealed_2(raw_2_feature(kTwoJoints));
  RawProtocol().open(first);
  RawProtocol().open(second);
  EXPECT_EQ(first.sizes, (std::vector<std::size_t>{65}));
  EXPECT_EQ(second.sizes, (std::vector<std::size_t>{65, 257}));
}

}  // namespace
}  // namespace limpid
