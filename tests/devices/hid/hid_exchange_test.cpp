#include "devices/hid/hid_exchange.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/fake_hid.h"
#include "tests/support/raw_reports.h"

namespace limpid {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using test::raw_reading;
using test::sealed;

// A raw device of two joints, a clock that the test advances, and no threads.
struct RawExchange : testing::Test {
  RawExchange() {
    device->features[0] = sealed(test::raw_feature(2));
    protocol.open(transport);
    exchange = std::make_unique<HidExchange>(transport, protocol, [this] { return now; });
  }

  void reading_arrives(std::vector<float> x = {0.1f, 0.2f}, std::uint8_t status = 7) {
    device->send(sealed(raw_reading(++sequence, x, status)));
  }
  // Makes a turn; returns the command that the device receives in it.
  test::RawCommand turn(nanoseconds later = milliseconds(1)) {
    now += later;
    device->forget_received();
    exchange->step();
    const auto received = device->received();
    return received.empty() ? test::RawCommand{.right = false} : test::raw_command(received.back());
  }
  // Acts as the haptic thread does.
  void tick() {
    exchange->read(newest);
    exchange->write(torque);
  }
  // Brings a force onto the device.
  void push() {
    reading_arrives();
    tick();
    ASSERT_EQ(turn().torque[0], 0.25f);
  }
  // A turn in good condition, apart from the test's changes.
  test::RawCommand healthy_turn() {
    reading_arrives();
    tick();
    return turn();
  }

  std::shared_ptr<test::FakeHid> device = std::make_shared<test::FakeHid>();
  test::FakeTransport transport{device};
  RawProtocol protocol;
  std::unique_ptr<HidExchange> exchange;
  nanoseconds now = std::chrono::hours(1);
  std::uint32_t sequence = 0;
  const std::vector<double> torque{0.25, -0.125};
  DeviceReading newest;
};

TEST_F(RawExchange, BringsReadingsInAndTorquesOut) {
  reading_arrives({0.5f, -0.25f});
  exchange->write(torque);
  const test::RawCommand command = turn();
  EXPECT_TRUE(command.right);
  EXPECT_EQ(command.mode, 1);
  EXPECT_EQ(command.torque[0], 0.25f);
  EXPECT_EQ(command.torque[1], -0.125f);
  now += microseconds(1500);
  EXPECT_TRUE(exchange->read(newest));
  EXPECT_EQ(newest.x[0], 0.5);
  EXPECT_EQ(newest.x[1], -0.25);
  EXPECT_EQ(newest.count, 1u);
  EXPECT_DOUBLE_EQ(newest.age, 0.0015);
}

TEST_F(RawExchange, HasNoReadingAtFirst) {
  EXPECT_TRUE(exchange->read(newest));
  EXPECT_EQ(newest.count, 0u);
  EXPECT_TRUE(std::isinf(newest.age));
}

TEST_F(RawExchange, TakesTheNewestOfWhatPiledUp) {
  for (const float x : {0.1f, 0.2f, 0.3f}) reading_arrives({x, 0});
  turn();
  exchange->read(newest);
  EXPECT_EQ(newest.x[0], static_cast<double>(0.3f));
  EXPECT_EQ(newest.count, 3u);
}

TEST_F(RawExchange, DoesNotPushBeforeTheFirstReadingOrTheFirstTick) {
  exchange->write(torque);
  EXPECT_FALSE(turn().pushes());
  now += milliseconds(20);
  reading_arrives();
  EXPECT_FALSE(turn().pushes());
}

TEST_F(RawExchange, HoldsATorqueForLessThanTenMilliseconds) {
  push();  // written at the start of a turn of 1 ms
  for (int i = 2; i <= 7; ++i) {
    reading_arrives();
    EXPECT_TRUE(turn().pushes()) << i;
  }
  for (int i = 9; i < 30; ++i) {
    reading_arrives();
    EXPECT_FALSE(turn().pushes()) << i;
  }
  EXPECT_TRUE(healthy_turn().pushes());
}

TEST_F(RawExchange, TakesTheForceAwayWhenReadingsStop) {
  push();
  for (int i = 0; i < 5; ++i) {
    exchange->write(torque);
    EXPECT_TRUE(turn().pushes()) << i;
  }
  exchange->write(torque);
  EXPECT_FALSE(turn().pushes());
  exchange->read(newest);
  EXPECT_GT(newest.age, 0.005);
  EXPECT_TRUE(healthy_turn().pushes());
}

TEST_F(RawExchange, TakesRepeatedReadingsForFrozenOnes) {
  push();
  for (int i = 0; i < 6; ++i) {
    device->send(sealed(raw_reading(sequence, {0.1f, 0.2f})));
    exchange->write(torque);
    turn();
  }
  device->send(sealed(raw_reading(sequence, {0.1f, 0.2f})));
  exchange->write(torque);
  EXPECT_FALSE(turn().pushes());
  EXPECT_EQ(exchange->unusable(), 7u);
}

TEST_F(RawExchange, TakesGarbageForNoReadings) {
  push();
  Report damaged = sealed(raw_reading(1000, {0.9f, 0.9f}));
  damaged[20] ^= 1;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Report> bad{damaged,
                                Report(65, 0xFF),
                                Report{},
                                Report{0},
                                Report(4000, 0x4C),
                                sealed(raw_reading(1000, {nan, 0})),
                                sealed(raw_reading(1000, {0.9f, 0.9f, 0.9f}))};
  for (const Report& report : bad) {
    device->send(report);
    exchange->write(torque);
    turn();
  }
  exchange->read(newest);
  EXPECT_EQ(newest.count, 1u);
  EXPECT_EQ(newest.x[0], static_cast<double>(0.1f));
  exchange->write(torque);
  EXPECT_FALSE(turn().pushes());
}

TEST_F(RawExchange, StopsAtOnce) {
  push();
  exchange->stop();
  reading_arrives();
  EXPECT_FALSE(turn(microseconds(100)).pushes());
  reading_arrives();
  EXPECT_FALSE(turn().pushes());
}

TEST_F(RawExchange, DoesNotPushWithoutAHandOrWithAFault) {
  for (const std::uint8_t status : {std::uint8_t{5}, std::uint8_t{3}, std::uint8_t{15}}) {
    push();
    reading_arrives({0, 0}, status);
    exchange->write(torque);
    EXPECT_FALSE(turn().pushes()) << int{status};
  }
  exchange->read(newest);
  EXPECT_TRUE(newest.fault);
}

TEST_F(RawExchange, LimitsTorques) {
  reading_arrives();
  exchange->write(std::vector<double>{100, -100});
  const test::RawCommand command = turn();
  EXPECT_EQ(command.torque[0], 0.4f);
  EXPECT_EQ(command.torque[1], -0.5f);
}

TEST_F(RawExchange, TakesNoNumberForZeroOnAllJoints) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    push();
    reading_arrives();
    exchange->read(newest);
    exchange->write(std::vector<double>{0.25, bad});
    EXPECT_FALSE(turn().pushes());
  }
}

