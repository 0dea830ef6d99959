// The desktop without a window: its effects on the loop, on devices and on unsaved work.
#include "app/desktop/shell/desktop.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <set>
#include <thread>

#include "app/base/folders.h"
#include "app/desktop/base/first_steps.h"
#include "app/desktop/shell/commands.h"
#include "app/run/replay.h"
#include "core/dynamics/arm.h"
#include "tests/support/built_in.h"
#include "tests/support/computer.h"
#include "tests/support/device_traits.h"
#include "tests/support/faultless_context.h"
#include "tests/support/temp_dir.h"
#include "tests/support/test_session.h"
#include "tests/support/wired_device.h"

namespace limpid {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

using test::Wire;
using test::WiredDevice;

struct ADesktop : testing::Test {
  void SetUp() override {
    setenv("XDG_DATA_HOME", (dir / "data").c_str(), 1);
    setenv("XDG_CONFIG_HOME", (dir / "config").c_str(), 1);
    if (!test::has_offscreen_pictures()) GTEST_SKIP() << "no EGL here";
    context = std::make_unique<test::FaultlessContext>(64, 64);
    desktop = std::make_unique<Desktop>(Settings{}, AskForPriority{});
    desktop->world.open_given("", "", "");
    frames(3);
  }
  void TearDown() override {
    if (desktop) desktop->drop_pictures();
    desktop.reset();
  }
  void frames(int count) {
    for (int i = 0; i < count; ++i) {
      desktop->update(0.01);
      std::this_thread::sleep_for(10ms);
    }
  }
  template <class Done>
  bool until(Done done) {
    const auto end = std::chrono::steady_clock::now() + 20s;
    while (std::chrono::steady_clock::now() < end) {
      if (done()) return true;
      frames(1);
    }
    return done();
  }
  LiveLoop& loop() const { return desktop->live.loop(); }
  Document& document() const { return desktop->document; }
  Arming arming() const { return loop().snapshot().arming; }
  bool said(const std::string& what) const {
    return std::ranges::any_of(desktop->notices.all(), [&](const Notice& notice) {
      return notice.text.find(what) != std::string::npos;
    });
  }
  // Asks for force until it is on: on a busy computer the window may have been silent meanwhile.
  template <class Ask>
  bool until_on(Ask ask) {
    return until([&] {
      if (!desktop->live.force_armed()) {
        ask();
        frames(5);
      }
      return arming() == Arming::on;
    });
  }
  bool armed() {
    return until_on([&] { loop().arm(); });
  }
  // Waits for the loop's first tick with the device, without frames: a controller that did not
  // connect it gets no time.
  void await_device() {
    while (!loop().snapshot().connected) {
      std::this_thread::sleep_for(1ms);
      loop().update();
    }
  }
  std::shared_ptr<Wire> plug_in(int dof) {
    auto wire = std::make_shared<Wire>();
    desktop->world.open_device(std::make_unique<WiredDevice>(dof, wire));
    await_device();
    return wire;
  }
  // An armed device in the loop, pulled away from its proxy.
  std::shared_ptr<Wire> pushed() {
    auto wire = plug_in(3);
    EXPECT_TRUE(until([&] { return loop().snapshot().connected; }));
    wire->angle = 0.1;  // the coupling pulls it back
    EXPECT_TRUE(armed());
    return wire;
  }
  void run(const char* command) { EXPECT_EQ(run_command(command, *desktop), "") << command; }
  void record_something() {
    desktop->world.toggle_recording();
    ASSERT_TRUE(until([&] { return loop().snapshot().recording; }));
    frames(20);
  }
  std::vector<fs::path> recordings() const {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(dir / "data/limpid/sessions")) {
      files.push_back(entry.path());
    }
    return files;
  }
  bool has(const std::string& name) const {
    return std::ranges::any_of(document().editor().scene().objects,
                               [&](const Object& object) { return object.name == name; });
  }

  const test::TempDir dir;
  std::unique_ptr<test::FaultlessContext> context;
  std::unique_ptr<Desktop> desktop;
};

TEST_F(ADesktop, HasForceOnTheVirtualArmFromTheStart) {
  EXPECT_TRUE(until([&] { return arming() == Arming::on; }));
}

TEST_F(ADesktop, DoesNotArmWhenItStartsOver) {
  desktop->cut_force();
  ASSERT_TRUE(until([&] { return arming() == Arming::off; }));
  desktop->live.start_over();
  frames(80);
  EXPECT_EQ(arming(), Arming::off);
  desktop->toggle_force();
  EXPECT_TRUE(until([&] { return arming() == Arming::on; }));
}

TEST_F(ADesktop, LeavesARealDeviceOffWhateverElseIsDone) {
  const auto wire = plug_in(3);
  ASSERT_TRUE(loop().device_in_place());
  const auto expect_off = [&](const char* after) {
    frames(70);
    EXPECT_EQ(arming(), Arming::off) << after;
    EXPECT_EQ(wire->torque, 0) << after;
  };
  expect_off("plugging in");
  desktop->live.start_over();
  expect_off("starting over");
  desktop->tuning.next_law();
  document().undo();
  expect_off("undo");
  desktop->world.open_scene(fs::path(LIMPID_ASSETS_DIR) / "scenes/spheres.toml");
  ASSERT_TRUE(until([&] { return said("Scene:"); }));
  EXPECT_TRUE(loop().device_in_place()) << "the device stays in the loop";
  expect_off("another scene");
  desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  desktop->playback.start_rerun(desktop->settings.parameters());
  ASSERT_TRUE(until([&] { return desktop->playback.shown()->has_rerun(); }));
  expect_off("playback and re-run");
  desktop->playback.close();
  expect_off("going back to live");
}

// The scene that the device would push into is not on the screen then.
TEST_F(ADesktop, HasNoForceOnARealDeviceWhileARecordingIsShown) {
  const auto wire = pushed();
  desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  EXPECT_TRUE(until([&] { return arming() == Arming::off; }));
  EXPECT_EQ(wire->torque, 0);
  run("device.force");
  wire->buttons = 2;
  frames(70);
  EXPECT_EQ(arming(), Arming::off);
  EXPECT_TRUE(said("Go back to live"));
  wire->buttons = 0;
  desktop->playback.close();
  frames(5);
  EXPECT_TRUE(until_on([&] { run("device.force"); }));
}

