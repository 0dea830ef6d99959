// The paddle that people can build: its firmware as it is flashed, in simulated time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "devices/files/urdf_file.h"
#include "devices/identify/excitation.h"
#include "devices/identify/fit.h"
#include "tests/support/built_in.h"
#include "tests/support/hid/paddle_model.h"
#include "tests/support/hid_descriptors.h"
#include "tests/vm/simulated_desk.h"

namespace limpid::test {
namespace {

using namespace std::chrono_literals;

// A command as the protocol's page describes it, made without the code that reads it.
Report command(std::uint8_t mode, std::uint32_t sequence, float torque) {
  Report report(64);
  report[0] = 0x4C;
  report[1] = 1;
  report[2] = 1;
  report[3] = mode;
  write_at(report, 4, sequence);
  write_at(report, 16, torque);
  write_at(report, 60, crc32_of(std::span(report).first(60)));
  return report;
}

struct OnTheDesk : testing::Test {
  OnTheDesk() {
    model.hand().axis(0).path = [](double) { return 0.1; };
    model.power(true, now);
    link = std::make_unique<SimulatedLink>(model, std::make_unique<RawProtocol>(), now);
  }
  // Commands `torque` for so many milliseconds; returns the motor's torque at the end [N m].
  double push(double torque, int milliseconds = 20) {
    for (int i = 0; i < milliseconds; ++i, now += 1ms) {
      link->transport.arrive(model.input(now));
      link->write(std::array{torque});
      link->exchange.step();
    }
    return model.forces().newest()[0];
  }
  // Lays the paddle at its end and begins a session.
  void begin() {
    model.lay_at_its_end();
    push(0, 5);
  }
  bool send(Report report) {
    model.input(now);
    const int before = model.rejected();
    report.insert(report.begin(), 0);
    model.output(report, now);
    return model.rejected() == before;
  }
  DeviceReading reading() {
    DeviceReading newest;
    EXPECT_TRUE(link->read(newest));
    return newest;
  }

