// The check of a joystick's axes, on joysticks without and with faults, in simulated time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "devices/adjusted_device.h"
#include "devices/hid/axis_check.h"
#include "devices/hid/raw_protocol.h"
#include "tests/vm/simulated_desk.h"

namespace limpid::test {
namespace {

using namespace std::chrono_literals;
using Two = std::array<double, 2>;

// A joystick of this firmware, held lightly in its middle, with the check in place of a loop.
template <class Model>
struct CheckedStick : testing::Test {
  CheckedStick() {
    PidJoystickOptions options = Model::usual_options();
    options.torque_limit = kEffort;
    model = std::make_unique<Model>(options);
    for (int axis = 0; axis < 2; ++axis) model->hand().axis(axis) = stick_axis(axis);
    model->power(true, now);
    connect({});
  }
  void connect(std::array<bool, 2> reverse) {
    PidSettings settings{.range = kRange, .effort = kEffort, .reverse = reverse};
    link = std::make_unique<SimulatedLink>(
        *model,
        std::make_unique<PidJoystick>(parse_report_descriptor(model->report_descriptor()),
                                      settings),
        now);
    check.emplace(link->traits());
  }
  void tick() {
    link->transport.arrive(model->input(now));
    DeviceReading reading;
    const bool here = link->read(reading);
    const bool well = here && reading.age < 0.006 && reading.hand && !reading.fault;
    const auto torque = check->step({reading.x, 1e-3, well});
    Two out{torque[0], torque[1]};
    asked = std::max({asked, std::abs(out[0]), std::abs(out[1])});
    wire(out);
    link->write(out);
    link->exchange.step();
    now += 1ms;
  }
  // Runs the check to its end; returns the time it took.
  Time run() {
    for (int i = 0; i < 10; ++i) {  // some readings first
      link->transport.arrive(model->input(now));
      link->exchange.step();
      now += 1ms;
    }
    const Time start = now;
    while (!check->done() && now < start + 60s) tick();
    EXPECT_TRUE(check->done());
    return now - start;
  }
  void expect(AxisVerdict x, AxisVerdict y) {
    EXPECT_EQ(check->finding(0).verdict, x) << explain(check->finding(0).verdict);
    EXPECT_EQ(check->finding(1).verdict, y) << explain(check->finding(1).verdict);
    const auto fine = [](AxisVerdict one) {
      return one == AxisVerdict::right || one == AxisVerdict::reversed;
    };
    EXPECT_EQ(check->passed(), fine(x) && fine(y));
    for (int i = 0; i < 100; ++i) tick();
    EXPECT_EQ(model->acting(now), Torque{}) << "it still pushes";
    EXPECT_LE(asked, 0.1 * kEffort + 1e-12);
  }

