#include "devices/hid/pid_joystick.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "devices/hid/hid_transport.h"
#include "tests/support/fake_hid.h"
#include "tests/support/hid_descriptors.h"

namespace limpid {
namespace {

namespace parts = test::pid_joystick;
using std::chrono::milliseconds;
using test::Bytes;
using test::operator+;
using testing::ElementsAre;
using testing::HasSubstr;

ReportDescriptor whole_descriptor() { return parse_report_descriptor(parts::whole()); }

// The first effect is block 1, the next one block 2.
class PidDevice final : public HidTransport {
 public:
  int read(std::span<std::uint8_t>, int) noexcept override { return 0; }
  bool write(std::span<const std::uint8_t> report) noexcept override {
    received.emplace_back(report.begin(), report.end());
    return true;
  }
  bool set_feature(std::span<const std::uint8_t> report) noexcept override {
    created.emplace_back(report.begin(), report.end());
    return true;
  }
  int get_feature(std::span<std::uint8_t> report) noexcept override {
    if (report.size() != 5 || report[0] != 6) return -1;
    report[1] = static_cast<std::uint8_t>(first_block + created.size() - 1);
    report[2] = load_status;
    return 5;
  }
  void ask(std::span<const std::uint8_t>) noexcept override {}
  const std::vector<std::uint8_t>& report_descriptor() const override { return descriptor_; }

  std::vector<Report> received, created;
  std::uint8_t load_status = 1;
  std::size_t first_block = 1;

