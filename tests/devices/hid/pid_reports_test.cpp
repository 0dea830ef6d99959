// The reports to PID devices whose descriptors differ in sizes, units and ranges.
#include "devices/hid/pid_reports.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "devices/hid/hid_transport.h"
#include "devices/hid/report_descriptor.h"
#include "tests/support/hid_descriptors.h"

namespace limpid {
namespace {

namespace parts = test::pid_joystick;
using test::Bytes;
using test::operator+;
using testing::HasSubstr;

// `text` with its only occurrence of `old` replaced by `news`.
Bytes with(const Bytes& text, const Bytes& old, const Bytes& news) {
  const auto at = std::search(text.begin(), text.end(), old.begin(), old.end());
  EXPECT_NE(at, text.end());
  const Bytes before(text.begin(), at),
      after(at + static_cast<std::ptrdiff_t>(old.size()), text.end());
  return before + news + after;
}

Bytes joystick_with(const Bytes& effect, const Bytes& force) {
  return parts::input() + effect + force + parts::effect_operation() +
         parts::block_free_control_gain() + parts::create_new_effect() + parts::block_load() +
         parts::kEnd;
}
PidReports with_effect(const Bytes& old, const Bytes& news) {
  return PidReports(parse_report_descriptor(
      joystick_with(with(parts::set_effect(), old, news), parts::set_constant_force())));
}
PidReports with_force(const Bytes& old, const Bytes& news) {
  return PidReports(parse_report_descriptor(
      joystick_with(parts::set_effect(), with(parts::set_constant_force(), old, news))));
}

// The duration in bytes 3 and 4 of a report.
int duration(const PidReports& reports, double seconds) {
  const Report report = reports.set_effect(1, 0, seconds);
  return report[3] + 256 * report[4];
}

const Bytes kMilliseconds{0x66, 0x03, 0x10, 0x55, 0xFD};

TEST(PidDuration, IsInTheUnitsOfTheDevice) {
  const auto count = [](const Bytes& unit) {
    return duration(with_effect(kMilliseconds, unit), 0.02);
  };
  EXPECT_EQ(count(kMilliseconds), 20);
  EXPECT_EQ(count({0x66, 0x03, 0x10, 0x55, 0xFC}), 200);  // 1e-4 s
  EXPECT_EQ(count({0x66, 0x01, 0x10, 0x55, 0xFE}), 2);    // hundredths, SI
  EXPECT_EQ(count({0x65, 0x00, 0x55, 0x00}), 20);         // no unit: milliseconds
}

// The smallest number above 0, which means "for ever".
TEST(PidDuration, IsNeverForEver) {
  EXPECT_EQ(duration(with_effect(kMilliseconds, kMilliseconds), 6e-4), 1);
  EXPECT_EQ(duration(with_effect(kMilliseconds, {0x66, 0x03, 0x10, 0x55, 0xFE}), 0.006), 1);
}

// A force that nobody renews would last that long.
TEST(PidDuration, ThatADeviceCannotHaveShortEnoughIsRefused) {
  const Bytes seconds{0x66, 0x03, 0x10, 0x55, 0x00}, tenths{0x66, 0x03, 0x10, 0x55, 0xFF},
      hundredths{0x66, 0x03, 0x10, 0x55, 0xFE};
  for (const auto& [unit, asked] : {std::pair(seconds, 0.01),
                                    {seconds, 0.1},
                                    {tenths, 0.01},
                                    {tenths, 0.04},
                                    {hundredths, 0.004}}) {
    EXPECT_THROW(duration(with_effect(kMilliseconds, unit), asked), HidError) << asked;
  }
  EXPECT_EQ(duration(with_effect(kMilliseconds, tenths), 0.1), 1);
}

// Logical 0..127 for physical 0..32767 ms, as from a device that counts 258 ms at a time.
TEST(PidDuration, FollowsThePhysicalRange) {
  const Bytes plain{0x15, 0x00, 0x26, 0xFF, 0x7F, 0x35, 0x00, 0x46, 0xFF, 0x7F, 0x66, 0x03, 0x10};
  const Bytes coarse{0x15, 0x00, 0x26, 0xFF, 0x00, 0x35, 0x00, 0x46, 0xFE, 0x01, 0x66, 0x03, 0x10};
  EXPECT_EQ(duration(with_effect(plain, coarse), 0.02), 10);  // 255 of 2 ms
}

const Bytes kMagnitude{0x16, 0x01, 0xFF, 0x26, 0xFF, 0x00};  // -255..255

TEST(PidMagnitude, FillsTheRangeOfTheDevice) {
  const PidReports fine = with_force(kMagnitude, {0x16, 0xF0, 0xD8, 0x26, 0x10, 0x27});
  EXPECT_EQ(fine.force_level(1, 1), 10000);
  EXPECT_EQ(fine.force_level(1, -1), -10000);
  EXPECT_EQ(fine.force_level(1, 0.5), 5000);
  EXPECT_EQ(fine.force_level(0, 0.5), -5000) << "from the right";
  EXPECT_EQ(fine.force_level(1, 7), 10000);
  EXPECT_EQ(fine.force_level(1, 0), 0);
}

// The force is the same in both directions even with a lopsided range: the loop relies on it.
TEST(PidMagnitude, IsTheSameBothWays) {
  const PidReports more = with_force(kMagnitude, {0x16, 0x38, 0xFF, 0x26, 0x64, 0x00});
  EXPECT_EQ(more.force_level(1, 1), 100);  // in a range of -200..100
  EXPECT_EQ(more.force_level(1, -1), -100);
  const PidReports less = with_force(kMagnitude, {0x15, 0x9C, 0x26, 0xC8, 0x00});
  EXPECT_EQ(less.force_level(1, 1), 100);  // in a range of -100..200
  EXPECT_EQ(less.force_level(1, -1), -100);
  // 16 bits hold one number more below zero than above.
  const PidReports whole = with_force(kMagnitude, {0x16, 0x00, 0x80, 0x26, 0xFF, 0x7F});
  EXPECT_EQ(whole.force_level(1, -1), -32767);
}

TEST(PidMagnitude, OfOneSignIsRefused) {
  for (const Bytes& one_sign :
       {Bytes{0x15, 0x00, 0x26, 0xFF, 0x00}, Bytes{0x15, 0x81, 0x25, 0x00}}) {
    EXPECT_THROW(with_force(kMagnitude, one_sign), HidError);
  }
}

// Direction Enable, 5 bits of padding and the two directions: bytes 9, 10 and 11.
Bytes tail(const Report& effect) { return {effect.begin() + 9, effect.end()}; }

const Bytes kDirections{0x15, 0x00, 0x26, 0xFF, 0x00, 0x35, 0x00, 0x47,
                        0xA0, 0x8C, 0x00, 0x00, 0x75, 0x08, 0x95, 0x02};

// X from 90 degrees, Y from 0; no axis is enabled beside it.
TEST(PidDirection, IsAnAngleInTheRangeOfTheDevice) {
  struct Case {
    Bytes range;
    Bytes x;
    const char* what;
  };
  const Case cases[] = {
      {kDirections, {4, 64, 64}, "255 steps"},
      {{0x15, 0x00, 0x26, 0xB4, 0x00, 0x35, 0x00, 0x47, 0xA0, 0x8C, 0x00, 0x00, 0x75, 0x08, 0x95,
        0x02},
       {4, 45, 45},
       "180 steps"},
      {{0x15, 0x00, 0x26, 0xB3, 0x00, 0x35, 0x00, 0x47, 0xD8, 0x8B, 0x00, 0x00, 0x75, 0x08, 0x95,
        0x02},
       {4, 45, 45},
       "0 to 179 for 0 to 358 degrees"},
      {{0x15, 0x00, 0x27, 0xA0, 0x8C, 0x00, 0x00, 0x35, 0x00, 0x47, 0xA0, 0x8C, 0x00, 0x00, 0x75,
        0x10, 0x95, 0x02},
       {4, 0x28, 0x23, 0x28, 0x23},
       "36000 steps in 16 bits"},
      {{0x15, 0x00, 0x27, 0xA0, 0x8C, 0x00, 0x00, 0x35, 0x00, 0x47, 0xA0, 0x8C, 0x00, 0x00, 0x75,
        0x10, 0x95, 0x01},
       {4, 0x28, 0x23},
       "one direction for both"},
      {{0x15, 0x00, 0x26, 0xFF, 0x00, 0x35, 0x00, 0x45, 0x00, 0x75, 0x08, 0x95, 0x02},
       {4, 64, 64},
       "no physical range"},
      {{0x15, 0x00, 0x26, 0xFF, 0x7F, 0x35, 0x00, 0x46, 0x10, 0x27, 0x75, 0x10, 0x95, 0x02},
       {4, 0x00, 0x20, 0x00, 0x20},
       "a physical range that is not of degrees"},
      {{0x15, 0x81, 0x25, 0x7F, 0x37, 0xB0, 0xB9, 0xFF, 0xFF, 0x47, 0x50, 0x46, 0x00, 0x00, 0x75,
        0x08, 0x95, 0x02},
       {4, 64, 64},
       "-127 to 127 for -180 to 180 degrees"},
  };
  for (const Case& one : cases) {
    const PidReports reports = with_effect(kDirections, one.range);
    EXPECT_EQ(tail(reports.set_effect(1, 0, 0.01)), one.x) << one.what;
    const Report y = reports.set_effect(1, 1, 0.01);
    EXPECT_EQ(y[9], 4) << one.what;
    EXPECT_TRUE(std::all_of(y.begin() + 10, y.end(), [](int byte) { return byte == 0; }))
        << one.what;
  }
}

// In -360 to 0 degrees, from the right is a quarter of the way, from the far side the end.
TEST(PidDirection, IsAnAngleInARangeThatIsNegative) {
  const PidReports reports =
      with_effect(kDirections, {0x15, 0x00, 0x26, 0xFF, 0x00, 0x37, 0x60, 0x73, 0xFF, 0xFF, 0x45,
                                0x00, 0x75, 0x08, 0x95, 0x02});
  EXPECT_EQ(tail(reports.set_effect(1, 0, 0.01)), (Bytes{4, 64, 64}));
  EXPECT_EQ(tail(reports.set_effect(1, 1, 0.01)), (Bytes{4, 255, 255}));
}

// The second of three directions may be a third axis'.
TEST(PidDirection, IsOnlyTheFirstOfThree) {
  Bytes three = kDirections;
  three.back() = 3;
  EXPECT_EQ(tail(with_effect(kDirections, three).set_effect(1, 0, 0.01)), (Bytes{4, 64, 0, 0}));
}

const Bytes kEnableX{0x09, 0x55, 0xA1, 0x02, 0x05, 0x01, 0x09, 0x30, 0x09, 0x31};
const Bytes kEnableDirection{0x05, 0x0F, 0x09, 0x56, 0x95, 0x01, 0x91, 0x02};

TEST(PidDirection, IsAnAxisBitWhereItCannotBeEnabled) {
  Bytes nothing = kEnableDirection;
  nothing[3] = 0x5A;
  const PidReports reports = with_effect(kEnableDirection, nothing);
  EXPECT_EQ(tail(reports.set_effect(1, 0, 0.01)), (Bytes{1, 0, 0}));
  EXPECT_EQ(tail(reports.set_effect(1, 1, 0.01)), (Bytes{2, 0, 0}));
  EXPECT_EQ(reports.force_level(0, 1), 255) << "along the axis";
}

TEST(PidDirection, IsAnAxisBitWhereThereIsNoAngle) {
  const Bytes direction{0x09, 0x57, 0xA1, 0x02};
  const PidReports reports = with_effect(direction, {0x09, 0x5A, 0xA1, 0x02});
  EXPECT_EQ(tail(reports.set_effect(1, 0, 0.01)), (Bytes{1, 0, 0}));
}

// A wheel: only X can be enabled, but the report has a place for an angle.
TEST(PidDirection, GoesOnlyAlongAxesThatCanBePushed) {
  Bytes wheel = kEnableX;
  wheel.back() = 0x36;
  const PidReports reports = with_effect(kEnableX, wheel);
  EXPECT_TRUE(reports.drives(0));
  EXPECT_FALSE(reports.drives(1));
  EXPECT_EQ(tail(reports.set_effect(1, 0, 0.01)), (Bytes{4, 64, 64}));
}

// No axis can be enabled: the angle alone gives the direction.
TEST(PidDirection, NeedsNoAxisBits) {
  Bytes no_axes = kEnableX;
  no_axes[1] = 0x5A;  // any other collection
  const PidReports reports = with_effect(kEnableX, no_axes);
  EXPECT_TRUE(reports.drives(0));
  EXPECT_TRUE(reports.drives(1));
  EXPECT_EQ(tail(reports.set_effect(1, 0, 0.01)), (Bytes{4, 64, 64}));
  EXPECT_EQ(reports.force_level(0, 1), -255);
}

// Device control of OpenFFBoard: a bit for each command, and three bits for the last usage.
TEST(PidDeviceControl, IsABitWhereEachCommandHasOne) {
  const Bytes array{0x15, 0x01, 0x25, 0x06, 0x75, 0x08, 0x95, 0x01, 0x91, 0x00};
  const Bytes bits{0x15, 0x01, 0x25, 0x06, 0x75, 0x01, 0x95, 0x08, 0x91, 0x02};
  const PidReports reports(parse_report_descriptor(
      parts::input() + parts::set_effect() + parts::set_constant_force() +
      parts::effect_operation() + with(parts::block_free_control_gain(), array, bits) +
      parts::create_new_effect() + parts::block_load() + parts::kEnd));
  int bit = 1;
  for (const int usage : {0x97, 0x98, 0x99, 0x9A, 0x9B, 0x9C}) {
    EXPECT_EQ(reports.device_control(make_usage(0x0F, static_cast<std::uint16_t>(usage))),
              (Report{12, static_cast<std::uint8_t>(bit)}));
    bit *= 2;
  }
}

}  // namespace
}  // namespace limpid
