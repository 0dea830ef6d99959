#include "devices/hid/space_mouse.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "devices/hid/hid_transport.h"
#include "tests/support/hid_descriptors.h"

namespace limpid {
namespace {

SpaceMouse make(const test::Bytes& descriptor) {
  return SpaceMouse(parse_report_descriptor(descriptor));
}

// Reports recorded from the device: 175 = 0x00AF, -350 = 0xFEA2.
TEST(SpaceMouse, ReadsTheSplitReportsOfASpaceNavigator) {
  SpaceMouse mouse = make(test::space_navigator());
  DeviceReading reading;
  EXPECT_EQ(mouse.decode(Report{1, 0xAF, 0x00, 0xA2, 0xFE, 0, 0}, reading), Decoded::reading);
  EXPECT_EQ(mouse.decode(Report{2, 0, 0, 0x5E, 0x01, 0x51, 0xFF}, reading), Decoded::reading);
  const std::array<double, 6> wanted{0.5, -1, 0, 0, 1, -0.5};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_DOUBLE_EQ(reading.x[i], wanted[i]) << i;
  ButtonPresses presses;
  EXPECT_EQ(presses.take(reading), 0u);
  EXPECT_EQ(mouse.decode(Report{3, 2, 0}, reading), Decoded::status);
  EXPECT_EQ(reading.buttons, 2u);
  EXPECT_EQ(presses.take(reading), 2u) << "the first press counts";
}

TEST(SpaceMouse, ReadsTheJoinedReport) {
  const Report joined{1, 0xAF, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x51, 0xFF};
  for (const auto& descriptor : {test::joined_space_mouse(), test::space_navigator()}) {
    SpaceMouse mouse = make(descriptor);
    DeviceReading reading;
    EXPECT_EQ(mouse.decode(joined, reading), Decoded::reading);
    EXPECT_DOUBLE_EQ(reading.x[0], 0.5);
    EXPECT_DOUBLE_EQ(reading.x[5], -0.5);
  }
}

TEST(SpaceMouse, StaysWithinItsRangeWhenPushedHarder) {
  SpaceMouse mouse = make(test::space_navigator());
  DeviceReading reading;
  mouse.decode(Report{1, 0xFF, 0x7F, 0x00, 0x80, 0, 0}, reading);
  EXPECT_EQ(reading.x[0], 1);
  EXPECT_EQ(reading.x[1], -1);
}

TEST(SpaceMouse, TakesNothingFromOtherReports) {
  SpaceMouse mouse = make(test::space_navigator());
  DeviceReading reading;
  EXPECT_EQ(mouse.decode(Report{}, reading), Decoded::unusable);
  EXPECT_EQ(mouse.decode(Report{1}, reading), Decoded::unusable);
  EXPECT_EQ(mouse.decode(Report{23, 1, 2, 3, 4, 5, 6}, reading), Decoded::unusable);
  EXPECT_EQ(reading.buttons, 0u);
  EXPECT_EQ(reading.x[0], 0);
}

TEST(SpaceMouse, HasSixAxesAndNoMotors) {
  const SpaceMouse mouse = make(test::space_navigator());
  EXPECT_EQ(mouse.traits().dof, 6);
  EXPECT_FALSE(mouse.traits().pushes);
  EXPECT_TRUE(mouse.traits().effort.empty());
  EXPECT_TRUE(mouse.stop_reports().empty());
  EXPECT_DOUBLE_EQ(mouse.traits().resolution.at(5), 1.0 / 350);
}

TEST(SpaceMouse, MissesAnAxis) {
  const auto descriptor = parse_report_descriptor(test::pid_joystick::whole());
  EXPECT_FALSE(SpaceMouse::describes(descriptor));
  EXPECT_THROW(SpaceMouse{descriptor}, HidError);
  EXPECT_TRUE(SpaceMouse::describes(parse_report_descriptor(test::space_navigator())));
}

// In a range of -300 to 350, full deflection to the nearer end counts as full to the other as well.
TEST(SpaceMouse, TakesTheNearerEndOfItsRangeForFull) {
  for (const bool low_is_nearer : {true, false}) {
    test::Bytes descriptor = test::space_navigator();
    const test::Bytes range = {0x16, 0xA2, 0xFE, 0x26, 0x5E};
    auto at = std::search(descriptor.begin(), descriptor.end(), range.begin(), range.end());
    ASSERT_NE(at, descriptor.end());
    if (low_is_nearer) {
      at[1] = 0xD4, at[2] = 0xFE;  // -300
    } else {
      at[4] = 0x2C, at[5] = 0x01;  // 300
    }
    SpaceMouse mouse = make(descriptor);
    DeviceReading reading;
    // 150, -150 and 300 to one side; then -300 and -350.
    EXPECT_EQ(mouse.decode(Report{1, 0x96, 0x00, 0x6A, 0xFF, 0x2C, 0x01}, reading),
              Decoded::reading);
    EXPECT_DOUBLE_EQ(reading.x[0], 0.5);
    EXPECT_DOUBLE_EQ(reading.x[1], -0.5);
    EXPECT_DOUBLE_EQ(reading.x[2], 1);
    EXPECT_EQ(mouse.decode(Report{1, 0xD4, 0xFE, 0xA2, 0xFE, 0, 0}, reading), Decoded::reading);
    EXPECT_DOUBLE_EQ(reading.x[0], -1);
    EXPECT_DOUBLE_EQ(reading.x[1], -1);
  }
}

}  // namespace
}  // namespace limpid
