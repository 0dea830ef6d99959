// The running loop with healthy reference devices: nothing is lost, all are found, and one that was
// pulled out comes back without force.
#include <gtest/gtest.h>

#include "tests/support/rows.h"
#include "tests/support/temp_dir.h"
#include "tests/vm/desk.h"

namespace limpid::test {
namespace {

TEST(Devices, AreListedWithTheirNamesAndKinds) {
  SpaceMouseModel mouse;
  PidJoystickModel joystick;
  RawDeviceModel raw;
  const UhidDevice a(mouse), b(joystick), c(raw);
  const auto found = list_devices({.udev_rule = "rules"});
  ASSERT_EQ(found.size(), 3u);
  const auto has = [&](std::string_view kind, const char* name, const char* id) {
    return std::ranges::any_of(found, [&](const FoundDevice& one) {
      return one.kind->key == kind && one.place.name == name && one.place.id == id &&
             one.missing.empty();
    });
  };
  EXPECT_TRUE(has("space_mouse", "3Dconnexion SpaceMouse Compact", "256f:c635:SM-1"));
  EXPECT_TRUE(has("pid", "Limpid PID joystick", "1209:4c49:PID-1"));
  EXPECT_TRUE(has("raw", "Limpid raw arm", "1209:4c50:RAW-1"));
}

TEST(RawLoop, LosesNoReportEitherWay) {
  Desk<RawDeviceModel> desk;
  auto connection = desk.connect();
  const auto& device = static_cast<const HidDevice&>(*connection);
  desk.open(std::move(connection));
  ASSERT_TRUE(desk.push());
  const int sent = desk.device->counts().sent;
  DeviceReading first, last;
  desk.loop.update();
  first = desk.loop.snapshot().reading;
  const int commands = desk.device->with([&](Time) { return desk.model->commands(); });
  wait(2s);
  desk.loop.update();
  last = desk.loop.snapshot().reading;
  EXPECT_NEAR(static_cast<double>(last.count - first.count), desk.device->counts().sent - sent, 3);
  EXPECT_EQ(device.unusable(), 0u);
  desk.device->with([&](Time) {
    EXPECT_GE(desk.model->commands() - commands, 1990);
    EXPECT_EQ(desk.model->gaps(), 0);
    EXPECT_EQ(desk.model->rejected(), 0);
    EXPECT_TRUE(desk.model->violations().empty()) << desk.model->violations()[0];
  });
  EXPECT_EQ(desk.loop.status().slipped, 0);
}

// A device that reports only changes is silent at rest, and is pushed all the same.
TEST(PidLoop, PushesAStickThatSaysNothingWhileItRests) {
  PidJoystickOptions options{.torque_limit = kEffort, .physics = stick_axis(1)};
  options.only_changes = true;
  Desk<PidJoystickModel> desk(std::make_unique<PidJoystickModel>(options));
  desk.open();
  ASSERT_TRUE(desk.push());
  wait(2s);
  const int sent = desk.device->counts().sent;
  const Time before = steady_now();
  wait(500ms);
  EXPECT_LT(desk.device->counts().sent - sent, 250) << "it was to be silent";
  EXPECT_EQ(desk.force_state(), ForceState::on);
  desk.device->with([&](Time now) {
    EXPECT_LT(desk.model->forces().longest_silence(before, now), 6ms);
    EXPECT_LT(desk.model->forces().newest()[0], -0.1);
    EXPECT_TRUE(desk.model->violations().empty()) << desk.model->violations()[0];
  });
}

template <class Model>
struct PulledOut : testing::Test {};
using Models = testing::Types<PidJoystickModel, RawDeviceModel>;
TYPED_TEST_SUITE(PulledOut, Models);

TYPED_TEST(PulledOut, ComesBackWithoutForceAndTheRecordingGoesOn) {
  Desk<TypeParam> desk;
  const TempDir dir;
  desk.open();
  wait(50ms);
  RunPlan plan;
  plan.arm = desk.arm;
  plan.document = desk.document;
  plan.hand.source = "device";
  desk.record(dir / "a.h5", plan);
  ASSERT_TRUE(wait_until([&] { return desk.loop.update() && desk.loop.snapshot().recording; }));
  const auto ticks_before = desk.loop.status().ticks;
  ASSERT_TRUE(desk.push());
  wait(200ms);

  desk.device->unplug();
  wait(300ms);
  EXPECT_EQ(desk.force_state(), ForceState::lost);
  EXPECT_FALSE(desk.loop.snapshot().connected);
  desk.device->replug();
  const Time back = steady_now();
  desk.loop.plug(desk.connect());
  EXPECT_TRUE(wait_until([&] {
    desk.loop.update();
    return desk.loop.snapshot().connected;
  }));
  wait(1500ms);
  EXPECT_EQ(desk.force_state(), ForceState::lost);
  EXPECT_EQ(desk.device->with([&](Time) { return desk.model->forces().largest(back); }), 0);

  desk.arm_force(false);
  EXPECT_TRUE(wait_until([&] { return desk.force_state() == ForceState::off; }));
  EXPECT_TRUE(desk.push());
  const auto dropped = desk.loop.recorder()->dropped();
  const auto ticks_after = desk.loop.status().ticks;
  desk.loop.finish_recording();
  desk.loop.close();
  EXPECT_EQ(dropped, 0u);

  const Session session = read_session(dir / "a.h5");
  EXPECT_NEAR(static_cast<double>(session.size()), static_cast<double>(ticks_after - ticks_before),
              10);
  std::vector<int> states;  // in this order
  for (std::size_t k = 0; k < session.size(); ++k) {
    // Ticks that came too late were given up, and the time shows it.
    const double periods =
        k == 0 ? 1 : 1e3 * (session.at(k, Column::time)[0] - session.at(k - 1, Column::time)[0]);
    ASSERT_NEAR(periods, std::round(periods), 1e-6) << k;
    ASSERT_GE(periods, 0.5) << k;
    ASSERT_TRUE(std::isnan(session.at(k, Column::hand_torque)[0]));
    const int state = static_cast<int>(session.at(k, Column::force_state)[0]);
    if (states.empty() || states.back() != state) states.push_back(state);
    if (state != 0) {
      ASSERT_EQ(session.at(k, Column::motor_torque)[0], 0) << k;
    }
  }
  // A tick may find its readings frozen before the loss is noticed.
  std::erase(states, static_cast<int>(ForceState::stale));
  std::erase(states, static_cast<int>(ForceState::stalled));
  const auto number = [](ForceState state) { return static_cast<int>(state); };
  EXPECT_EQ(states,
            (std::vector{number(ForceState::off), number(ForceState::on), number(ForceState::lost),
                         number(ForceState::off), number(ForceState::on)}));
}

TEST(SpaceMouse, LeadsTheHandOfAVirtualArm) {
  SpaceMouseModel model;
  UhidDevice device(model);
  LiveLoop loop({});
  const ArmDescription arm = read_urdf("omni.urdf");
  const Vec3 home(0.19, 0, 0);
  loop.open(arm, Scene{}, Parameters{}, home);
  loop.plug(open_device(find_device("space_mouse")));
  const auto tip = [&] {
    loop.update();
    const auto target =
        loop.layout().in(std::span<const double>(loop.snapshot().row), Column::hand_target);
    return Vec3(target[0], target[1], target[2]);
  };
  EXPECT_TRUE(wait_until([&] { return loop.update() && loop.snapshot().connected; }));
  wait(200ms);
  EXPECT_LT((tip() - home).norm(), 1e-3);
  // Motion away from the user, and up.
  device.with([&](Time) {
    model.move([](double) { return SpaceMouseModel::Cap{0, -0.6, -0.4, 0, 0, 0}; });
    model.press(2);
  });
  wait(500ms);
  const Vec3 moved = tip() - home;
  EXPECT_GT(moved.x(), 0.005);
  EXPECT_GT(moved.z(), 0.002);
  EXPECT_NEAR(moved.y(), 0, 1e-3);
  EXPECT_EQ(loop.snapshot().reading.buttons, 2u);
  device.unplug();
  EXPECT_TRUE(wait_until([&] { return loop.update() && !loop.snapshot().connected; }));
  EXPECT_TRUE(loop.status().running);
}

}  // namespace
}  // namespace limpid::test