 private:
  std::vector<std::uint8_t> descriptor_;
};

struct OpenPidJoystick : testing::Test {
  OpenPidJoystick() { joystick.open(device); }
  std::vector<Report> encode(const std::vector<double>& torque, nanoseconds now) {
    std::vector<Report> sent;
    joystick.encode(torque, now,
                    [&](auto report) { sent.emplace_back(report.begin(), report.end()); });
    return sent;
  }
  PidDevice device;
  PidJoystick joystick{whole_descriptor()};
  DeviceReading reading;
};

// Reports as in the PID specification, laid out by this descriptor.
const Report kReset{12, 4}, kStopAll{12, 3}, kEnable{12, 1}, kDisable{12, 2}, kContinue{12, 6},
    kGain{13, 255};
const Report kForce1Zero{5, 1, 0, 0}, kForce2Zero{5, 2, 0, 0};
const Report kStart1{10, 1, 1, 1}, kStart2{10, 2, 1, 1}, kStop1{10, 1, 3, 0}, kStop2{10, 2, 3, 0};
// Constant force is the third type here; 10 ms; full gain; with a direction and no axis enabled,
// from the right (a quarter of 256 steps) and from the far side.
const Report kEffect1{1, 1, 3, 10, 0, 0, 0, 255, 0, 4, 64, 64};
const Report kEffect2{1, 2, 3, 10, 0, 0, 0, 255, 0, 4, 0, 0};

TEST_F(OpenPidJoystick, MakesItsEffectsBeforeItsMotorsAreOn) {
  EXPECT_THAT(device.created, ElementsAre(Report{5, 3, 0, 0}, Report{5, 3, 0, 0}));
  EXPECT_THAT(device.received, ElementsAre(kReset, kStopAll, kGain, kEffect1, kForce1Zero, kEffect2,
                                           kForce2Zero, kContinue, kEnable));
}

TEST_F(OpenPidJoystick, KnowsItsRange) {
  const DeviceTraits& traits = joystick.traits();
  EXPECT_EQ(traits.dof, 2);
  EXPECT_TRUE(traits.pushes);
  EXPECT_NEAR(traits.upper.at(0), 20 * M_PI / 180, 1e-4);
  EXPECT_NEAR(traits.lower.at(1), -20 * M_PI / 180, 1e-4);
  EXPECT_NEAR(traits.resolution.at(0), 40 * M_PI / 180 / 1023, 1e-6);
  EXPECT_EQ(traits.effort, (std::vector<double>{0.5, 0.5}));
}

TEST_F(OpenPidJoystick, ReadsItsAxes) {
  // X = -512 = 0x200 in 10 bits, Y = 511 = 0x1FF; button 3.
  ASSERT_EQ(joystick.decode(Report{1, 0x00, 0x02, 0xFF, 0x01, 0x04}, reading), Decoded::reading);
  EXPECT_DOUBLE_EQ(reading.x[0], -PidSettings{}.range);
  EXPECT_DOUBLE_EQ(reading.x[1], PidSettings{}.range);
  EXPECT_EQ(reading.buttons, 4u);
  EXPECT_EQ(reading.buttons_known & 7u, 7u);
  joystick.decode(Report{1, 0x00, 0x00, 0x00, 0x00, 0x00}, reading);
  EXPECT_NEAR(reading.x[0], 0, 0.001);
}

// The joystick's 10-bit numbers go from -256 to 255 here; others mean "unknown".
TEST(PidJoystick, UsesNoNumberOutsideOfItsRange) {
  Bytes narrow = parts::whole();
  const Bytes range{0x16, 0x00, 0xFE, 0x26, 0xFF, 0x01};
  const auto at = std::search(narrow.begin(), narrow.end(), range.begin(), range.end());
  ASSERT_NE(at, narrow.end());
  at[2] = 0xFF;
  at[5] = 0x00;
  PidJoystick joystick(parse_report_descriptor(narrow));
  DeviceReading reading;
  EXPECT_EQ(joystick.decode(Report{1, 0x80, 0, 0x80, 0, 1}, reading), Decoded::reading);
  const DeviceReading before = reading;
  EXPECT_EQ(joystick.decode(Report{1, 0x00, 0x01, 0x80, 0, 2}, reading), Decoded::unusable);
  EXPECT_EQ(joystick.decode(Report{1, 0x80, 0, 0xFF, 0x02, 2}, reading), Decoded::unusable);
  EXPECT_EQ(reading.x, before.x);
  EXPECT_EQ(reading.buttons, 1u);
}

constexpr std::uint8_t kPaused = 1, kActuators = 2, kSafe = 4, kPower = 16;
constexpr std::uint8_t kWell = kActuators | kSafe | kPower;

TEST_F(OpenPidJoystick, HearsOfItsSafetySwitchAndItsPower) {
  EXPECT_EQ(joystick.decode(Report{2, kWell, 0}, reading), Decoded::status);
  EXPECT_TRUE(reading.hand);
  EXPECT_FALSE(reading.fault);
  for (const int ill : {kWell & ~kPower, kWell & ~kActuators, kWell | kPaused}) {
    joystick.decode(Report{2, static_cast<std::uint8_t>(ill), 0}, reading);
    EXPECT_TRUE(reading.fault) << ill;
    EXPECT_TRUE(reading.hand) << ill;
    joystick.decode(Report{2, kWell, 0}, reading);
    EXPECT_FALSE(reading.fault) << ill;
  }
  joystick.decode(Report{2, kWell & ~kSafe, 0}, reading);
  EXPECT_FALSE(reading.hand);
  EXPECT_FALSE(reading.fault);
  joystick.decode(Report{2, kWell, 0}, reading);
  EXPECT_TRUE(reading.hand);
}

// OpenFFBoard reports a pause when it makes an effect, and never closes its safety switch.
TEST_F(OpenPidJoystick, TakesABitThatNeverSaidThatAllIsWellForNothing) {
  for (const int state : {+kPaused, kPaused | kPower, 0}) {
    joystick.decode(Report{2, static_cast<std::uint8_t>(state), 0}, reading);
    EXPECT_TRUE(reading.hand) << state;
  }
  EXPECT_TRUE(reading.fault) << "the power was on and went";
  joystick.decode(Report{2, kPower, 0}, reading);
  EXPECT_FALSE(reading.fault);
  joystick.decode(Report{2, kPower | kPaused, 0}, reading);
  EXPECT_TRUE(reading.fault) << "it was not paused and is now";
}

TEST_F(OpenPidJoystick, ForgetsItsBitsWithTheConnection) {
  joystick.decode(Report{2, kWell, 0}, reading);
  PidJoystick again(whole_descriptor());
  DeviceReading news;
  again.decode(Report{2, 0, 0}, news);
  EXPECT_TRUE(news.hand);
  EXPECT_FALSE(news.fault);
}

TEST_F(OpenPidJoystick, TakesNothingFromGarbage) {
  for (const Report& report : {Report{}, Report{1}, Report{9, 1, 2, 3, 4, 5, 6, 7, 8}}) {
    EXPECT_EQ(joystick.decode(report, reading), Decoded::unusable);
  }
}

// The force comes from the right: a positive one pushes to the left, so X needs the other sign.
TEST_F(OpenPidJoystick, PushesAlongItsAxes) {
  EXPECT_THAT(encode({0.5, -0.25}, milliseconds(1)),
              ElementsAre(Report{5, 1, 0x01, 0xFF}, Report{5, 2, 0x80, 0xFF}, kStart1, kStart2));
}

TEST_F(OpenPidJoystick, SendsOnlyWhatChanges) {
  encode({0.5, 0.25}, milliseconds(1));
  EXPECT_THAT(encode({0.5, 0.25}, milliseconds(2)), ElementsAre());
  EXPECT_THAT(encode({0.5, 0.5}, milliseconds(3)), ElementsAre(Report{5, 2, 255, 0}));
  EXPECT_THAT(encode({0, 0}, milliseconds(4)), ElementsAre(kForce1Zero, kForce2Zero));
  EXPECT_THAT(encode({0, 0}, milliseconds(100)), ElementsAre());
}

// An axis' zero got lost while the other axis pushes, whose effects start both anew.
TEST_F(OpenPidJoystick, SendsAForceThatGotLostAgain) {
  encode({0.5, 0.25}, milliseconds(0));
  EXPECT_THAT(encode({0, 0.25}, milliseconds(1)), ElementsAre(kForce1Zero));
  joystick.undelivered();
  EXPECT_THAT(encode({0, 0.25}, milliseconds(2)), ElementsAre(kForce1Zero, Report{5, 2, 0x80, 0}));
  EXPECT_THAT(encode({0, 0.25}, milliseconds(3)), ElementsAre());
}

// Otherwise the device would end the force; if the program dies, it does.
TEST_F(OpenPidJoystick, StartsItsEffectsAgainBeforeTheyEnd) {
  encode({0.5, 0}, milliseconds(0));
  EXPECT_THAT(encode({0.5, 0}, milliseconds(3)), ElementsAre());
  EXPECT_THAT(encode({0.5, 0}, milliseconds(4)),
              ElementsAre(Report{5, 1, 0x01, 0xFF}, kStart1, kStart2));
  EXPECT_THAT(encode({0.5, 0}, milliseconds(5)), ElementsAre());
}

TEST_F(OpenPidJoystick, NeverPushesHarderThanFull) {
  EXPECT_THAT(encode({-7, 7}, {}),
              ElementsAre(Report{5, 1, 255, 0}, Report{5, 2, 255, 0}, kStart1, kStart2));
}

TEST_F(OpenPidJoystick, StopsInEveryWayItKnows) {
  EXPECT_THAT(joystick.stop_reports(),
              ElementsAre(kForce1Zero, kForce2Zero, kStop1, kStop2, kStopAll, kDisable,
                          Report{11, 1}, Report{11, 2}));
}

TEST_F(OpenPidJoystick, StopReportsStayZeroAfterForces) {
  encode({0.5, 0.5}, {});
  EXPECT_EQ(joystick.stop_reports()[0], kForce1Zero);
}

TEST(PidJoystick, CanBeTurnedRound) {
  PidDevice device;
  PidJoystick joystick(whole_descriptor(), {.effort = 1, .reverse = {true, false}});
  joystick.open(device);
  Report first;
  joystick.encode(std::vector<double>{1.0, 0.0}, {}, [&](auto report) {
    if (first.empty()) first.assign(report.begin(), report.end());
  });
  EXPECT_EQ(first, (Report{5, 1, 255, 0}));
}

// The check finds and stores its results by joint.
TEST(PidJoystick, CanBeTurnedRoundWhereOnlyYCanBePushed) {
  const Bytes enable_x{0x09, 0x55, 0xA1, 0x02, 0x05, 0x01, 0x09, 0x30};
  Bytes descriptor = parts::whole();
  const auto at =
      std::search(descriptor.begin(), descriptor.end(), enable_x.begin(), enable_x.end());
  ASSERT_NE(at, descriptor.end());
  at[7] = 0x36;
  for (const bool reverse : {false, true}) {
    PidDevice device;
    PidJoystick joystick(parse_report_descriptor(descriptor),
                         {.effort = 1, .reverse = {reverse, false}});
    ASSERT_EQ(joystick.traits().dof, 1);
    joystick.open(device);
    Report first;
    joystick.encode(std::vector<double>{1.0}, {}, [&](auto report) {
      if (first.empty()) first.assign(report.begin(), report.end());
    });
    EXPECT_EQ(first, reverse ? (Report{5, 1, 0x01, 0xFF}) : (Report{5, 1, 255, 0}));
  }
}

std::string complaint_of_joystick(PidDevice& device) {
  try {
    PidJoystick joystick(whole_descriptor());
    joystick.open(device);
  } catch (const HidError& error) {
    return error.what();
  }
  return "none";
}

TEST(PidJoystick, SaysWhenThereIsNoRoomForAnEffect) {
  PidDevice device;
  device.load_status = 2;
  EXPECT_THAT(complaint_of_joystick(device), HasSubstr("no memory left"));
  EXPECT_THAT(device.received, testing::Not(testing::Contains(kEnable)));
}

TEST(PidJoystick, SaysWhenTheDeviceCannotMakeAnEffect) {
  PidDevice device;
  device.load_status = 3;
  EXPECT_THAT(complaint_of_joystick(device), HasSubstr("cannot make an effect"));
}

TEST(PidJoystick, SaysWhenTheDeviceDoesNotAnswer) {
  PidDevice device;
  device.load_status = 0;
  EXPECT_THAT(complaint_of_joystick(device), HasSubstr("does not report the index"));
}

// Blocks count from 1; 0 stands for no effect.
TEST(PidJoystick, TakesNoBlockZero) {
  PidDevice device;
  device.first_block = 0;
  EXPECT_THAT(complaint_of_joystick(device), HasSubstr("does not report the index"));
  EXPECT_THAT(device.received, testing::Not(testing::Contains(kEnable)));
}

TEST(PidJoystick, UsesTheBlocksThatItIsGiven) {
  PidDevice device;
  device.first_block = 39;
  PidJoystick joystick(whole_descriptor());
  joystick.open(device);
  EXPECT_THAT(device.received, testing::IsSupersetOf({Report{5, 39, 0, 0}, Report{5, 40, 0, 0}}));
  EXPECT_THAT(joystick.stop_reports(),
              testing::IsSupersetOf({Report{10, 39, 3, 0}, Report{10, 40, 3, 0}}));
}

TEST(PidJoystick, NamesWhatTheDeviceLacks) {
  const auto complaint = [](const Bytes& descriptor) -> std::string {
    try {
      PidJoystick joystick(parse_report_descriptor(descriptor));
    } catch (const HidError& error) {
      return error.what();
    }
    return "none";
  };
  const Bytes common = parts::input() + parts::set_effect() + parts::set_constant_force();
  const Bytes rest = parts::effect_operation() + parts::block_free_control_gain();
  const Bytes create = parts::create_new_effect() + parts::block_load() + parts::kEnd;
  EXPECT_EQ(complaint(common + rest + create), "none");
  EXPECT_THAT(complaint(common + rest + parts::block_load() + parts::kEnd),
              HasSubstr("no Create New Effect report"));
  EXPECT_THAT(complaint(common + parts::block_free_control_gain() + create),
              HasSubstr("Effect Operation"));
  EXPECT_THAT(complaint(common + parts::effect_operation() + create), HasSubstr("Stop All"));
  EXPECT_THAT(complaint(parts::input() + parts::set_effect() + rest + create),
              HasSubstr("Set Constant Force"));
}

// An adapter for pads with motors that shake has two axes, constant force, and a game pad.
TEST(PidJoystick, TakesAGamePadForNoArm) {
  Bytes pad = parts::whole();
  ASSERT_EQ(pad[3], 0x04);  // Joystick
  EXPECT_EQ(PidJoystick::objection(parse_report_descriptor(pad)), "");
  pad[3] = 0x05;
  const ReportDescriptor descriptor = parse_report_descriptor(pad);
  EXPECT_THAT(PidJoystick::objection(descriptor), HasSubstr("game pad"));
  EXPECT_THROW(PidJoystick{descriptor}, HidError);
}

TEST(PidJoystick, RefusesSettingsThatMakeNoSense) {
  const ReportDescriptor descriptor = whole_descriptor();
  EXPECT_THROW(PidJoystick(descriptor, {.range = 0}), HidError);
  EXPECT_THROW(PidJoystick(descriptor, {.effort = -1}), HidError);
  EXPECT_THROW(PidJoystick(descriptor, {.duration = 5}), HidError);
  EXPECT_THROW(PidJoystick(descriptor, {.duration = 0.01, .restart = 0.02}), HidError);
  EXPECT_THROW(PidJoystick(descriptor, {.range = std::nan("")}), HidError);
}

}  // namespace
}  // namespace limpid
