#include "devices/hid/raw_protocol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "devices/hid/hid_transport.h"
#include "tests/support/fake_hid.h"
#include "tests/support/hid_descriptors.h"
#include "tests/support/raw_reports.h"

namespace limpid {
namespace {

using test::byte;
using test::open_raw;
using test::raw_reading;
using test::RawReport;
using test::sealed;

std::string complaint_1(const RawReport& feature) {
  RawProtocol protocol;
  try {
    open_raw(protocol, sealed(feature));
  } catch (const HidError& error) {
    return error.what();
  }
  return "none";
}

struct OpenRawProtocol : testing::Test {
  OpenRawProtocol() { open_raw(protocol, sealed(test::raw_feature(2))); }
  Decoded decode(const Report& report) { return protocol.decode(report, reading); }
  test::RawCommand encode(const std::vector<double>& torque) {
    Report sent;
    protocol.encode(torque, {}, [&](auto report) { sent.assign(report.begin(), report.end()); });
    return test::raw_command(sent);
  }
  RawProtocol protocol;
  DeviceReading reading;
};

TEST_F(OpenRawProtocol, KnowsWhatTheDeviceIs) {
  const DeviceTraits& traits = protocol.traits();
  EXPECT_EQ(traits.dof, 2);
  EXPECT_TRUE(traits.pushes);
  EXPECT_EQ(traits.name, "T2");
  EXPECT_EQ(traits.rate, 1000);
  EXPECT_DOUBLE_EQ(traits.lower.at(1), -1);
  EXPECT_DOUBLE_EQ(traits.upper.at(1), 1);
  EXPECT_DOUBLE_EQ(traits.effort.at(1), 0.5);
  EXPECT_FLOAT_EQ(static_cast<float>(traits.resolution.at(1)), 1e-4f);
}

// The report was made byte for byte by another program; the CRC is zlib's.
TEST_F(OpenRawProtocol, ReadsAReportThatAnotherProgramMade) {
  Report report(65);
  const Report start{0,    0x4C, 1,    2,   0b0110, 7, 0,    0,    0,    0x40, 0xE2,
                     0x01, 0,    0,    0,   0,      0, 0x00, 0x00, 0x80, 0x3E,  // 0.25
                     0x00, 0x00, 0xC0, 0xBF};                                   // -1.5
  std::copy(start.begin(), start.end(), report.begin());
  report[byte(40)] = 3;
  store_le<std::uint32_t>(report, byte(60), 0x4D5AA982);
  ASSERT_EQ(decode(report), Decoded::reading);
  EXPECT_EQ(reading.x[0], 0.25);
  EXPECT_EQ(reading.x[1], -1.5);
  EXPECT_TRUE(reading.hand);
  EXPECT_FALSE(reading.fault);
  EXPECT_EQ(encode({0.1, 0}).answered, 7u);
}

TEST_F(OpenRawProtocol, UsesNoDamagedReading) {
  const Report good = sealed(raw_reading(1, {0.1f, 0.2f}));
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      Report bad = good;
      bad[i] = static_cast<std::uint8_t>(bad[i] ^ 1 << bit);
      ASSERT_EQ(decode(bad), Decoded::unusable) << i;
    }
  }
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_EQ(decode(Report(good.begin(), good.begin() + static_cast<long>(size))),
              Decoded::unusable);
  }
  EXPECT_EQ(reading.x[0], 0);
  EXPECT_EQ(decode(good), Decoded::reading);
}

TEST_F(OpenRawProtocol, UsesNoOtherMagicVersionOrNumberOfJoints) {
  for (std::size_t i = 0; i < 3; ++i) {
    RawReport report = raw_reading(1, {0, 0});
    ++report[byte(i)];
    EXPECT_EQ(decode(sealed(report)), Decoded::unusable) << i;
  }
  EXPECT_EQ(decode(sealed(raw_reading(1, {0, 0, 0}))), Decoded::unusable);
  EXPECT_EQ(decode(sealed(raw_reading(1, {0}))), Decoded::unusable);
}

TEST_F(OpenRawProtocol, UsesNoPositionThatIsNotFinite) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    EXPECT_EQ(decode(sealed(raw_reading(1, {0.1f, bad}))), Decoded::unusable);
  }
  EXPECT_EQ(reading.x[0], 0);
}

TEST_F(OpenRawProtocol, TakesNoRepetitionForNews) {
  EXPECT_EQ(decode(sealed(raw_reading(5, {0, 0}))), Decoded::reading);
  EXPECT_EQ(decode(sealed(raw_reading(5, {0, 0}))), Decoded::unusable);
  EXPECT_EQ(decode(sealed(raw_reading(4, {0, 0}))), Decoded::unusable);
  EXPECT_EQ(decode(sealed(raw_reading(9, {0, 0}))), Decoded::reading);
}

TEST_F(OpenRawProtocol, CountsOnWhenTheSequenceWrapsAround) {
  EXPECT_EQ(decode(sealed(raw_reading(0xFFFFFFFF, {0, 0}))), Decoded::reading);
  EXPECT_EQ(decode(sealed(raw_reading(0, {0, 0}))), Decoded::reading);
}

