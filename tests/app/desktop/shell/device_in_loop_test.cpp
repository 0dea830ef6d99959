// A device in the desktop's loop: its limits, its arm, its encoders, and what is kept of it.
#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "app/run/replay.h"
#include "tests/app/desktop/shell/a_desktop.h"
#include "tests/support/built_in.h"
#include "tests/support/device_traits.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

using test::Wire;
using test::WiredDevice;

// Moving objects work on the virtual arm, on a plugged in device, and on the virtual arm again.
TEST_F(ADesktop, HasWhatMovesWithADeviceAsWell) {
  const Vec3 tip = desktop->live.controls().goal;
  const fs::path file = dir / "die.toml";
  std::ofstream(file) << fmt::format(
      "tip_radius = 0.004\n[[plane]]\nname = \"floor\"\npoint = [0, 0, {}]\nnormal = [0, 0, 1]\n"
      "stiffness = 600\n[[body]]\nname = \"die\"\nbox = [0.02, 0.02, 0.02]\nmass = 0.02\n"
      "position = [{}, {}, {}]\n",
      tip.z() - 0.05, tip.x(), tip.y() + 0.05, tip.z() - 0.035);
  desktop->world.open_scene(file);
  ASSERT_TRUE(until([&] { return said("Scene:"); }));
  const auto lies = [&] {  // it has fallen by 5 mm
    const auto pose = loop().layout().in(desktop->live.row(), Column::body_pose);
    return pose.size() == 7 && std::abs(pose[2] - (tip.z() - 0.04)) < 1e-4;
  };
  EXPECT_TRUE(until(lies));
  const auto wire = plug_in(3);
  EXPECT_TRUE(has("die"));
  EXPECT_TRUE(until(lies));
  desktop->world.close_device();
  EXPECT_TRUE(has("die"));
  EXPECT_TRUE(until(lies));
}

// The recording is made with the device in the loop.
TEST_F(ADesktop, HoldsADeviceToItsLimitsAndRecordsThem) {
  desktop->devices.hub().use("device");
  desktop->devices.hub().notes("device").limits.tip_force = 1.25;
  plug_in(3);
  frames(2);
  EXPECT_EQ(desktop->live.controls().limits.tip_force, 1.25);
  record_something();
  desktop->world.toggle_recording();
  ASSERT_TRUE(until([&] { return said("Recorded"); }));
  ASSERT_EQ(recordings().size(), 1u);
  EXPECT_NE(read_session(recordings()[0]).info.safety.find("tip_force = 1.25"), std::string::npos);
}

// The law follows the device's resolution; the setting for the virtual arm comes back afterwards.
TEST_F(ADesktop, TakesTheEncodersOfADeviceThatIsInTheLoop) {
  Parameters& p = desktop->settings.parameters();
  p.encoder_step = 2e-3;
  plug_in(3);
  const double step = test::pushing(3).resolution.front();
  EXPECT_EQ(p.encoder_step, step);
  p.encoder_step = 0;
  record_something();
  desktop->world.toggle_recording();
  ASSERT_TRUE(until([&] { return said("Recorded"); }));
  const Session session = read_session(recordings().at(0));
  Parameters recorded = session_parameters(session, "");
  for (const SettingChange& change : session.changes) {
    if (change.row == 0) apply_change(recorded, change);
  }
  EXPECT_EQ(recorded.encoder_step, step) << "however little is set";
  EXPECT_EQ(desktop->lead.settings_to_keep().parameters().encoder_step, 2e-3);
  desktop->world.close_device();
  EXPECT_EQ(p.encoder_step, 2e-3);
}

