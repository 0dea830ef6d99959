#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "devices/device.h"

namespace limpid {
namespace {

using testing::HasSubstr;

TEST(DeviceWords, AreNoneWhereTheDeviceIsWell) { EXPECT_EQ(device_words({}), ""); }

TEST(DeviceWords, SayWhatADeviceSaysOfItself) {
  DeviceReading reading;
  reading.calibrated = false;
  reading.warmth = 0.8f;
  reading.no_force = NoForce::button;
  const std::string words = device_words(reading);
  EXPECT_THAT(words, HasSubstr("not calibrated"));
  EXPECT_THAT(words, HasSubstr("a button on the device"));
  EXPECT_THAT(words, HasSubstr("80 %"));
}

TEST(DeviceWords, HaveOneForEachReason) {
  std::string before;
  for (int i = 1; i < kNoForces; ++i) {
    DeviceReading reading;
    reading.no_force = static_cast<NoForce>(i);
    EXPECT_THAT(device_words(reading), HasSubstr("gives no force: "));
    EXPECT_NE(device_words(reading), before);
    before = device_words(reading);
  }
}

}  // namespace
}  // namespace limpid
