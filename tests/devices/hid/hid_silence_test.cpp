#include <gtest/gtest.h>

#include "devices/hid/hid_exchange.h"
#include "devices/hid/pid_joystick.h"
#include "tests/support/fake_hid.h"
#include "tests/support/hid_descriptors.h"

namespace limpid {
namespace {

using std::chrono::milliseconds;

// A PID joystick that sends nothing while nothing moves.
struct SilentJoystick : testing::Test {
  SilentJoystick() {
    device->features[6] = {6, 1, 1, 0, 0};
    protocol.open(transport);
    exchange = std::make_unique<HidExchange>(transport, protocol, [this] { return now; });
    device->send(kAtRest);
  }
  // Whether the device is pushed in the last of so many turns of 1 ms.
  bool pushed_after(int turns) {
    for (int i = 0; i < turns; ++i) {
      now += milliseconds(1);
      DeviceReading newest;
      exchange->read(newest);
      exchange->write(std::vector<double>{0.5, 0});
      exchange->step();
    }
    const auto received = device->received();
    for (auto report = received.rbegin(); report != received.rend(); ++report) {
      if ((*report)[0] == 5 && (*report)[1] == 1) return (*report)[2] != 0 || (*report)[3] != 0;
    }
    return false;
  }

  const Report kAtRest{1, 0x10, 0x00, 0x20, 0x00, 0x00};
  std::shared_ptr<test::FakeHid> device = std::make_shared<test::FakeHid>();
  test::FakeTransport transport{device};
  PidJoystick protocol{parse_report_descriptor(test::pid_joystick::whole())};
  std::unique_ptr<HidExchange> exchange;
  nanoseconds now = std::chrono::hours(1);
};

TEST_F(SilentJoystick, IsAskedWhetherItIsStillThere) {
  device->inputs[1] = kAtRest;
  EXPECT_TRUE(pushed_after(1000));
  EXPECT_GE(device->questions, 1000 / 3);
  EXPECT_LE(device->questions, 1000 / 2);
  DeviceReading newest;
  exchange->read(newest);
  EXPECT_LE(newest.age, 0.003);
}

TEST_F(SilentJoystick, IsNotPushedIfItDoesNotAnswer) {
  EXPECT_TRUE(pushed_after(5));
  EXPECT_FALSE(pushed_after(2));
  EXPECT_FALSE(pushed_after(100));
  device->send(kAtRest);
  EXPECT_TRUE(pushed_after(1));
}

TEST_F(SilentJoystick, IsNotPushedIfItsAnswersCannotBeUsed) {
  device->inputs[1] = Report{1, 0x10};
  EXPECT_TRUE(pushed_after(5));
  EXPECT_FALSE(pushed_after(2));
}

TEST_F(SilentJoystick, IsBelievedWhatItAnswers) {
  device->inputs[1] = Report{1, 0xFF, 0x01, 0, 0, 0};
  pushed_after(20);
  DeviceReading newest;
  exchange->read(newest);
  EXPECT_DOUBLE_EQ(newest.x[0], PidSettings{}.range);
}

}  // namespace
}  // namespace limpid
