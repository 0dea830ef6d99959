// The suite of the virtual machine in simulated time, for places without one. It does not show that
// the kernel's HID stack and hidapi carry the reports, that threads keep their times, that a
// guardian stops the device of a killed process, and recordings across an unplugging.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/support/built_in.h"
#include "tests/vm/simulated_desk.h"

namespace limpid::test {
namespace {

using namespace std::chrono_literals;

constexpr Time kReadingLife = 5ms + 1ms;  // life of a reading and one report
constexpr Time kTickLife = 10ms;

ArmDescription joystick() { return read_urdf(assets_dir() / "devices/joystick.urdf"); }
// The gate without the bump: around its edge the torque changes faster than the hand moves.
Scene gate() {
  Scene scene = read_scene(assets_dir() / "devices/joystick.toml", joystick()).scene;
  std::erase_if(scene.objects, has_shape<Sphere>);
  return scene;
}

template <class Model>
struct SimulatedLoop : testing::Test {
  std::optional<Time> time_to_zero(const std::function<void()>& failure) {
    const Time moment = desk.now;
    failure();
    desk.run(100);
    return desk.model->forces().zero_after(moment);
  }
  // A fault of the device while it pushes; force must not come back by itself.
  void expect_end(const std::function<void(Model&, bool)>& fault, ForceState state,
                  Time limit = kReadingLife) {
    ASSERT_TRUE(desk.push());
    const auto zero = time_to_zero([&] { fault(*desk.model, true); });
    ASSERT_TRUE(zero);
    EXPECT_LE(*zero, limit);
    EXPECT_EQ(desk.rig.force_state(), state);
    fault(*desk.model, false);
    desk.run(700);
    EXPECT_EQ(desk.torque(), 0) << "it pushes again without having been armed";
    desk.armed = false;
    desk.run(5);
    EXPECT_EQ(desk.rig.force_state(), ForceState::off);
    EXPECT_TRUE(desk.push());
  }
  void expect_end(Fault fault) {
    expect_end([&](Model& model, bool on) { model.set_fault(on ? fault : Fault::none); },
               ForceState::stale);
  }

