#include <gtest/gtest.h>

#include "devices/device.h"

namespace limpid {
namespace {

// A reading whose report told of the buttons in `known`.
DeviceReading told(std::uint32_t pressed, std::uint32_t known = ~0u) {
  DeviceReading reading;
  reading.buttons = pressed;
  reading.buttons_known = known;
  return reading;
}

TEST(ButtonPresses, CountOnlyAfterTheButtonWasSeenUp) {
  ButtonPresses presses;
  EXPECT_EQ(presses.take(told(0b110)), 0u) << "held while it was plugged in";
  EXPECT_EQ(presses.take(told(0b110)), 0u);
  EXPECT_EQ(presses.take(told(0b011)), 1u) << "the first was up";
  EXPECT_EQ(presses.take(told(0b011)), 0u) << "once a press";
  EXPECT_EQ(presses.take(told(0)), 0u);
  EXPECT_EQ(presses.take(told(0b100)), 0b100u);
  presses.forget();
  EXPECT_EQ(presses.take(told(0b111)), 0u) << "plugged in again";
}

TEST(ButtonPresses, CountNoneThatNoReportHasToldOf) {
  ButtonPresses presses;
  EXPECT_EQ(presses.take({}), 0u) << "before the first report";
  EXPECT_EQ(presses.take(told(0b10)), 0u) << "held since before the first report";
  EXPECT_EQ(presses.take(told(0)), 0u);
  EXPECT_EQ(presses.take(told(0b10)), 0b10u);
  EXPECT_EQ(presses.take(told(0)), 0u);
  EXPECT_EQ(presses.take(told(0, 0b01)), 0u) << "the second is out of sight";
  EXPECT_EQ(presses.take(told(0b11)), 0b01u) << "the second may have been down all along";
}

}  // namespace
}  // namespace limpid
