// The check of a device's axes as a thread of its own drives it.
#include "app/device/axis_check_run.h"

#include <gtest/gtest.h>

#include <chrono>

#include "tests/support/fake_device.h"

namespace limpid {
namespace {

TEST(AxisCheckRun, EndsAtAnOldReadingAndStopsTheDevice) {
  test::FakeDevice device(2);
  device.reading.age = 0.006;
  AxisCheckTalk talk;
  talk.window_seen = std::chrono::steady_clock::now() + std::chrono::hours(1);
  const AxisCheck check = run_axis_check(device, talk, {});
  EXPECT_EQ(check.finding(0).verdict, AxisVerdict::interrupted);
  EXPECT_TRUE(device.stopped);
}

}  // namespace
}  // namespace limpid