TEST_F(ADesktop, RemembersNothingOfADeviceThatAProgramHasSet) {
  desktop->devices.hub().use("device");
  desktop->devices.hub().notes("device").compensation.friction_share = 0.3;
  plug_in(3);
  Parameters& p = desktop->settings.parameters();
  ASSERT_EQ(p.friction_share, 0.3);
  desktop->lead.begin();
  p.friction_share = 0.9;
  p.encoder_step = 1e-3;
  desktop->lead.note_program();
  frames(5);
  EXPECT_EQ(desktop->devices.hub().notes("device").compensation.friction_share, 0.3);
  EXPECT_TRUE(desktop->lead.end(false));
  EXPECT_EQ(p.friction_share, 0.3);
  EXPECT_EQ(p.encoder_step, test::pushing(3).resolution.front());
  EXPECT_TRUE(said("Your settings are back."));
}

TEST_F(ADesktop, KeepsForTheNextStartWhatThePersonHasChosenWhileAProgramLeads) {
  Parameters& p = desktop->settings.parameters();
  desktop->settings.recent = {"/own.h5"};
  p.eta = 0.8;
  desktop->lead.begin();
  p.eta = 0.5;
  desktop->settings.recent = {"/a.h5", "/own.h5"};
  desktop->lead.note_program();
  p.hand_stiffness = 222;  // the person's setting
  desktop->lead.follow_person();
  const Settings kept = desktop->lead.settings_to_keep();
  EXPECT_EQ(kept.parameters().eta, 0.8);
  EXPECT_EQ(kept.parameters().hand_stiffness, 222);
  EXPECT_EQ(kept.recent, std::vector<std::string>{"/own.h5"});
  EXPECT_TRUE(desktop->lead.end(false));
  EXPECT_EQ(p.eta, 0.8);
  EXPECT_EQ(p.hand_stiffness, 222);
}

// A damping set for the virtual arm is not the device's: verdict and recording follow the loop's
// values.
TEST_F(ADesktop, JudgesAndRecordsARealDeviceByWhatTheLoopTakes) {
  Parameters& p = desktop->settings.parameters();
  plug_in(2);
  p.k_vc = 20;
  frames(2);
  const Analysis by_file = desktop->tuning.analysis();
  EXPECT_FALSE(by_file.condition3.holds);
  p.damping = 0.1;
  p.torque_limit = 5;
  frames(2);
  EXPECT_EQ(desktop->tuning.analysis().condition3.holds, by_file.condition3.holds);
  EXPECT_EQ(desktop->tuning.analysis().eta_min, by_file.eta_min);
  record_something();
  desktop->world.toggle_recording();
  ASSERT_TRUE(until([&] { return said("Recorded"); }));
  const Session session = read_session(recordings().at(0));
  Parameters recorded = session_parameters(session, "");
  EXPECT_TRUE(std::isnan(recorded.damping)) << "that of the file";
  EXPECT_TRUE(std::isnan(recorded.torque_limit));
  for (const SettingChange& change : session.changes) apply_change(recorded, change);
  EXPECT_TRUE(std::isnan(recorded.damping));
}

// Another device is chosen while the scene changed with the first one is not saved.
TEST_F(ADesktop, KeepsADevicesLimitsWhileItAsksWhatBecomesOfChanges) {
  desktop->devices.hub().use("device");
  desktop->devices.hub().notes("device").limits.tip_force = 1.25;
  desktop->world.add_object({"mine", Pose::Identity(), Sphere{0.01}, {500}});
  const auto wire = plug_in(2);  // sets the first scene aside
  desktop->world.add_object({"here", Pose::Identity(), Sphere{0.01}, {500}});
  ASSERT_TRUE(armed());
  desktop->devices.use("");
  EXPECT_TRUE(document().asking());
  EXPECT_TRUE(until([&] { return arming() == Arming::off; }));
  EXPECT_EQ(desktop->devices.hub().in_use(), "device");
  document().stay();
  ASSERT_TRUE(armed());
  frames(3);
  EXPECT_TRUE(loop().device_in_place());
  EXPECT_EQ(desktop->live.controls().limits.tip_force, 1.25);
  desktop->devices.use("");
  document().discard_and_leave();
  frames(3);
  EXPECT_FALSE(loop().device_in_place());
  EXPECT_EQ(desktop->devices.hub().in_use(), "");
  EXPECT_TRUE(has("mine"));
  EXPECT_TRUE(until([&] { return wire->closed == 1; }));
}