TEST_F(OpenRawProtocol, HearsOfTheHandAndOfFaults) {
  decode(sealed(raw_reading(1, {0, 0}, test::kRawCalibrated)));
  EXPECT_FALSE(reading.hand);
  EXPECT_FALSE(reading.fault);
  decode(sealed(raw_reading(2, {0, 0}, test::kRawHand | test::kRawCalibrated | test::kRawFault)));
  EXPECT_TRUE(reading.hand);
  EXPECT_TRUE(reading.fault);
  decode(sealed(raw_reading(3, {0, 0}, test::kRawHand)));
  EXPECT_TRUE(reading.fault) << "not calibrated";
}

// Each report with that flag counts: a command may be lost on the way as well.
TEST_F(OpenRawProtocol, TakesItForALapseWhenItsWatchdogHasCut) {
  constexpr std::uint8_t kWell = test::kRawHand | test::kRawCalibrated, kCut = 1 << 4;
  decode(sealed(raw_reading(1, {0, 0}, kWell)));
  EXPECT_EQ(reading.lapses, 0u);
  decode(sealed(raw_reading(2, {0, 0}, kWell | kCut)));
  EXPECT_EQ(reading.lapses, 1u);
  decode(sealed(raw_reading(3, {0, 0}, kWell | kCut)));
  EXPECT_EQ(reading.lapses, 2u);
  EXPECT_FALSE(reading.fault);
  decode(sealed(raw_reading(4, {0, 0}, kWell)));
  EXPECT_EQ(reading.lapses, 2u);
  EXPECT_EQ(decode(sealed(raw_reading(4, {0, 0}, kWell | kCut))), Decoded::unusable);
  EXPECT_EQ(reading.lapses, 2u) << "a repetition is no news";
}

TEST_F(OpenRawProtocol, SendsTorquesWithARisingSequence) {
  const test::RawCommand first = encode({0.25, -0.5}), second = encode({0, 0});
  EXPECT_TRUE(first.right);
  EXPECT_EQ(first.mode, 1);
  EXPECT_EQ(first.torque[0], 0.25f);
  EXPECT_EQ(first.torque[1], -0.5f);
  EXPECT_EQ(first.torque[2], 0);
  EXPECT_EQ(second.mode, 0);
  EXPECT_EQ(second.sequence, first.sequence + 1);
}

TEST_F(OpenRawProtocol, StopsWithModeZero) {
  ASSERT_EQ(protocol.stop_reports().size(), 1u);
  const test::RawCommand stop = test::raw_command(protocol.stop_reports()[0]);
  EXPECT_TRUE(stop.right);
  EXPECT_EQ(stop.mode, 0);
  EXPECT_EQ(stop.sequence, 0u);
  EXPECT_FALSE(stop.pushes());
}

TEST(RawProtocol, RefusesDevicesThatAreNotFitForAHand) {
  using testing::HasSubstr;
  const RawReport good = test::raw_feature(3);
  const auto with = [&](std::size_t at, std::uint16_t value) {
    RawReport bad = good;
    store_le(bad, byte(at), value);
    return complaint_1(bad);
  };
  EXPECT_EQ(complaint_1(good), "none");
  EXPECT_THAT(complaint_1(test::raw_feature(0)), HasSubstr("0 joints"));
  EXPECT_THAT(complaint_1(test::raw_header(7, 1)), HasSubstr("7 joints"));
  EXPECT_THAT(with(4, 100), HasSubstr("100 Hz"));
  EXPECT_THAT(with(6, 11), HasSubstr("11 ms"));
  EXPECT_THAT(with(6, 0), HasSubstr("0 ms"));
  EXPECT_THAT(with(8 + 4 + 2, static_cast<std::uint16_t>(-2000)),
              HasSubstr("the range of joint 2 is"));
  EXPECT_THAT(with(36 + 4, 0), HasSubstr("joint 3 can push with 0"));
  for (const float bad : {0.f, -1.f, std::numeric_limits<float>::quiet_NaN()}) {
    RawReport feature = good;
    store_float_le(feature, byte(32), bad);
    EXPECT_THAT(complaint_1(feature), HasSubstr("resolution"));
  }
}

TEST(RawProtocol, RefusesASilentOrDamagedDescription) {
  RawProtocol protocol;
  EXPECT_THROW(open_raw(protocol, {}), HidError);
  Report damaged = sealed(test::raw_feature(2));
  damaged[byte(50)] ^= 1;
  EXPECT_THROW(open_raw(protocol, damaged), HidError);
}

TEST(RawProtocol, AsksLessOfADeviceWithoutMotors) {
  RawReport feature = test::raw_feature(2, false);
  store_le<std::uint16_t>(feature, byte(4), 60);
  store_le<std::uint16_t>(feature, byte(6), 0);
  EXPECT_EQ(complaint_1(feature), "none");
}

TEST(RawProtocol, IsKnownByItsVendorPage) {
  EXPECT_TRUE(RawProtocol::describes(parse_report_descriptor(test::raw_device())));
  EXPECT_FALSE(RawProtocol::describes(parse_report_descriptor(test::space_navigator())));
}

}  // namespace
}  // namespace limpid