  SimulatedDesk<Model> desk{joystick(), gate()};
};
using Models = testing::Types<PidJoystickModel, ArduinoJoystick, FinoJoystick, OpenFfboardJoystick,
                              AdaptJoystick, RawDeviceModel>;
TYPED_TEST_SUITE(SimulatedLoop, Models);

TYPED_TEST(SimulatedLoop, EndsForceWhenTheDeviceFallsSilent) { this->expect_end(Fault::silent); }

TYPED_TEST(SimulatedLoop, EndsForceWhenTheDeviceSendsNaN) { this->expect_end(Fault::not_a_number); }

TYPED_TEST(SimulatedLoop, EndsForceWhenTheDeviceSendsHalfReports) {
  this->expect_end(Fault::cut_short);
}

TYPED_TEST(SimulatedLoop, EndsForceWhenTheDeviceSendsGarbage) {
  ASSERT_TRUE(this->desk.push());
  const auto zero = this->time_to_zero([&] { this->desk.model->set_fault(Fault::garbage); });
  ASSERT_TRUE(zero);
  EXPECT_LE(*zero, kReadingLife);
}

// The encoders' wires are broken: new reports arrive with the same angles.
TYPED_TEST(SimulatedLoop, EndsForceWhenReadingsStandStillThoughReportsGoOn) {
  auto& here = this->desk;
  ASSERT_TRUE(here.push());
  const Time moment = here.now;
  here.model->hand().break_encoders(true);
  here.run(200);
  EXPECT_LT(here.torque(), -0.1) << "it may be held still for a while";
  here.run(500);
  const auto zero = here.model->forces().zero_after(moment);
  ASSERT_TRUE(zero);
  EXPECT_LE(*zero, 605ms);
  EXPECT_EQ(here.rig.force_state(), ForceState::frozen);
  here.armed = false;
  here.run(5);
  here.armed = true;
  here.run(700);
  EXPECT_EQ(here.model->forces().largest(moment + 605ms), 0) << "armed again, but not moved";
  here.model->hand().break_encoders(false);
  here.run(700);
  EXPECT_EQ(here.torque(), 0) << "it pushes again without having been armed";
  here.armed = false;
  here.run(5);
  EXPECT_EQ(here.rig.force_state(), ForceState::off);
  EXPECT_TRUE(here.push());
}

// A hand that does not tremble holds the device against the wall for ten seconds.
TYPED_TEST(SimulatedLoop, PushesOnWhereAHandHoldsTheDeviceStill) {
  auto& here = this->desk;
  ASSERT_TRUE(here.push());
  const double full = here.torque();
  const std::size_t first = here.row.size();
  here.run(10'000);
  EXPECT_NEAR(here.torque(), full, 0.1 * std::abs(full));
  for (std::size_t k = first; k < here.row.size(); ++k) {
    ASSERT_LT(here.row.vec(k, Column::motor_torque)[0], 0.85 * full) << k;
  }
}

TYPED_TEST(SimulatedLoop, EndsForceWhenNoTickComes) {
  ASSERT_TRUE(this->desk.push());
  const auto zero = this->time_to_zero([&] { this->desk.ticking = false; });
  ASSERT_TRUE(zero);
  EXPECT_LE(*zero, kTickLife);
}

// The device ends the force itself: a raw one by its watchdog, a PID one because its effects end.
TYPED_TEST(SimulatedLoop, EndsForceWhenNobodySpeaksAnyMore) {
  ASSERT_TRUE(this->desk.push());
  const Time silence = this->desk.now;
  for (; this->desk.now < silence + 50ms; this->desk.now += 1ms) {
    this->desk.model->input(this->desk.now);
  }
  const auto zero = this->desk.model->forces().zero_after(silence);
  ASSERT_TRUE(zero);
  EXPECT_LE(*zero, 10ms + 1ms);
}

TYPED_TEST(SimulatedLoop, ComesBackWithoutForceWhenPulledOutAndIn) {
  auto& here = this->desk;
  ASSERT_TRUE(here.push());
  here.replug();
  const Time back = here.now;
  here.run(1500);
  EXPECT_EQ(here.rig.force_state(), ForceState::lost);
  DeviceReading reading;
  EXPECT_TRUE(here.rig.device_reading(reading));
  EXPECT_EQ(here.model->forces().largest(back), 0);
  here.armed = false;
  here.run(5);
  EXPECT_TRUE(here.push());
  for (std::size_t k = 0; k < here.row.size(); ++k) {
    ASSERT_NEAR(here.row.at(k, Column::time), 1e-3 * static_cast<double>(k), 1e-9);
  }
}

TYPED_TEST(SimulatedLoop, AgreesWithTheVirtualArm) {
  constexpr int kTicks = 10'000;
  auto& here = this->desk;
  for (int axis = 0; axis < 2; ++axis) {
    here.model->hand().axis(axis).path = [axis](double t) { return Circling::path(axis, t); };
  }
  here.model->hand().begin(here.now);
  std::vector<double> times;  // times of the ticks, from the hand's beginning
  for (int k = 0; k < kTicks; ++k) times.push_back(1e-3 * (k + 0.5));
  here.armed = true;
  here.run(kTicks);
  EXPECT_TRUE(here.model->violations().empty()) << here.model->violations()[0];
  const Difference d = difference(here.row, circle_virtually(joystick(), gate(), times));
  const Allowed allowed = allowed_difference(1.1e-3, torque_levels<TypeParam>());
  EXPECT_GT(d.largest_torque, 0.15);
  EXPECT_LT(d.rms, allowed.usual);
  EXPECT_LT(d.worst, allowed.touching);
}

using SimulatedRawLoop = SimulatedLoop<RawDeviceModel>;

TEST_F(SimulatedRawLoop, EndsForceWhenReadingsRepeatThemselves) { expect_end(Fault::stuck); }

TEST_F(SimulatedRawLoop, EndsForceWhenTheDeviceReportsAFault) {
  expect_end([](RawDeviceModel& model, bool on) { model.set_unwell(on); }, ForceState::fault, 3ms);
}

// The device's counter is off for one report, which arrives whole.
TEST_F(SimulatedRawLoop, EndsForceAtOneWrongReading) {
  for (const double off : {2 * std::numbers::pi, -0.9, 1e6}) {
    ASSERT_TRUE(desk.push());
    const auto zero = time_to_zero([&] {
      desk.model->hand().miscount(off);
      desk.run(1);
      desk.model->hand().miscount(0);
    });
    ASSERT_TRUE(zero);
    EXPECT_LE(*zero, 3ms);
    EXPECT_EQ(desk.rig.force_state(), ForceState::wrong);
    const Time after = desk.now;
    desk.run(2000);
    EXPECT_EQ(desk.model->forces().largest(after), 0) << "it pushes without having been armed";
    desk.armed = false;
    desk.run(5);
    EXPECT_EQ(desk.rig.force_state(), ForceState::off);
  }
  EXPECT_TRUE(desk.push());
}

// The limit at the tip is lowered below the hand's press: the force never exceeds it, and is there
// again when the hand presses less, with every law.
TYPED_TEST(SimulatedLoop, HoldsTheLimitAtItsTipAndPushesOnWithinIt) {
  auto& here = this->desk;
  constexpr double kLimit = 1;  // [N]
  here.parameters.kind = CouplingKind::predictive;
  here.rig.limit({.tip_force = kLimit});
  ASSERT_TRUE(here.push());
  const Time pressed = here.now;
  here.run(2000);
  const double most = here.model->forces().largest(pressed);
  EXPECT_LE(most, 1.01 * kLimit * kStickLength + 1.0 / torque_levels<TypeParam>());
  EXPECT_GT(most, 0.9 * kLimit * kStickLength);
  // The hand leans 0.1 rad into the gate's side, with 0.06 N m.
  here.model->hand().axis(0).path = [](double) { return 0.19; };
  here.run(2000);
  EXPECT_GT(here.rig.force().gain(), 0.99);
  EXPECT_GT(here.row.at(here.row.size() - 1, Column::governor), 0.99);
  EXPECT_GT(here.row.at(here.row.size() - 1, Column::energy_ledger), 0);
}

// No report reaches the device until its watchdog cuts; then all arrive again.
TEST_F(SimulatedRawLoop, FadesInFromNothingAfterTheDevicesWatchdogHasCut) {
  for (const int deaf : {11, 15, 40, 400}) {
    ASSERT_TRUE(desk.push());
    const double full = std::abs(desk.torque());
    desk.model->set_fault(Fault::deaf);
    desk.run(deaf);
    ASSERT_TRUE(desk.model->cut()) << "its watchdog takes 10 ms";
    EXPECT_EQ(desk.torque(), 0);
    desk.model->set_fault(Fault::none);
    for (int ms = 1; ms <= 500; ++ms) {
      desk.run(1);
      ASSERT_LE(std::abs(desk.torque()), kEffort * (ms + 3) / 500 + 1e-3) << deaf << ", " << ms;
    }
    desk.run(200);
    EXPECT_NEAR(std::abs(desk.torque()), full, 0.1 * full) << "it is still armed";
  }
}

TEST_F(SimulatedRawLoop, EndsForceWhileNoHandIsThere) {
  ASSERT_TRUE(desk.push());
  const auto zero = time_to_zero([&] { desk.model->hand().hold(false); });
  ASSERT_TRUE(zero);
  EXPECT_LE(*zero, 3ms);
  EXPECT_EQ(desk.rig.force_state(), ForceState::no_hand);
  desk.model->hand().hold(true);
  desk.run(10);
  EXPECT_EQ(desk.rig.force_state(), ForceState::on);
  EXPECT_LT(std::abs(desk.torque()), 0.05) << "it fades in";
  EXPECT_TRUE(desk.push());
}

TEST_F(SimulatedRawLoop, HearsEveryReportAndIsHeard) {
  ASSERT_TRUE(desk.push());
  DeviceReading reading;
  desk.rig.device_reading(reading);
  EXPECT_EQ(reading.count, 1500u);
  EXPECT_EQ(desk.model->gaps(), 0);
  EXPECT_EQ(desk.model->rejected(), 0);
  EXPECT_GE(desk.model->commands(), 1500);
  EXPECT_TRUE(desk.model->violations().empty()) << desk.model->violations()[0];
}

}  // namespace
}  // namespace limpid::test