// A stranger's arm with links of a metre was opened before; the device has 3 N m.
TEST_F(ADesktop, TakesADeviceForABuiltInArmWhateverIsOpenUntilSomebodyHasSaidWhichItIs) {
  const fs::path file = dir / "long.urdf";
  std::string text = test::omni().urdf;
  for (std::size_t at = 0; (at = text.find("\"0.135 0 0\"", at)) != std::string::npos;) {
    text.replace(at, 11, "\"1 0 0\"");
  }
  for (std::size_t at = 0; (at = text.find("effort=\"0.", at)) != std::string::npos;) {
    text.replace(at, 10, "effort=\"9");
  }
  text.replace(text.find("name=\"omni\""), 11, "name=\"long\"");
  std::ofstream(file) << text;
  desktop->world.open_arm(file);
  ASSERT_TRUE(until([&] { return desktop->live.stage().arm().name == "long"; }));
  desktop->devices.hub().use("device");
  const auto open = [&] {
    desktop->world.open_device(std::make_unique<WiredDevice>(3, std::make_shared<Wire>(), 3));
    await_device();
    return desktop->live.stage().arm();
  };
  const ArmDescription first = open();
  EXPECT_EQ(first.urdf, test::omni().urdf);
  for (const Joint& joint : first.joints) EXPECT_LE(joint.effort, 0.5);
  EXPECT_TRUE(said("is used as the arm omni"));
  const NamedArm asked = desktop->world.arm_file();
  EXPECT_EQ(asked.file, file.string()) << "that the question offers";
  desktop->devices.hub().say_arm(asked.file, asked.tip, nullptr);
  const ArmDescription second = open();
  EXPECT_EQ(second.name, "long");
  for (const Joint& joint : second.joints) EXPECT_LE(joint.effort, 3) << "the device's own limit";
  EXPECT_TRUE(said("is used as the arm long"));
}

// The device is plugged in again with another full force, from changed settings.
TEST_F(ADesktop, TakesTheLimitsThatADeviceHasWhenItIsConnectedAnew) {
  desktop->devices.hub().use("device");
  desktop->devices.hub().say_arm(kBuiltInArm, "", nullptr);
  const auto efforts = [&] {
    std::vector<double> all;
    for (const Joint& joint : desktop->live.stage().arm().joints) all.push_back(joint.effort);
    return all;
  };
  const std::vector<double> of_file = efforts();
  const auto within = [&](double most) {
    std::vector<double> all = of_file;
    for (double& each : all) each = std::min(each, most);
    return all;
  };
  const std::string arm = desktop->live.stage().arm().urdf;
  for (const double effort : {0.2, 0.05, 0.4, 100.0, 0.1}) {
    const auto wire = std::make_shared<Wire>();
    desktop->world.open_device(std::make_unique<WiredDevice>(3, wire, effort));
    await_device();
    EXPECT_EQ(efforts(), within(effort)) << effort;
    EXPECT_EQ(desktop->live.stage().arm().urdf, arm);
    wire->angle = 0.3;  // the coupling pulls with the motors' full torque
    ASSERT_TRUE(armed());
    frames(80);
    EXPECT_LE(wire->torque, std::min(effort, *std::ranges::max_element(of_file)) + 1e-12);
    desktop->live.start_over();
    ASSERT_TRUE(until([&] { return arming() == Arming::off; }));
  }
}

TEST_F(ADesktop, ChangesNoDeviceInARecording) {
  record_something();
  desktop->devices.use("another");
  EXPECT_EQ(desktop->devices.hub().in_use(), "");
  EXPECT_TRUE(said("Stop the recording"));
}

}  // namespace
}  // namespace limpid