TEST_F(ADesktop, TakesTheForceOfARealDeviceAwayBeforeAnythingChanges) {
  auto wire = pushed();
  desktop->live.start_over();
  EXPECT_TRUE(until([&] { return arming() == Arming::off; }));
  EXPECT_EQ(wire->torque, 0);
  wire->angle = 0;
  ASSERT_TRUE(armed());
  desktop->world.open_scene(fs::path(LIMPID_ASSETS_DIR) / "scenes/spheres.toml");
  ASSERT_TRUE(until([&] { return said("Scene:"); }));
  frames(70);
  EXPECT_EQ(arming(), Arming::off);
}

TEST_F(ADesktop, MakesNewScenesThatHaveFilesOfTheirOwnOnceTheyAreSaved) {
  const std::string last = desktop->settings.scene;
  for (const char* name : {"untitled.toml", "untitled-2.toml"}) {
    run("scene.new");
    EXPECT_TRUE(has("table top"));
    EXPECT_FALSE(document().editor().dirty());
    EXPECT_EQ(desktop->settings.scene, last) << "there is no file to open at the next start";
    const fs::path file = document().own_file();
    EXPECT_EQ(file.filename(), name);
    EXPECT_FALSE(fs::exists(file));
    ASSERT_TRUE(document().save_as(file));
    EXPECT_TRUE(fs::exists(file));
    EXPECT_EQ(std::exchange(desktop->settings.scene, last), file.string());
  }
  record_something();
  run("scene.new");
  EXPECT_TRUE(said("Stop the recording"));
  EXPECT_EQ(document().own_file().filename(), "untitled-2.toml");
}

// The writer knows objects, not comments beside them.
TEST_F(ADesktop, KeepsAFileWhoseCommentsItDoesNotWrite) {
  const fs::path file = dir / "mine.toml", kept = dir / "mine.toml~";
  ASSERT_TRUE(document().save_as(file));
  EXPECT_FALSE(fs::exists(kept)) << "there was nothing";
  ASSERT_TRUE(document().save_as(file));
  EXPECT_FALSE(fs::exists(kept)) << "there were no comments";
  std::ifstream in(file);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string mine = "# measured on Monday\n" + text + "# \"end\"\n";
  std::ofstream(file) << mine;
  ASSERT_TRUE(document().save_as(file));
  std::ifstream again(kept);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(again), {}), mine);
  EXPECT_TRUE(said("mine.toml~"));
}

// The tip rests in the box and touches it.
TEST_F(ADesktop, PicksUpWithTheMagnetAndLetsGoOfIt) {
  EXPECT_NE(run_command("hand.magnet", *desktop), "") << "a table cannot be picked up";
  const Vec3 tip = desktop->live.controls().goal;
  const fs::path file = dir / "die.toml";
  std::ofstream(file) << fmt::format(
      "tip_radius = 0.004\ngravity = [0, 0, 0]\n[[body]]\nname = \"die\"\n"
      "box = [0.02, 0.02, 0.02]\nmass = 0.02\nposition = [{}, {}, {}]\nmagnet = true\n",
      tip.x(), tip.y(), tip.z() - 0.0135);
  desktop->world.open_scene(file);
  ASSERT_TRUE(until([&] { return said("Scene:"); }));
  const auto held = [&] { return loop().layout().in(desktop->live.row(), Column::magnet)[0] == 1; };
  const CouplingKind law = desktop->settings.parameters().kind;
  run("hand.magnet");
  EXPECT_TRUE(until(held));
  run("hand.magnet");
  EXPECT_TRUE(until([&] { return !held(); }));
  desktop->pick_up_or_next_law();
  EXPECT_TRUE(until(held)) << "so does a device's first button";
  EXPECT_EQ(desktop->settings.parameters().kind, law);
  desktop->live.start_over();
  EXPECT_TRUE(until([&] { return !held(); }));
}

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

TEST_F(ADesktop, TakesAButtonForNothingThatIsHeldBeforeTheFirstReport) {
  auto wire = std::make_shared<Wire>();
  wire->buttons_known = 0;
  desktop->world.open_device(std::make_unique<WiredDevice>(3, wire));
  await_device();
  frames(120);  // longer than a device takes to settle
  wire->buttons = 2;
  wire->buttons_known = ~0u;
  frames(30);
  EXPECT_EQ(arming(), Arming::off);
}

TEST_F(ADesktop, TakesAButtonThatWasHeldWhilePluggingInForNothing) {
  auto wire = std::make_shared<Wire>();
  wire->buttons = 2;
  desktop->world.open_device(std::make_unique<WiredDevice>(3, wire));
  await_device();
  frames(120);  // longer than a device takes to settle
  EXPECT_EQ(arming(), Arming::off);
  wire->buttons = 0;
  frames(10);
  EXPECT_EQ(arming(), Arming::off);
  const auto press = [&] {
    wire->buttons = 0;
    frames(5);
    wire->buttons = 2;
    frames(5);
  };
  EXPECT_TRUE(until_on(press)) << "one that is pressed now arms";
  press();
  EXPECT_TRUE(until([&] { return !desktop->live.force_armed(); }));
}

TEST_F(ADesktop, SaysThatADeviceIsGoneAndClosesItBesideTheWindow) {
  const auto wire = pushed();
  frames(60);
  wire->here = false;
  EXPECT_TRUE(until([&] { return said("The device is disconnected"); }));
  EXPECT_EQ(arming(), Arming::tripped);
  EXPECT_TRUE(until([&] { return wire->closed == 1; }));
}

TEST_F(ADesktop, RecordsAndClosesTheFileBesideTheWindow) {
  for (int i = 0; i < 2; ++i) {
    record_something();
    desktop->world.toggle_recording();
    ASSERT_TRUE(until([&] { return said("Recorded"); }));
    desktop->notices.clear();
    std::this_thread::sleep_for(1100ms);  // file names have seconds
  }
  ASSERT_EQ(recordings().size(), 2u);
  for (const fs::path& file : recordings()) EXPECT_GT(read_session(file).size(), 100u);
}

TEST_F(ADesktop, CompletesARecordingWhenItEnds) {
  record_something();
  desktop->drop_pictures();
  desktop.reset();
  ASSERT_EQ(recordings().size(), 1u);
  EXPECT_EQ(recordings()[0].extension(), ".h5");
  EXPECT_GT(read_session(recordings()[0]).size(), 100u);
}