  Time now = 1h;
  PaddleModel model;
  std::unique_ptr<SimulatedLink> link;
};

TEST_F(OnTheDesk, IsADeviceOfTheOpenProtocol) {
  EXPECT_EQ(model.report_descriptor(), raw_device());
  const DeviceTraits& traits = link->traits();
  EXPECT_EQ(traits.name, "paddle");
  ASSERT_EQ(traits.effort.size(), 1u);
  EXPECT_NEAR(traits.effort[0], 0.8, 1e-6);
  EXPECT_EQ(traits.rate, 1000);
}

TEST_F(OnTheDesk, IsWithoutTorqueUntilItKnowsWhereItIs) {
  EXPECT_EQ(push(0.3), 0);
  EXPECT_TRUE(reading().fault);
  begin();
  EXPECT_NEAR(push(0.3), 0.3, 1e-6);
  EXPECT_FALSE(reading().fault);
  push(0.3, 2000);
  EXPECT_TRUE(reading().hand);
  EXPECT_NEAR(reading().x[0], model.hand().position(0), 1 / paddle_build.counts);
}

// A computer that pushes all the same gets no torque.
TEST_F(OnTheDesk, DoesNotRelyOnTheComputer) {
  std::uint32_t sequence = 0;
  const auto told = [&](float torque) {
    for (int i = 0; i < 3; ++i, now += 1ms) {
      EXPECT_TRUE(send(command(sequence > 0 ? 1 : 0, sequence + 1, torque)));
      ++sequence;
    }
    model.input(now);
    return model.forces().newest()[0];
  };
  EXPECT_EQ(told(0.2f), 0) << "it does not know where it is";
  model.lay_at_its_end();
  EXPECT_NEAR(told(0.2f), 0.2, 1e-6);
  model.hand().hold(false);
  EXPECT_EQ(told(0.2f), 0);
  model.hand().hold(true);
  EXPECT_NEAR(told(0.2f), 0.2, 1e-6);
  model.set_driver_fault(true);
  EXPECT_EQ(told(0.2f), 0);
  model.set_driver_fault(false);
  model.hand().axis(0).upper = 1;
  model.hand().axis(0).stiffness = 200;
  model.hand().axis(0).path = [](double) { return 0.9; };
  for (int i = 0; i < 100; ++i) told(0.2f);
  EXPECT_GT(model.hand().position(0), 0.85);
  EXPECT_EQ(told(0.2f), 0) << "beyond its end";
}

TEST_F(OnTheDesk, GivesWhatItIsToldWithinItsLimit) {
  begin();
  for (const double torque : {0.3, -0.3, 0.79}) EXPECT_NEAR(push(torque), torque, 1e-6);
  send(command(1, 1u << 30, 5.0f));
  now += 1ms;
  model.input(now);
  EXPECT_NEAR(model.forces().newest()[0], 0.8, 1e-6);
}

TEST_F(OnTheDesk, CutsTheTorqueByItselfAndSaysSo) {
  begin();
  push(0.3);
  const Time silence = now;
  for (; now < silence + 30ms; now += 1ms) link->transport.arrive(model.input(now));
  const auto zero = model.forces().zero_after(silence);
  ASSERT_TRUE(zero);
  EXPECT_LE(*zero, 10.2ms);
  EXPECT_GE(*zero, 8ms);
  EXPECT_TRUE(model.input(now += 1ms).front()[3] & 16) << "its watchdog has cut the torque";
  EXPECT_FALSE(send(command(1, 1u << 30, 0.2f))) << "the computer may not know that it was gone";
  EXPECT_TRUE(model.input(now += 1ms).front()[3] & 16);
  EXPECT_EQ(model.forces().newest()[0], 0);
  EXPECT_TRUE(send(command(0, (1u << 30) + 1, 0))) << "until the next command without torque";
  EXPECT_FALSE(model.input(now += 1ms).front()[3] & 16);
  EXPECT_TRUE(send(command(1, (1u << 30) + 2, 0.2f)));
  model.input(now += 1ms);
  EXPECT_NEAR(model.forces().newest()[0], 0.2, 1e-6);
}

// Line A, B or both are broken, and the hand does not hold still.
TEST_F(OnTheDesk, LosesItsTorqueWhereALineOfItsEncoderDoesNotChange) {
  for (const int lines : {1, 2, 3}) {
    model.power(false, now);
    model.power(true, now);
    link = std::make_unique<SimulatedLink>(model, std::make_unique<RawProtocol>(), now);
    begin();
    model.hand().axis(0).path = [](double t) { return 0.1 + 0.02 * std::sin(10 * t); };
    EXPECT_NEAR(push(0.3, 2000), 0.3, 1e-6);
    model.break_lines(static_cast<std::uint8_t>(lines));
    EXPECT_NEAR(push(0.3, 250), 0.3, 1e-6);
    EXPECT_GT(push(0.3, 300), 0.01) << "it fades";
    EXPECT_EQ(push(0.3, 100), 0) << lines;
    EXPECT_TRUE(reading().fault);
    EXPECT_EQ(push(0.3, 1000), 0);
    model.break_lines(0);
    push(0, 500);
    EXPECT_FALSE(reading().fault) << "both lines have changed";
    EXPECT_NEAR(push(0.3, 10), 0.3, 1e-6);
  }
}

// When the torque fades, the hand moves the paddle, and the torque comes back at a bounded rate.
TEST_F(OnTheDesk, PushesOnWhereAHandHoldsItStill) {
  model.hand().axis(0).stiffness = 7;
  begin();
  push(0.3, 1000);
  double before = 0.3;
  for (int ms = 0; ms < 10'000; ++ms) {
    const double now_given = push(0.3, 1);
    ASSERT_GT(now_given, 0.85 * 0.3) << ms;
    ASSERT_LE(now_given - before, 0.3 * 2e-3 + 1e-6) << ms;
    before = now_given;
  }
  EXPECT_FALSE(reading().fault);
}

TEST_F(OnTheDesk, MayStandStillForEverWithLittleTorque) {
  begin();
  push(0.035);
  for (int ms = 0; ms < 5000; ++ms) ASSERT_NEAR(push(0.035, 1), 0.035, 1e-6) << ms;
}

TEST_F(OnTheDesk, UsesNoCommandThatIsNotRight) {
  begin();
  ASSERT_TRUE(send(command(0, 1, 0)));
  ASSERT_TRUE(send(command(1, 10, 0.1f)));
  const auto spoilt = [&](std::size_t byte, std::uint8_t value, bool sealed) {
    Report report = command(1, 11, 0.2f);
    report[byte] = value;
    if (sealed) write_at(report, 60, crc32_of(std::span(report).first(60)));
    return report;
  };
  EXPECT_FALSE(send(spoilt(17, 0x55, false))) << "damaged on the way";
  EXPECT_FALSE(send(spoilt(0, 0x4D, true)));
  EXPECT_FALSE(send(spoilt(1, 2, true)));
  EXPECT_FALSE(send(spoilt(2, 2, true)));
  EXPECT_FALSE(send(spoilt(3, 2, true)));
  EXPECT_FALSE(send(command(1, 11, NAN)));
  EXPECT_FALSE(send(command(1, 11, INFINITY)));
  EXPECT_FALSE(send(command(1, 10, 0.2f))) << "once more";
  EXPECT_FALSE(send(command(1, 9, 0.2f))) << "late";
  EXPECT_FLOAT_EQ(model.firmware().torque, 0.1f);
  EXPECT_TRUE(send(command(0, 3, 0))) << "without torque always";
  EXPECT_EQ(model.firmware().torque, 0);
  EXPECT_TRUE(send(command(1, 4, 0.2f))) << "counted on from there";
}

TEST_F(OnTheDesk, WaitsForASessionToBeginAfterARestart) {
  begin();
  push(0.3);
  model.power(false, now);
  model.power(true, now);
  model.lay_at_its_end();
  model.input(now += 1ms);
  EXPECT_FALSE(send(command(1, 500, 0.3f)));
  EXPECT_TRUE(send(command(0, 501, 0)));
  EXPECT_TRUE(send(command(1, 502, 0.3f)));
}

TEST_F(OnTheDesk, LetsGoWhenTheHandDoesAndOnFaults) {
  begin();
  EXPECT_NEAR(push(0.2), 0.2, 1e-6);
  model.hand().hold(false);
  EXPECT_EQ(push(0.2, 3), 0);
  EXPECT_FALSE(reading().hand);
  model.hand().hold(true);
  model.set_driver_fault(true);
  EXPECT_EQ(push(0.2, 3), 0);
  EXPECT_TRUE(reading().fault);
  model.set_driver_fault(false);
  EXPECT_NEAR(push(0.2), 0.2, 1e-6);
}

// The paddle no longer knows its angle.
TEST_F(OnTheDesk, IsAtFaultOnceItsEncoderHasSkippedAStep) {
  begin();
  EXPECT_NEAR(push(0.2), 0.2, 1e-6);
  model.skip_steps(1);
  model.hand().axis(0).path = [](double) { return 0.3; };
  EXPECT_EQ(push(0.2, 200), 0);
  EXPECT_TRUE(reading().fault);
  model.hand().axis(0).path = [](double) { return 0.1; };
  EXPECT_EQ(push(0.2, 200), 0) << "for good";
}

// The winding warms by 1 - exp(-t/10 s) of (0.8/0.3)^2: it reaches its limit after 1.52 s.
TEST_F(OnTheDesk, SparesItsWinding) {
  model.hand().axis(0).stiffness = 20;
  model.hand().axis(0).path = [](double t) { return 0.1 + 0.01 * std::sin(20 * t); };
  begin();
  EXPECT_NEAR(push(0.8, 1480), 0.8, 1e-6);
  EXPECT_NEAR(push(0.8, 80), 0.3, 1e-6);
  push(0.05, 3000);
  EXPECT_NEAR(push(0.8, 5), 0.8, 1e-6) << "once it has cooled";
}

// Identification of a paddle through its firmware.
struct Moved {
  explicit Moved(PaddleModel& model) {
    Time now = 1h;
    model.power(true, now);
    model.lay_at_its_end();
    model.input(now += 1ms);
    SimulatedLink link(model, std::make_unique<RawProtocol>(), now);
    Excitation motion(arm, link.traits(), {});
    std::vector<double> x, torque;
    for (; motion.end() == ExcitationEnd::running; now += 500us) {
      link.transport.arrive(model.input(now));
      now += 50us;
      link.exchange.step();
      DeviceReading reading;
      const bool here = link.read(reading);
      now += 450us;
      const DeviceHealth health{.guarded = true, .fault = reading.fault, .lost = !here};
      const auto sent = motion.step({std::span(reading.x).first(1), 1e-3, health});
      link.write(sent);
      x.push_back(reading.x[0]);
      torque.push_back(sent[0]);
    }
    const auto rows = static_cast<Eigen::Index>(x.size());
    record.x = Eigen::Map<Eigen::VectorXd>(x.data(), rows);
    record.torque = Eigen::Map<Eigen::VectorXd>(torque.data(), rows);
    end = motion.end();
    seconds = motion.time();
  }