  Time now = 1h;
  std::unique_ptr<Model> model;
  std::unique_ptr<SimulatedLink> link;
  std::optional<AxisCheck> check;
  std::function<void(Two&)> wire = [](Two&) {};  // from the check's torque to the motors'
  double asked = 0;                              // largest torque of the check [N m]
};
using Models = testing::Types<PidJoystickModel, ArduinoJoystick, FinoJoystick, OpenFfboardJoystick,
                              AdaptJoystick>;
TYPED_TEST_SUITE(CheckedStick, Models);

TYPED_TEST(CheckedStick, IsFoundToPushAsItsFirmwareDoes) {
  const auto verdict = [](bool reversed) {
    return reversed ? AxisVerdict::reversed : AxisVerdict::right;
  };
  const Time took = this->run();
  EXPECT_LE(took, 2 * 3s);
  const auto reversed = TypeParam::kReversed;
  this->expect(verdict(reversed[0]), verdict(reversed[1]));
  EXPECT_LE(this->model->forces().largest(), 0.1 * kEffort * (1 + 2.0 / 127));
  EXPECT_THAT(this->model->violations(), testing::IsEmpty());
  this->connect(reversed);  // as if remembered from an earlier check
  this->run();
  this->expect(AxisVerdict::right, AxisVerdict::right);
}

TYPED_TEST(CheckedStick, MayBeLetGo) {
  this->model->hand().hold(false);
  this->connect(TypeParam::kReversed);
  this->run();
  this->expect(AxisVerdict::right, AxisVerdict::right);
  EXPECT_LT(std::abs(this->model->hand().position(0)), 0.05);
}

using OneStick = CheckedStick<PidJoystickModel>;

// Against its spring the stick yields by torque over stiffness at most.
TEST_F(OneStick, TellsHowFarItMoves) {
  run();
  for (int i = 0; i < 2; ++i) {
    EXPECT_GT(check->finding(i).moved_per_torque, 0.3 / stick_axis(0).stiffness);
    EXPECT_LT(check->finding(i).moved_per_torque, 1.0 / stick_axis(0).stiffness);
  }
}

TEST_F(OneStick, IsFoundWithOneAxisReversed) {
  wire = [](Two& torque) { torque[1] = -torque[1]; };
  run();
  expect(AxisVerdict::right, AxisVerdict::reversed);
}

TEST_F(OneStick, WithSwappedAxesIsRefused) {
  wire = [](Two& torque) { std::swap(torque[0], torque[1]); };
  run();
  expect(AxisVerdict::wrong_axis, AxisVerdict::unknown);
}

// Some firmwares take one direction for every effect.
TEST_F(OneStick, ThatPushesOneAxisOnlyIsRefused) {
  wire = [](Two& torque) { torque = {torque[0] + torque[1], 0}; };
  run();
  expect(AxisVerdict::right, AxisVerdict::wrong_axis);
}

TEST_F(OneStick, ThatPushesAslantIsRefused) {
  wire = [](Two& torque) { torque = {torque[0] - torque[1], torque[0] + torque[1]}; };
  run();
  expect(AxisVerdict::wrong_axis, AxisVerdict::unknown);
}

TEST_F(OneStick, WithADeadMotorIsRefused) {
  wire = [](Two& torque) { torque[1] = 0; };
  run();
  expect(AxisVerdict::right, AxisVerdict::nothing_moved);
}

// Pads whose motors only shake do not move either.
TEST_F(OneStick, WithoutMotorsIsRefused) {
  wire = [](Two& torque) { torque = {}; };
  run();
  expect(AxisVerdict::nothing_moved, AxisVerdict::unknown);
}

TEST_F(OneStick, ThatIsHeldFirmlyIsRefused) {
  for (int axis = 0; axis < 2; ++axis) model->hand().axis(axis).stiffness = 40;
  run();
  expect(AxisVerdict::nothing_moved, AxisVerdict::unknown);
}

// The axis pushes with all of its force, whatever the command, and keeps on.
TEST_F(OneStick, ThatRunsAwayIsStoppedAtOnceAndRefused) {
  for (const bool held : {true, false}) {
    connect({});
    model->hand().hold(held);
    model->hand().begin(now);
    model->forces().clear();
    bool begun = false;
    Time began{};
    wire = [&](Two& torque) {
      if (!begun && torque[0] != 0) {
        begun = true;
        began = now;
      }
      if (torque[0] != 0) torque[0] = kEffort;
    };
    run();
    EXPECT_LT(now - began, 10ms) << held;
    expect(AxisVerdict::too_far, AxisVerdict::unknown);
  }
}

// The axis moves on by itself after a push.
TEST_F(OneStick, ThatDoesNotStopIsRefused) {
  model->hand().hold(false);
  bool pushed = false;
  wire = [&](Two& torque) {
    pushed = pushed || torque[0] != 0;
    if (pushed) torque[0] = std::max(torque[0], 0.005);
  };
  run();
  EXPECT_THAT(check->finding(0).verdict,
              testing::AnyOf(AxisVerdict::too_far, AxisVerdict::restless));
  EXPECT_FALSE(check->passed());
  EXPECT_LT(model->hand().position(0), 0.2);
}

// A hand that leads the stick to and fro is not taken for its motors.
TEST_F(OneStick, ThatTheHandMovesIsRefused) {
  for (const double period : {0.2, 0.5, 1.0, 2.0, 4.0}) {
    model->hand().axis(0).path = [period](double t) {
      return 0.15 * std::sin(2 * 3.14159265358979 * t / period);
    };
    model->hand().begin(now);
    connect({});
    wire = [](Two& torque) { torque = {}; };
    run();
    EXPECT_FALSE(check->passed()) << period;
    EXPECT_NE(check->finding(0).verdict, AxisVerdict::right) << period;
    EXPECT_NE(check->finding(0).verdict, AxisVerdict::reversed) << period;
  }
}

TEST_F(OneStick, ThatFallsSilentLeavesNothing) {
  const Time begun = now;
  wire = [&](Two&) {
    if (now > begun + 300ms) model->set_fault(Fault::silent);
  };
  run();
  expect(AxisVerdict::given_up, AxisVerdict::unknown);
}

TEST_F(OneStick, ThatTheHandLetsGoLeavesNothing) {
  const Time begun = now;
  wire = [&](Two&) {
    if (now > begun + 300ms) model->let_go(true);
  };
  run();
  expect(AxisVerdict::given_up, AxisVerdict::unknown);
}

// The wiring of a home-made device's motors is known only to its maker.
TEST(CheckedRawDevice, WithAReversedMotorIsFoundWithATenthOfItsForceAndTurnedRound) {
  Time now = 1h;
  RawDeviceModel model({.joints = 2, .torque_limit = kEffort});
  for (int axis = 0; axis < 2; ++axis) model.hand().axis(axis) = stick_axis(axis);
  model.power(true, now);
  std::array<AxisAdjustment, 2> axes;
  for (const bool known : {false, true}) {
    auto link = std::make_unique<SimulatedLink>(model, std::make_unique<RawProtocol>(), now);
    SimulatedLink& wire = *link;
    constexpr std::array<AxisAdjustment, 2> kWired{{{}, {.reversed = true}}};
    AdjustedDevice device(std::make_unique<AdjustedDevice>(std::move(link), kWired), axes);
    AxisCheck check(device.traits());
    const Time start = now;
    for (; !check.done() && now < start + 60s; now += 1ms) {
      wire.transport.arrive(model.input(now));
      wire.exchange.step();
      DeviceReading reading;
      const bool here = device.read(reading);
      if (reading.count == 0) continue;
      device.write(check.step({std::span(reading.x).first(2), 1e-3, here && reading.age < 0.006}));
    }
    EXPECT_TRUE(check.passed()) << explain(check.finding(check.axis()).verdict);
    EXPECT_EQ(check.finding(0).verdict, AxisVerdict::right);
    EXPECT_EQ(check.finding(1).verdict, known ? AxisVerdict::right : AxisVerdict::reversed);
    EXPECT_LE(model.forces().largest(), 0.1 * kEffort + 1e-6);
    EXPECT_GT(model.forces().largest(), 0);
    axes[1].reversed = true;  // as if remembered from an earlier check
  }
  EXPECT_THAT(model.violations(), testing::IsEmpty());
}

}  // namespace
}  // namespace limpid::test