TEST_F(ADesktop, LeavesNothingBehindWhenItEndsBeforeARecordingBegan) {
  desktop->world.toggle_recording();
  desktop->drop_pictures();
  desktop.reset();
  EXPECT_TRUE(recordings().empty());
}

// Rows of another width must not go into the file.
TEST_F(ADesktop, CompletesARecordingWhenADeviceBringsAnotherArm) {
  record_something();
  plug_in(2);
  EXPECT_TRUE(until([&] { return said("Recorded"); }));
  frames(20);
  ASSERT_EQ(recordings().size(), 1u);
  const Session session = read_session(recordings()[0]);
  EXPECT_EQ(session.layout.dof(), 3);
  EXPECT_GT(session.size(), 100u);
  for (std::size_t k = 0; k < session.size(); ++k) {
    ASSERT_NEAR(session.at(k, Column::time)[0], 1e-3 * static_cast<double>(k), 1e-9);
  }
}

TEST_F(ADesktop, SaysThatItCannotRecordAndGoesOn) {
  fs::remove_all(dir / "data");
  std::ofstream(dir / "data") << "a file where a folder should be";
  desktop->world.toggle_recording();
  EXPECT_TRUE(
      until([&] { return !desktop->notices.all().empty() && desktop->notices.all().back().bad; }));
  EXPECT_FALSE(desktop->live.recording());
  const auto ticks = loop().status().ticks;
  EXPECT_TRUE(until([&] { return loop().status().ticks > ticks + 50; }));
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

// A program leads, as on the control socket.
TEST_F(ADesktop, CutsTheForceOfADeviceWhenAProgramHasEndedAndSettingsComeBack) {
  Parameters& p = desktop->settings.parameters();
  p.eta = 0.8;
  pushed();
  desktop->lead.begin();
  p.eta = 0.5;
  p.torque_limit = 0.1;
  desktop->lead.note_program();
  frames(3);
  ASSERT_TRUE(armed());
  EXPECT_TRUE(desktop->lead.end(true));
  EXPECT_EQ(p.eta, 0.8);
  EXPECT_TRUE(std::isnan(p.torque_limit)) << "the arm's own";
  EXPECT_TRUE(until([&] { return arming() == Arming::off; })) << "before it may push harder";
  EXPECT_TRUE(said("The study has ended. Your settings are back."));
}

TEST_F(ADesktop, LeavesTheForceWhereAProgramThatHasEndedLeftAllAsItWas) {
  pushed();
  desktop->lead.begin();
  desktop->lead.note_program();
  ASSERT_TRUE(armed());
  EXPECT_TRUE(desktop->lead.end(false));
  frames(5);
  EXPECT_EQ(arming(), Arming::on);
  EXPECT_FALSE(said("Your settings are back."));
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

TEST_F(ADesktop, GoesBackToTheSceneWhenWhatIsRecordedIsComplete) {
  const std::string scene = document().file();
  desktop->lead.begin_elsewhere();
  desktop->world.open_scene(data_dir() / "assets/scenes/spheres.toml");
  ASSERT_TRUE(until([&] { return document().file() != scene; }));
  EXPECT_TRUE(has("rubber"));
  desktop->lead.note_program();
  EXPECT_TRUE(desktop->lead.settings_to_keep().scene.empty());
  record_something();
  EXPECT_FALSE(desktop->lead.end(false)) << "what is recorded stays one run";
  EXPECT_NE(document().file(), scene);
  desktop->world.toggle_recording();
  ASSERT_TRUE(until([&] { return desktop->lead.end(false); }));
  EXPECT_EQ(document().file(), scene);
  EXPECT_TRUE(desktop->settings.scene.empty());
  EXPECT_FALSE(has("rubber"));
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

TEST_F(ADesktop, WritesBesideTheWindowAndSaysWhatBecameOfIt) {
  std::atomic<bool> elsewhere{false};
  desktop->live.save_beside([&, window = std::this_thread::get_id()] {
    elsewhere = std::this_thread::get_id() != window;
    return PlotNotice{"Saved a table"};
  });
  desktop->live.save_beside([] { return PlotNotice{"No room for a table", true}; });
  ASSERT_TRUE(until([&] { return said("No room for a table"); }));
  EXPECT_TRUE(said("Saved a table"));
  EXPECT_TRUE(elsewhere);
  EXPECT_TRUE(desktop->notices.all().back().bad);
}

// A real device is not armed by somebody who sees a recording; that is said as a warning.
TEST_F(ADesktop, ArmsNoRealDeviceOverARecording) {
  const auto wire = plug_in(3);
  ASSERT_TRUE(until([&] { return loop().snapshot().connected; }));
  desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  ASSERT_TRUE(loop().device_in_place());
  desktop->notices.clear();
  desktop->toggle_force();
  ASSERT_FALSE(desktop->notices.all().empty());
  EXPECT_THAT(desktop->notices.all().back().text, testing::HasSubstr("Go back to live"));
  EXPECT_TRUE(desktop->notices.all().back().bad);
  EXPECT_FALSE(desktop->live.force_armed());
  frames(30);
  EXPECT_EQ(arming(), Arming::off);
  EXPECT_EQ(wire->torque, 0);
}

TEST_F(ADesktop, ChangesNoDeviceInARecording) {
  record_something();
  desktop->devices.use("another");
  EXPECT_EQ(desktop->devices.hub().in_use(), "");
  EXPECT_TRUE(said("Stop the recording"));
}

TEST_F(ADesktop, OffersToPlayWhatItHasRecovered) {
  const fs::path sessions = dir / "data/limpid/sessions";
  fs::create_directories(sessions);
  const RunPlan plan = test::plan("table.toml", "touch.csv", 5);
  {
    // The recording is never finished.
    Recorder cut(sessions / "cut.h5", session_info(plan), Parameters{}, false);
    simulate(plan, {},
             [&](std::span<const double> row, LaneChanges) { return cut.push_waiting(row); });
  }
  ASSERT_TRUE(fs::exists(sessions / "cut.h5.part"));
  desktop->playback.recover_leftovers(sessions);
  EXPECT_EQ(desktop->playback.last(), sessions / "cut.h5");
  ASSERT_EQ(desktop->banners().size(), 1u);
  EXPECT_THAT(desktop->banners()[0].text, testing::HasSubstr("Recovered cut.h5"));
  run("session.play");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  EXPECT_EQ(desktop->playback.shown()->file(), sessions / "cut.h5");
  EXPECT_TRUE(desktop->playback.recovered().empty()) << "it was played";
}

TEST_F(ADesktop, SaysThatALeftoverHasNothingToRecover) {
  const fs::path sessions = dir / "data/limpid/sessions";
  fs::create_directories(sessions);
  RunPlan plan;
  plan.arm = test::omni();
  plan.hand.source = "mouse";
  // The recording is never finished.
  Recorder(sessions / "cut.h5", session_info(plan), Parameters{}, false);
  desktop->playback.recover_leftovers(sessions);
  EXPECT_TRUE(said("nothing was recorded"));
  EXPECT_FALSE(fs::exists(sessions / "cut.h5"));
}

TEST_F(ADesktop, KeepsChangesOfTheSceneWhenADeviceComesAndGoes) {
  desktop->world.add_object({"mine", Pose::Identity(), Sphere{0.01}, {500}});
  ASSERT_TRUE(document().editor().dirty());
  plug_in(3);
  EXPECT_TRUE(has("mine"));
  EXPECT_TRUE(document().editor().dirty());
  desktop->world.close_device();
  EXPECT_FALSE(loop().device_in_place());
  EXPECT_TRUE(has("mine"));
  EXPECT_TRUE(document().editor().dirty());
}

TEST_F(ADesktop, PutsASceneAsideForADeviceThatReachesNothingOfIt) {
  const std::string file = document().file();
  desktop->world.add_object({"mine", Pose::Identity(), Sphere{0.01}, {500}});
  plug_in(2);
  EXPECT_FALSE(has("mine"));
  EXPECT_NE(document().file(), file);
  ASSERT_NE(document().unsaved_set_aside(), nullptr);
  desktop->world.close_device();
  EXPECT_TRUE(has("mine"));
  EXPECT_TRUE(document().editor().dirty());
  EXPECT_EQ(document().file(), file);
  EXPECT_EQ(document().unsaved_set_aside(), nullptr);
}

// Only the user's scene is set aside, not one that came with a device.
TEST_F(ADesktop, KeepsTheSceneThatWasPutAsideFromOneDeviceToTheNext) {
  const std::string file = document().file();
  desktop->world.add_object({"mine", Pose::Identity(), Sphere{0.01}, {500}});
  plug_in(2);
  plug_in(3);
  desktop->world.close_device();
  EXPECT_TRUE(has("mine"));
  EXPECT_TRUE(document().editor().dirty());
  EXPECT_EQ(document().file(), file);
}

// An arm of four joints and a scene with a stop at the fourth. A device sets both aside, and the
// arm's file has changed when they are to come back.
struct ADesktopWithFourJoints : ADesktop {
  void expect_both_back(const std::function<void(const fs::path&)>& spoil);
};

void ADesktopWithFourJoints::expect_both_back(const std::function<void(const fs::path&)>& spoil) {
  const fs::path file = dir / "four.urdf";
  std::string text = test::omni().urdf;
  const std::string end = "</robot>";
  const auto tip = text.find("<joint name=\"tip\" type=\"fixed\">");
  text.replace(tip, 33,
               "<joint name=\"tip\" type=\"revolute\"><axis xyz=\"0 1 0\"/>"
               "<limit lower=\"-1\" upper=\"1\" effort=\"0.1\" velocity=\"10\"/>");
  const auto link = text.find("<link name=\"tip\"/>");
  ASSERT_NE(link, std::string::npos);
  text.replace(link, 18,
               "<link name=\"tip\"><inertial><mass value=\"0.01\"/><inertia ixx=\"1e-5\" "
               "iyy=\"1e-5\" izz=\"1e-5\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>");
  std::ofstream(file) << text;
  desktop->world.open_arm(file);
  ASSERT_TRUE(until([&] { return desktop->live.stage().arm().dof() == 4; }));
  desktop->world.add_object({"mine", Pose::Identity(), Sphere{0.01}, {500}});
  desktop->world.add_object({.name = "stop", .shape = JointStop{.joint = 3, .angle = 0.5}});
  ASSERT_TRUE(has("stop"));
  plug_in(2);
  ASSERT_FALSE(has("mine"));
  spoil(file);
  bool told = false;
  desktop->world.close_device([&] { told = true; });
  frames(3);
  EXPECT_TRUE(told);
  EXPECT_FALSE(loop().device_in_place());
  EXPECT_EQ(desktop->live.stage().arm().dof(), 4);
  EXPECT_TRUE(has("mine"));
  EXPECT_TRUE(has("stop"));
  EXPECT_TRUE(document().editor().dirty());
  EXPECT_TRUE(loop().status().running);
}

TEST_F(ADesktopWithFourJoints, KeepsArmAndSceneThatWerePutAsideWhenTheArmsFileIsGone) {
  expect_both_back([](const fs::path& file) { fs::remove(file); });
}

TEST_F(ADesktopWithFourJoints, KeepsArmAndSceneThatWerePutAsideWhenTheFileHasAnotherArm) {
  expect_both_back([](const fs::path& file) { std::ofstream(file) << test::omni().urdf; });
}

TEST_F(ADesktop, KeepsASceneWhoseFileHasVanished) {
  const fs::path file = dir / "scene.toml";
  desktop->world.add_object({"saved", Pose::Identity(), Sphere{0.01}, {500}});
  ASSERT_TRUE(document().save_as(file));
  desktop->world.add_object({"mine", Pose::Identity(), Sphere{0.01}, {500}});
  fs::remove(file);
  plug_in(3);
  desktop->world.close_device();
  EXPECT_TRUE(has("saved"));
  EXPECT_TRUE(has("mine"));
  EXPECT_TRUE(document().editor().dirty());
}

TEST_F(ADesktop, MarksAChangeWhereItActsHoweverLongAFrameTakes) {
  frames(10);
  desktop->tuning.next_law();
  std::this_thread::sleep_for(250ms);  // a slow frame at high quality
  frames(20);
  const History& history = desktop->live.stage().history;
  const int kind = static_cast<int>(Channel::kind);
  SampleIndex first = history.end() - 1;
  const float now = history.value(kind, first);
  while (first > history.first() && history.value(kind, first - 1) == now) --first;
  ASSERT_FALSE(history.marks().empty());
  const PlotMark& mark = history.marks().back();
  EXPECT_EQ(mark.key, "coupling.kind");
  EXPECT_NEAR(mark.time, history.time(first), 0.05);
}

TEST_F(ADesktop, KeepsAMarkInTheRecordingAtTheTimeThatThePlotsShow) {
  record_something();
  frames(3);
  std::vector<double> shown;  // [s]
  const auto mark = [&] {
    std::this_thread::sleep_for(150ms);  // the loop is further than the plots
    const History& history = desktop->live.stage().history;
    shown.push_back(history.end_time() - history.offset());
    desktop->live.note(desktop->live.now(), "here");
    frames(5);
  };
  mark();
  mark();
  desktop->world.toggle_recording();
  ASSERT_TRUE(until([&] { return said("Recorded"); }));
  const Session session = read_session(recordings()[0]);
  ASSERT_EQ(session.marks.size(), 2u);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const double kept = session.at(session.marks[i].tick, Column::time)[0];
    EXPECT_NEAR(kept, shown[i], session.info.tick / 2);
  }
}

TEST_F(ADesktop, CountsTheMarksOfEachRecordingAnew) {
  const auto mark = [&] {
    desktop->marking.begin();
    const std::string offered = desktop->marking.text();
    desktop->marking.accept(offered);
    frames(3);
    return offered;
  };
  EXPECT_EQ(mark(), "mark 1");
  for (int recording = 0; recording < 2; ++recording) {
    record_something();
    frames(3);
    EXPECT_EQ(mark(), "mark 1");
    EXPECT_EQ(mark(), "mark 2");
    desktop->world.toggle_recording();
    ASSERT_TRUE(until([&] { return said("Recorded"); }));
    desktop->notices.clear();
  }
  EXPECT_EQ(mark(), "mark 6") << "in the plots alone";
}

TEST_F(ADesktop, RunsLanesWhoseSettingsAreTheirOwnAndWhoseWorldIsNot) {
  frames(5);
  LaneSettings& lanes = desktop->settings.lanes;
  run("session.twin");
  run("session.add_run");
  EXPECT_NE(run_command("session.add_run", *desktop), "") << "three are the most";
  frames(20);
  EXPECT_EQ(desktop->shown.rows().size(), 3u);
  std::set<CouplingKind> kinds;
  for (const Parameters& p : lanes.parameters) kinds.insert(p.kind);
  EXPECT_EQ(kinds.size(), kMostLanes) << "each has a law of its own at first";
  for (std::size_t lane = 1; lane < kMostLanes; ++lane) {
    lanes.edited = lane;
    EXPECT_EQ(&desktop->tuning.edited(), &lanes.parameters[lane]);
    const LaneParameters before = lanes.parameters;
    desktop->tuning.next_law();
    for (std::size_t i = 0; i < kMostLanes; ++i) {
      EXPECT_EQ(lanes.parameters[i].kind != before[i].kind, i == lane);
    }
  }
  desktop->settings.parameters().hand_stiffness = 432;
  frames(20);
  const RunNames& names = desktop->live.stage().names();
  EXPECT_TRUE(names.beside);
  ASSERT_EQ(names.laws.size(), kMostLanes);
  for (std::size_t i = 0; i < kMostLanes; ++i) {
    EXPECT_EQ(lanes.parameters[i].hand_stiffness, 432);
    EXPECT_EQ(names.law(i), static_cast<int>(lanes.parameters[i].kind));
    const RowLayout& layout = desktop->live.loop().layout();
    EXPECT_EQ(layout.in(desktop->shown.rows()[i], Column::kind)[0],
              static_cast<double>(lanes.parameters[i].kind));
  }
  run("session.drop_run");
  frames(20);
  EXPECT_EQ(desktop->shown.rows().size(), 2u);
  EXPECT_EQ(&desktop->tuning.edited(), &desktop->settings.parameters());
  run("session.twin");
  frames(20);
  EXPECT_EQ(desktop->shown.rows().size(), 1u);
  EXPECT_FALSE(desktop->live.stage().names().several());
  EXPECT_NE(run_command("session.drop_run", *desktop), "") << "one is left";
}

// A first step is done once its thing was done; settings of broken passivity are nobody's choice.
TEST_F(ADesktop, NotesEachFirstStepThatWasDone) {
  const auto steps = [&] {
    std::vector<FirstStep> all;
    for (const FirstStepInfo& each : kFirstSteps) {
      if (done(desktop->settings, each.step)) all.push_back(each.step);
    }
    return all;
  };
  using testing::ElementsAre;
  EXPECT_THAT(steps(), testing::IsEmpty());
  desktop->tuning.break_passivity();
  frames(3);
  document().undo();
  frames(3);
  EXPECT_THAT(steps(), testing::IsEmpty());
  run("session.twin");
  frames(3);
  EXPECT_THAT(steps(), ElementsAre(FirstStep::twin));
  run("session.twin");
  frames(3);
  desktop->tuning.next_law();
  frames(3);
  EXPECT_THAT(steps(), ElementsAre(FirstStep::law, FirstStep::twin));
  desktop->settings.parameters().eta = 0.77;
  frames(3);
  EXPECT_THAT(steps(), ElementsAre(FirstStep::law, FirstStep::eta, FirstStep::twin));
  desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  desktop->playback.shown()->player().play();
  frames(3);
  EXPECT_THAT(steps(),
              ElementsAre(FirstStep::law, FirstStep::eta, FirstStep::twin, FirstStep::play));
}

TEST_F(ADesktop, TakesBackAPresetOfAnyLane) {
  frames(5);
  LaneSettings& lanes = desktop->settings.lanes;
  for (std::size_t lane = 0; lane < kMostLanes; ++lane) {
    if (lane > 0) run("session.add_run");
    frames(5);
    lanes.edited = lane;
    const LaneParameters before = lanes.parameters;
    desktop->tuning.use_preset("Light hand");
    const Parameters& edited = lanes.parameters[lane];
    EXPECT_EQ(edited.eta, 0.3);
    EXPECT_EQ(edited.kind, CouplingKind::predictive);
    frames(5);
    desktop->document.undo();
    EXPECT_EQ(lanes.parameters, before);
    frames(5);
    desktop->document.redo();
    EXPECT_EQ(edited.eta, 0.3);
    frames(5);
  }
}

TEST_F(ADesktop, RunsCommandsByTheirIdsAndSaysWhyOneCannotBeRun) {
  run("view.ghost");
  EXPECT_FALSE(desktop->settings.show_ghost);
  EXPECT_FALSE(find_command("view.ghost")->how.checked(*desktop));
  EXPECT_EQ(run_command("view.gost", *desktop), "There is no command \"view.gost\".");
  EXPECT_EQ(run_command("session.rerun", *desktop), "Open a recording first (Ctrl+O).");
  EXPECT_EQ(run_command("scene.remove", *desktop), "Select an object of the scene first (Tab).");
  run_or_say("session.back_to_live", *desktop);
  EXPECT_TRUE(said("Open a recording first"));
  run("session.open");
  EXPECT_EQ(desktop->dialog.name(), "open session");
  EXPECT_THROW(desktop->dialog.open("a dialog"), std::logic_error);
  desktop->dialog.close();
  record_something();
  EXPECT_THAT(run_command("session.twin", *desktop), testing::HasSubstr("Stop the recording"));
  EXPECT_EQ(desktop->settings.lanes.count, 1u);
}

// A desktop with ImGui, whose menus and text fields may use Esc.
struct ADesktopWithKeys : ADesktop {
  void SetUp() override {
    ImGui::CreateContext();
    ADesktop::SetUp();
  }
  void TearDown() override {
    ADesktop::TearDown();
    ImGui::DestroyContext();
  }
  bool stays(Arming wanted) {
    frames(20);
    return arming() == wanted;
  }
};

TEST_F(ADesktopWithKeys, OnTheVirtualArmEscClosesWhatIsOpenAndOnlyThenCutsTheForce) {
  ASSERT_TRUE(until([&] { return arming() == Arming::on; }));
  for (const char* dialog : {"help", "sweep", "open session", "identify"}) {
    desktop->dialog.open(dialog);
    desktop->escape();
    EXPECT_EQ(desktop->dialog.name(), "");
    EXPECT_TRUE(stays(Arming::on)) << dialog;
  }
  ImGui::GetIO().WantTextInput = true;  // a number is being typed over a slider
  ImGui::GetCurrentContext()->WantTextInputNextFrame = 1;
  ImGui::GetCurrentContext()->ActiveId = 1;
  ASSERT_TRUE(desktop->focus().text);
  desktop->escape();
  EXPECT_TRUE(stays(Arming::on)) << "ImGui gives the typing up";
  ImGui::GetIO().WantTextInput = false;
  ImGui::GetCurrentContext()->WantTextInputNextFrame = -1;
  ImGui::GetCurrentContext()->ActiveId = 0;
  desktop->document.editor().select(0);
  desktop->escape();
  EXPECT_FALSE(desktop->document.editor().selected());
  EXPECT_TRUE(stays(Arming::on)) << "the object is let go of";
  desktop->escape();
  EXPECT_TRUE(until([&] { return arming() == Arming::off; }));
}

TEST_F(ADesktopWithKeys, OnARealDeviceEscClosesAndCutsTheForce) {
  const auto wire = pushed();
  desktop->dialog.open("help");
  desktop->escape();
  EXPECT_EQ(desktop->dialog.name(), "");
  EXPECT_TRUE(until([&] { return arming() == Arming::off; }));
  EXPECT_EQ(wire->torque, 0);
  ASSERT_TRUE(armed());
  desktop->escape();
  EXPECT_TRUE(until([&] { return arming() == Arming::off; }));
  ASSERT_TRUE(armed());
  desktop->document.editor().select(0);
  desktop->escape();
  EXPECT_TRUE(until([&] { return arming() == Arming::off; })) << "with an object selected, too";
  EXPECT_EQ(wire->torque, 0);
}

TEST_F(ADesktopWithKeys, SpaceCutsTheForceThroughADialogAndLeavesItOpen) {
  ASSERT_TRUE(until([&] { return arming() == Arming::on; }));
  desktop->dialog.open("help");
  desktop->cut_force();
  EXPECT_TRUE(until([&] { return arming() == Arming::off; }));
  EXPECT_EQ(desktop->dialog.name(), "help");
}

TEST_F(ADesktop, SaysOverThePictureThatThereIsNoForceAndWhy) {
  ASSERT_TRUE(until([&] { return arming() == Arming::on; }));
  EXPECT_TRUE(desktop->banners().empty());
  desktop->cut_force();
  ASSERT_TRUE(until([&] { return arming() == Arming::off; }));
  ASSERT_EQ(desktop->banners().size(), 1u);
  EXPECT_EQ(desktop->banners()[0].text, "Force is off: not armed. Key F switches the force on.");
  ASSERT_EQ(desktop->banners()[0].buttons.size(), 1u);
  EXPECT_STREQ(desktop->banners()[0].buttons[0].command, "device.force");
  record_something();
  EXPECT_EQ(desktop->banners()[0].text,
            "Recording without force: not armed. Key F switches the force on.");
  EXPECT_TRUE(desktop->banners()[0].bad);
  desktop->world.toggle_recording();
  ASSERT_TRUE(until([&] { return said("Recorded"); }));
  // Playback of the recording shows it, in any state of the loop.
  ASSERT_TRUE(armed());
  EXPECT_TRUE(desktop->banners().empty());
  run("session.play");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  ASSERT_EQ(desktop->banners().size(), 1u);
  EXPECT_EQ(desktop->banners()[0].text, "In this recording: force off: not armed.");
  EXPECT_TRUE(desktop->banners()[0].buttons.empty());
}

// The map of a sweep takes the whole window: banners over the picture wait until it closes.
TEST_F(ADesktop, SaysNothingOverADialogThatHasTheWholeWindow) {
  ASSERT_TRUE(until([&] { return arming() == Arming::on; }));
  desktop->cut_force();
  ASSERT_TRUE(until([&] { return arming() == Arming::off; }));
  for (const auto& [dialog, banners] : {std::pair("sweep", 0u), {"help", 1u}, {"gallery", 1u}}) {
    desktop->dialog.open(dialog);
    EXPECT_EQ(desktop->banners().size(), banners) << dialog;
  }
  desktop->dialog.close();
  EXPECT_EQ(desktop->banners().size(), 1u);
}

// The banner of a chattering wall offers two ways out.
TEST_F(ADesktop, SaysWhichWallChattersUnderWhichLawAndMendsIt) {
  Controls& controls = desktop->live.controls();
  const auto chatters = [&] {
    desktop->settings.parameters().kind = CouplingKind::proposed;
    desktop->settings.parameters().eta = 1;
    Object table = document().scene().objects[0];
    table.material.stiffness = 5000;
    document().editor().set(0, table, "stiffness");
    controls.goal = Vec3(0.2, 0, 0);
    controls.grab = true;
    frames(50);
    for (int i = 1; i <= 100; ++i) {
      controls.goal.z() = -0.045 * i / 100;
      frames(1);
    }
    return until([&] { return desktop->chatter.found().has_value(); });
  };
  ASSERT_EQ(document().scene().objects[0].name, "table top");
  EXPECT_TRUE(desktop->banners().empty());
  for (const char* way : {"coupling.mend_chatter", "scene.soften_wall"}) {
    ASSERT_TRUE(chatters()) << way;
    const std::vector<Banner> banners = desktop->banners();
    ASSERT_FALSE(banners.empty());
    const Banner& banner = banners.back();
    EXPECT_TRUE(banner.bad);
    EXPECT_EQ(
        banner.text,
        "The loop chatters, because table top (5000 N/m) is stiffer than the proposed law can "
        "render there without chatter.");
    ASSERT_EQ(banner.buttons.size(), 3u);
    EXPECT_EQ(banner.buttons[0].label, "Predictive");
    // The stiffness is that of `analyze` for the built-in arm, in two digits.
    EXPECT_EQ(banner.buttons[1].label, "Soften the wall to 1500 N/m");
    run(way);
    EXPECT_FALSE(desktop->chatter.found());
    const bool softened = std::string(way) == "scene.soften_wall";
    EXPECT_EQ(document().scene().objects[0].material.stiffness, softened ? 1500 : 5000);
    EXPECT_EQ(desktop->settings.parameters().kind,
              softened ? CouplingKind::proposed : CouplingKind::predictive);
    frames(150);
    EXPECT_FALSE(desktop->chatter.found()) << "it is mended: " << way;
    controls.grab = false;
  }
}

// The loop's last ticks are those of passivity broken on purpose, which no law is to blame for.
TEST_F(ADesktop, BlamesNoLawForPassivityThatWasBrokenOnPurpose) {
  Controls& controls = desktop->live.controls();
  controls.goal = Vec3(0.2, 0, 0.04);
  controls.grab = true;
  frames(50);
  desktop->tuning.break_passivity();
  const RowLayout& layout = desktop->live.stage().channels().layout();
  ASSERT_TRUE(until([&] { return layout.in(desktop->live.row(), Column::energy_total)[0] > 0.1; }));
  desktop->tuning.end_break();
  for (int i = 0; i < 120; ++i) {
    frames(1);
    ASSERT_FALSE(desktop->chatter.found()) << "frame " << i << " after the repair";
  }
}

// After any further action the settings are the former ones.
TEST_F(ADesktop, PutsEverythingBackWhenBrokenPassivityEnds) {
  Settings& settings = desktop->settings;
  settings.parameters().hand_stiffness = 222;
  settings.parameters().eta = 0.8;
  frames(2);
  const Parameters before = settings.parameters();
  const auto broken = [&] {
    desktop->tuning.break_passivity();
    frames(2);
    EXPECT_EQ(settings.parameters().hand_stiffness, 3000);
    EXPECT_EQ(settings.parameters().hand_damping, 0);
    EXPECT_STREQ(desktop->banners().back().buttons.at(0).command, "coupling.end_break");
  };
  const auto expect_whole = [&](const char* after) {
    EXPECT_TRUE(settings.parameters() == before) << after;
    EXPECT_FALSE(settings.before_break) << after;
  };
  broken();
  desktop->tuning.end_break();
  expect_whole("Repair");
  broken();
  desktop->tuning.next_law();
  expect_whole("C");
  broken();
  document().undo();
  expect_whole("Ctrl+Z");
  frames(2);
  broken();
  desktop->tuning.use_preset("Light hand");
  EXPECT_EQ(settings.parameters().hand_stiffness, 222);
  frames(2);
  document().undo();
  expect_whole("a preset, and what was before it");
  frames(2);
  broken();
  settings.parameters().kind = CouplingKind::standard;  // by a click on the law
  frames(2);
  EXPECT_EQ(settings.parameters().kind, CouplingKind::standard);
  settings.parameters().kind = before.kind;
  frames(2);
  expect_whole("another law");
  broken();
  desktop->world.open_scene(fs::path(LIMPID_ASSETS_DIR) / "scenes/spheres.toml");
  ASSERT_TRUE(until([&] { return said("Scene:"); }));
  expect_whole("another scene");
  broken();
  desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  frames(1);
  EXPECT_TRUE(settings.parameters() == before) << "a recording";
  desktop->playback.close();
  broken();
  plug_in(3);
  EXPECT_EQ(settings.parameters().hand_stiffness, 222) << "a device";
  desktop->world.close_device();
  frames(2);
  broken();
  EXPECT_EQ(desktop->lead.settings_to_keep().parameters().hand_stiffness, 222) << "the next start";
  EXPECT_EQ(desktop->lead.settings_to_keep().parameters().eta, 0.8);
  EXPECT_FALSE(desktop->lead.settings_to_keep().before_break);
}

TEST_F(ADesktop, CountsBrokenPassivityAsNoStepOfUndo) {
  frames(2);
  const Parameters first = desktop->settings.parameters();
  desktop->tuning.edited().eta = 0.77;
  frames(60);  // a separate step of undo
  desktop->tuning.break_passivity();
  frames(5);
  desktop->tuning.edited().eta = 0.2;  // changed meanwhile
  frames(60);
  document().undo();
  EXPECT_EQ(desktop->tuning.edited().eta, 0.77);
  frames(5);
  document().undo();
  EXPECT_TRUE(desktop->settings.parameters() == first);
}

TEST_F(ADesktop, ShowsARecordingsOwnSettingsAtTheRowThatIsShown) {
  Settings& settings = desktop->settings;
  settings.parameters().kind = CouplingKind::proposed;
  settings.parameters().eta = 0.9;
  frames(3);
  record_something();
  settings.parameters().eta = 0.5;
  frames(20);
  settings.parameters().kind = CouplingKind::standard;
  frames(20);
  desktop->world.toggle_recording();
  ASSERT_TRUE(until([&] { return said("Recorded"); }));
  settings.parameters().eta = 0.2;
  settings.parameters().hand_stiffness = 99;
  frames(3);
  run("session.play");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  PlayedSession& session = *desktop->playback.shown();
  Player& player = session.player();
  player.pause();
  const auto at = [&](double part) -> const Parameters& {
    player.seek(part * player.duration());
    return session.settings();
  };
  // Settings agree with the rows, forwards and backwards.
  for (const double part : {0.0, 0.3, 0.5, 0.7, 0.99, 0.5, 0.1, 0.8}) {
    const Parameters& then = at(part);
    const auto row = player.row();
    const RowLayout& layout = player.session().layout;
    EXPECT_EQ(static_cast<double>(then.kind), layout.in(row, Column::kind)[0]) << part;
    EXPECT_EQ(then.eta, layout.in(row, Column::eta)[0]) << part;
    EXPECT_EQ(then.hand_stiffness, Parameters{}.hand_stiffness);
  }
  EXPECT_EQ(at(0).eta, 0.9);
  EXPECT_EQ(at(0.99).kind, CouplingKind::standard);
  EXPECT_EQ(desktop->tuning.edited().eta, 0.9) << "the re-run begins as the recording did";
  frames(3);
  EXPECT_TRUE(desktop->tuning.analysis().above_eta_min) << "of the re-run";
  run("session.back_to_live");
  frames(3);
  EXPECT_EQ(desktop->tuning.edited().eta, 0.2);
  EXPECT_FALSE(desktop->tuning.analysis().above_eta_min) << "of the live loop again";
}

TEST_F(ADesktop, NamesTheRunsOfARecordedTwinAsTheyAreAtTheCursor) {
  run("session.twin");
  desktop->settings.parameters().kind = CouplingKind::standard;
  desktop->settings.lanes.parameters[kTwinLane].kind = CouplingKind::tank;
  frames(20);
  record_something();
  desktop->settings.parameters().kind = CouplingKind::proposed;
  frames(30);
  desktop->world.toggle_recording();
  ASSERT_TRUE(until([&] { return said("Recorded"); }));
  desktop->playback.open(recordings().at(0));
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  PlayedSession& played = *desktop->playback.shown();
  const auto laws_at = [&](double time) {
    played.player().seek(time);
    frames(1);
    return played.stage().names().laws;
  };
  using enum CouplingKind;
  const int second = static_cast<int>(tank);
  EXPECT_EQ(laws_at(0), (std::vector{static_cast<int>(standard), second}));
  EXPECT_EQ(laws_at(played.player().duration()), (std::vector{static_cast<int>(proposed), second}));
  EXPECT_EQ(laws_at(0), (std::vector{static_cast<int>(standard), second}));
}

TEST_F(ADesktop, OffersASceneThatWasKeptUntilItIsTakenOrNot) {
  const fs::path folder = dir / "kept";
  const auto keep = [&](const std::string& ball) {
    SceneDocument document;
    document.scene.add({ball, pose_at({0.1, 0, 0}), Sphere{0.02}});
    keep_unsaved(document, test::omni(), "mine", folder);
    return take_unsaved(folder);
  };
  std::vector<fs::path> files = keep("first");
  for (const fs::path& file : keep("second")) files.push_back(file);
  ASSERT_EQ(files.size(), 2u);
  ASSERT_TRUE(until([&] { return desktop->banners().empty(); }));  // the force is on
  desktop->kept.offer(files);
  ASSERT_EQ(desktop->banners().size(), 1u);
  EXPECT_NE(desktop->banners()[0].text.find(files[1].filename().string()), std::string::npos);
  run("scene.discard_kept");
  EXPECT_FALSE(fs::exists(files[1]));
  ASSERT_EQ(desktop->banners().size(), 1u);
  run("scene.open_kept");
  ASSERT_TRUE(until([&] { return has("first"); }));
  EXPECT_TRUE(fs::exists(files[0]));
  EXPECT_TRUE(until([&] { return desktop->banners().empty(); }));
}

TEST_F(ADesktop, ShowsTheChosenPlotsLiveAndInPlayback) {
  desktop->plots.add();
  desktop->settings.plot_choices.back() = {.kind = PlotKind::spectrum,
                                           .channels = {"hand/torque_norm"}};
  frames(3);
  ASSERT_EQ(desktop->shown.stage().plots.size(), 5u);
  EXPECT_EQ(desktop->dialog.name(), "plot");
  desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  frames(2);
  ASSERT_EQ(desktop->shown.stage().plots.size(), 5u);
  EXPECT_EQ(desktop->shown.stage().plots.back().spec().title, "spectrum of |f1|");
  desktop->plots.remove(0);
  desktop->plots.use("As at first");
  frames(2);
  EXPECT_EQ(desktop->shown.stage().plots.size(), 4u);
  EXPECT_EQ(desktop->dialog.name(), "");
}

TEST_F(ADesktop, TakesASceneInWhileARecordingPlays) {
  desktop->world.open_given("", "", fs::path(LIMPID_ASSETS_DIR) / "scenes/spheres.toml");
  desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
  EXPECT_TRUE(until([&] { return desktop->playback.on(); }));
  EXPECT_TRUE(until([&] { return !document().loader().busy(); }));
  EXPECT_TRUE(desktop->playback.on()) << "and goes on playing";
  desktop->playback.close();
  EXPECT_TRUE(std::ranges::any_of(document().scene().objects, has_shape<Mesh>));
}

TEST_F(ADesktop, ChoosesTheViewUntilSomebodyDoes) {
  EXPECT_TRUE(desktop->shown.automatic_view());
  desktop->shown.look(Camera::View::top);
  EXPECT_FALSE(desktop->shown.automatic_view());
  desktop->shown.reset_view();
  EXPECT_TRUE(desktop->shown.automatic_view());
}

// The panel's energies follow the plots' newest row, whatever came before.
TEST_F(ADesktop, AccountsForTheEnergyOfItsLoop) {
  const int energy = static_cast<int>(Channel::energy_total);
  const auto stage = [&]() -> const Stage& { return desktop->live.stage(); };
  desktop->settings.parameters().eta = 0.3;  // not passive, so that energy is given
  Controls& controls = desktop->live.controls();
  controls.goal = Vec3(0.17, 0.04, 0.03);
  controls.grab = true;
  EXPECT_TRUE(until([&] { return std::abs(stage().energy[kMainLane].total()) > 1e-4; }));
  controls.grab = false;
  frames(5);
  const History& history = stage().history;
  EXPECT_NEAR(stage().energy[kMainLane].total(), history.value(energy, history.end() - 1), 1e-6);
}

}  // namespace
}  // namespace limpid