  const ArmDescription arm = read_urdf(assets_dir() / "devices/paddle.urdf");
  MotionRecord record;
  ExcitationEnd end = ExcitationEnd::running;
  double seconds = 0;
};

// Physics of a paddle that nobody holds; the grip switch is taped.
AxisPhysics alone() {
  AxisPhysics physics = PaddleModel::paddle_axis();
  physics.stiffness = physics.damping = 0;
  return physics;
}

TEST(Paddle, IsFoundOutThroughItsFirmware) {
  AxisPhysics physics = alone();
  physics.inertia *= 1.3;
  PaddleModel model(physics);
  const Moved moved(model);
  ASSERT_EQ(moved.end, ExcitationEnd::complete) << explain(moved.end);
  const Identified found = identify(moved.arm, moved.record, {.gravity = Vec3::Zero()});
  EXPECT_NEAR(found.joints[0].inertia.value, physics.inertia, 0.05 * physics.inertia);
  EXPECT_NEAR(found.joints[0].viscous.value, physics.friction, 0.1 * physics.friction);
}

TEST(Paddle, EndsItsMotionSoonWhereTheMotorIsTheWrongWayRound) {
  PaddleModel model(alone());
  model.swap_the_motors_wires();
  const Moved moved(model);
  EXPECT_TRUE(moved.end == ExcitationEnd::limit || moved.end == ExcitationEnd::held)
      << explain(moved.end);
  EXPECT_LT(moved.seconds, 4);
}

}  // namespace
}  // namespace limpid::test