TEST_F(RawExchange, TakesTooFewOrTooManyTorques) {
  reading_arrives();
  exchange->write(std::vector<double>(100, 0.25));
  EXPECT_EQ(turn().torque[2], 0);
  reading_arrives();
  exchange->write(std::vector<double>{0.25});
  EXPECT_EQ(turn().torque[1], 0);
}

TEST_F(RawExchange, SendsATorqueAtOnceAndRepeatsItEveryMillisecond) {
  push();
  EXPECT_FALSE(turn(microseconds(100)).right) << "nothing new, nothing due";
  exchange->write(torque);
  EXPECT_TRUE(turn(microseconds(100)).right);
  EXPECT_FALSE(turn(microseconds(999)).right);
  EXPECT_TRUE(turn(microseconds(1)).right);
}

TEST_F(RawExchange, SendsTorquesInAFloodOfReports) {
  for (int i = 0; i < 1000; ++i) reading_arrives();
  exchange->write(torque);
  EXPECT_TRUE(turn().pushes());
}

TEST_F(RawExchange, ReportsALostDevice) {
  push();
  device->unplug();
  EXPECT_FALSE(exchange->step());
  EXPECT_TRUE(exchange->lost());
  EXPECT_FALSE(exchange->read(newest));
  EXPECT_EQ(newest.count, 1u);
  exchange->write(torque);
  exchange->stop();
  EXPECT_FALSE(exchange->finish());
}

TEST_F(RawExchange, GivesUpADeviceThatTakesNoReports) {
  push();
  device->refuse_writes(true);
  for (int i = 0; i < 9; ++i) healthy_turn();
  EXPECT_FALSE(exchange->lost());
  device->refuse_writes(false);
  EXPECT_FALSE(healthy_turn().pushes()) << "it had dropped its force, which comes back slowly";
  EXPECT_TRUE(healthy_turn().pushes()) << "one that takes them again is well";
  device->refuse_writes(true);
  for (int i = 0; i < 9; ++i) healthy_turn();
  EXPECT_FALSE(exchange->lost()) << "failures before a success do not count";
  healthy_turn();
  EXPECT_TRUE(exchange->lost());
  // The final report may get through all the same.
  device->refuse_writes(false);
  EXPECT_TRUE(exchange->finish());
}

// The loop cannot correct a stall it does not know of: it would go on from its last torque.
TEST_F(RawExchange, GivesNoTorqueAfterAStallUntilTheLoopHasHeardOfIt) {
  for (const int stall : {9, 20, 100, 1000}) {
    push();
    exchange->read(newest);
    const std::uint32_t before = newest.lapses;
    for (int i = 0; i < stall; ++i) {
      reading_arrives();
      turn();
    }
    reading_arrives();
    exchange->write(torque);  // computed before the stall
    EXPECT_FALSE(turn().pushes()) << stall;
    exchange->read(newest);
    EXPECT_EQ(newest.lapses, before + 1) << stall;
    EXPECT_TRUE(healthy_turn().pushes()) << stall;
  }
}

