#include <gtest/gtest.h>

#include "devices/device.h"

namespace limpid {
namespace {

TEST(ButtonPresses, CountOnlyAfterTheButtonWasSeenUp) {
  ButtonPresses presses;
  EXPECT_EQ(presses.take(0b110), 0u) << "held while it was plugged in";
  EXPECT_EQ(presses.take(0b110), 0u);
  EXPECT_EQ(presses.take(0b011), 1u) << "the first was up";
  EXPECT_EQ(presses.take(0b011), 0u) << "once a press";
  EXPECT_EQ(presses.take(0), 0u);
  EXPECT_EQ(presses.take(0b100), 0b100u);
  presses.forget();
  EXPECT_EQ(presses.take(0b111), 0u) << "plugged in again";
}

}  // namespace
}  // namespace limpid