TEST_F(RawExchange, GivesNoTorqueAfterItHasStoodStillItself) {
  for (const int stall : {6, 9, 20, 100, 1000}) {
    push();
    const std::uint32_t before = newest.lapses;
    now += milliseconds(stall - 1);
    EXPECT_FALSE(healthy_turn().pushes()) << stall;
    exchange->read(newest);
    EXPECT_EQ(newest.lapses, before + 1) << stall;
    EXPECT_TRUE(healthy_turn().pushes()) << stall;
  }
}

// The device's endpoint takes a report only every few milliseconds.
TEST_F(RawExchange, PushesADeviceThatTakesItsReportsSlowly) {
  push();
  device->while_writing = [this] { now += microseconds(4500); };
  const std::uint32_t before = newest.lapses;
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(healthy_turn().pushes()) << i;
  exchange->read(newest);
  EXPECT_EQ(newest.lapses, before);
}

// The whole program may be stopped during a write: the report that the device got is old then.
TEST_F(RawExchange, GivesNoTorqueAfterAWriteThatStoodStill) {
  for (const int stall : {6, 20, 1000}) {
    push();
    const std::uint32_t before = newest.lapses;
    device->while_writing = [this, stall] { now += milliseconds(stall); };
    healthy_turn();
    device->while_writing = [] {};
    EXPECT_FALSE(healthy_turn().pushes()) << stall;
    exchange->read(newest);
    EXPECT_EQ(newest.lapses, before + 1) << stall;
    EXPECT_TRUE(healthy_turn().pushes()) << stall;
  }
}

TEST_F(RawExchange, TellsTheLoopWheneverItKeptATorqueBack) {
  push();
  const std::uint32_t before = newest.lapses;
  reading_arrives({0, 0}, 5);  // the hand is gone, for less than a tick
  exchange->write(torque);
  EXPECT_FALSE(turn(microseconds(300)).pushes());
  reading_arrives();
  exchange->write(torque);
  EXPECT_FALSE(turn(microseconds(300)).pushes());
  exchange->read(newest);
  EXPECT_TRUE(newest.hand);
  EXPECT_EQ(newest.lapses, before + 1);
}

TEST_F(RawExchange, CountsNoLapseWhileThereIsNoTorqueToKeepBack) {
  const std::vector<double> none{0, 0};
  for (int i = 0; i < 50; ++i) {
    reading_arrives({0, 0}, 5);
    exchange->read(newest);
    exchange->write(none);
    turn(milliseconds(i % 20 + 1));
  }
  exchange->read(newest);
  EXPECT_EQ(newest.lapses, 0u);
}

TEST_F(RawExchange, EndsWithAStop) {
  push();
  device->forget_received();
  EXPECT_TRUE(exchange->finish());
  EXPECT_EQ(device->received(), protocol.stop_reports());
}

// A protocol of one joint without motors; reports are buttons, or a reading if there are none.
struct PlainProtocol final : HidProtocol {
  PlainProtocol() { traits_.dof = 1; }
  void open(HidTransport&) override {}
  const DeviceTraits& traits() const override { return traits_; }
  nanoseconds stale_after() const override { return nanoseconds::max(); }
  Decoded decode(std::span<const std::uint8_t> report, DeviceReading& reading) noexcept override {
    reading.buttons = report[0];
    return report[0] ? Decoded::status : Decoded::reading;
  }
  void encode(std::span<const double>, nanoseconds, const SendReport& send) noexcept override {
    send(Report{1});
  }
  const std::vector<Report>& stop_reports() const override { return none_; }
  DeviceTraits traits_;
  std::vector<Report> none_;
};

TEST(HidExchange, SendsNothingToADeviceWithoutMotors) {
  const auto device = std::make_shared<test::FakeHid>();
  test::FakeTransport transport(device);
  PlainProtocol protocol;
  HidExchange exchange(transport, protocol, [] { return nanoseconds(0); });
  exchange.write(std::vector<double>{1.0});
  EXPECT_TRUE(exchange.step());
  EXPECT_TRUE(device->received().empty());
}

TEST(HidExchange, PassesButtonsOnWithoutCountingThemAsReadings) {
  const auto device = std::make_shared<test::FakeHid>();
  test::FakeTransport transport(device);
  PlainProtocol protocol;
  HidExchange exchange(transport, protocol, [] { return nanoseconds(0); });
  device->send({5});
  exchange.step();
  DeviceReading newest;
  exchange.read(newest);
  EXPECT_EQ(newest.buttons, 5u);
  EXPECT_EQ(newest.count, 0u);
}

}  // namespace
}  // namespace limpid
