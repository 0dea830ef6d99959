// The workbench without a window: what it does to the loop, to devices and to what is not saved.
#include "app/desktop/workbench.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "app/run/replay.h"
#include "core/dynamics/arm.h"
#include "render/gl/offscreen.h"
#include "tests/support/built_in.h"
#include "tests/support/device_traits.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

// What a fake device says and hears, shared with the test.
struct Wire {
  std::atomic<double> angle{0};  // from where the arm rests [rad]
  std::atomic<bool> here{true};
  std::atomic<std::uint32_t> buttons{0};
  std::atomic<double> torque{0};  // the largest of the newest
  std::atomic<int> closed{0};
};

class WiredDevice final : public Device {
 public:
  WiredDevice(int dof, std::shared_ptr<Wire> wire)
      : traits_(test::pushing(dof)), rest_(static_cast<std::size_t>(dof)), wire_(std::move(wire)) {
    if (dof == 3) Eigen::Map<Eigen::Vector3d>(rest_.data()) = rest_pose(test::omni());
  }
  ~WiredDevice() override { ++wire_->closed; }
  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading& newest) noexcept override {
    for (std::size_t i = 0; i < rest_.size(); ++i) newest.x[i] = rest_[i] + wire_->angle;
    newest.count = ++count_;
    newest.buttons = wire_->buttons;
    return wire_->here;
  }
  void write(std::span<const double> torque) noexcept override {
    double largest = 0;
    for (const double tau : torque) largest = std::max(largest, std::abs(tau));
    wire_->torque = largest;
  }
  void stop() noexcept override { wire_->torque = 0; }

 private:
  DeviceTraits traits_;
  std::vector<double> rest_;  // [rad]
  std::shared_ptr<Wire> wire_;
  std::uint64_t count_ = 0;
};

struct AWorkbench : testing::Test {
  void SetUp() override {
    setenv("XDG_DATA_HOME", (dir / "data").c_str(), 1);
    setenv("XDG_CONFIG_HOME", (dir / "config").c_str(), 1);
    try {
      context = std::make_unique<OffscreenContext>(64, 64);
    } catch (const std::exception& e) {
      GTEST_SKIP() << "no OpenGL here: " << e.what();
    }
    bench = std::make_unique<Workbench>(Settings{}, AskForPriority{});
    bench->open_world("", "");
    frames(3);
  }
  void TearDown() override {
    if (bench) bench->drop_pictures();
    bench.reset();
  }
  void frames(int count) {
    for (int i = 0; i < count; ++i) {
      bench->update(0.01);
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
  Arming arming() const { return bench->live.snapshot().arming; }
  bool said(const std::string& what) const {
    return std::ranges::any_of(bench->notices, [&](const Notice& notice) {
      return notice.text.find(what) != std::string::npos;
    });
  }
  // Asks for force until it is there: on a busy computer the window may have been silent meanwhile.
  template <class Ask>
  bool until_on(Ask ask) {
    return until([&] {
      if (!bench->force_armed()) {
        ask();
        frames(5);
      }
      return arming() == Arming::on;
    });
  }
  bool armed() {
    return until_on([&] { bench->live.arm(); });
  }
  // However late the loop's first tick with it is: a desk that did not connect it gives it no time.
  void await_device() {
    while (!bench->live.snapshot().connected) {
      std::this_thread::sleep_for(1ms);
      bench->live.update();
    }
  }
  std::shared_ptr<Wire> plug_in(int dof) {
    auto wire = std::make_shared<Wire>();
    bench->open_device(std::make_unique<WiredDevice>(dof, wire));
    await_device();
    return wire;
  }
  // A device in the loop, beside a stop that presses against it, armed.
  std::shared_ptr<Wire> pushed() {
    auto wire = plug_in(3);
    EXPECT_TRUE(until([&] { return bench->live.snapshot().connected; }));
    wire->angle = 0.1;  // pulled away from its proxy, whose coupling pulls back
    EXPECT_TRUE(armed());
    return wire;
  }
  void record_something() {
    bench->toggle_recording();
    ASSERT_TRUE(until([&] { return bench->live.snapshot().recording; }));
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
    return std::ranges::any_of(bench->editor.scene().spheres,
                               [&](const Sphere& sphere) { return sphere.name == name; });
  }

  const test::TempDir dir;
  std::unique_ptr<OffscreenContext> context;
  std::unique_ptr<Workbench> bench;
};

TEST_F(AWorkbench, HasForceOnTheVirtualArmFromTheStart) {
  EXPECT_TRUE(until([&] { return arming() == Arming::on; }));
}

TEST_F(AWorkbench, DoesNotArmWhenItStartsOver) {
  bench->cut_force();
  ASSERT_TRUE(until([&] { return arming() == Arming::off; }));
  bench->start_over();
  frames(80);
  EXPECT_EQ(arming(), Arming::off);
  bench->toggle_force();
  EXPECT_TRUE(until([&] { return arming() == Arming::on; }));
}

TEST_F(AWorkbench, LeavesARealDeviceOffWhateverElseIsDone) {
  const auto wire = plug_in(3);
  ASSERT_TRUE(bench->live.device_in_place());
  const auto expect_off = [&](const char* after) {
    frames(70);
    EXPECT_EQ(arming(), Arming::off) << after;
    EXPECT_EQ(wire->torque, 0) << after;
  };
  expect_off("plugging in");
  bench->start_over();
  expect_off("starting over");
  bench->toggle_coupling();
  bench->undo();
  expect_off("undo");
  bench->open_scene(fs::path(LIMPID_ASSETS_DIR) / "scenes/spheres.toml");
  ASSERT_TRUE(until([&] { return said("Scene:"); }));
  EXPECT_TRUE(bench->live.device_in_place()) << "the device stays in the loop";
  expect_off("another scene");
  bench->open_session(fs::path(LIMPID_ASSETS_DIR) / "sessions/touch.h5");
  ASSERT_TRUE(until([&] { return bench->playing_back(); }));
  bench->start_rerun();
  ASSERT_TRUE(until([&] { return !bench->playback->rerun.empty(); }));
  expect_off("playback and re-run");
  bench->close_playback();
  expect_off("going back to live");
}

TEST_F(AWorkbench, TakesTheForceOfARealDeviceAwayBeforeAnythingChanges) {
  auto wire = pushed();
  bench->start_over();
  EXPECT_TRUE(until([&] { return arming() == Arming::off; }));
  EXPECT_EQ(wire->torque, 0);
  wire->angle = 0;
  ASSERT_TRUE(armed());
  bench->open_scene(fs::path(LIMPID_ASSETS_DIR) / "scenes/spheres.toml");
  ASSERT_TRUE(until([&] { return said("Scene:"); }));
  frames(70);
  EXPECT_EQ(arming(), Arming::off);
}

TEST_F(AWorkbench, TakesAButtonThatWasHeldWhilePluggingInForNothing) {
  auto wire = std::make_shared<Wire>();
  wire->buttons = 2;
  bench->open_device(std::make_unique<WiredDevice>(3, wire));
  await_device();
  frames(120);  // also beyond the time in which a device settles
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
  EXPECT_TRUE(until([&] { return !bench->force_armed(); }));
}

TEST_F(AWorkbench, SaysThatADeviceIsGoneAndClosesItBesideTheWindow) {
  const auto wire = pushed();
  frames(60);
  wire->here = false;
  EXPECT_TRUE(until([&] { return said("The device is gone"); }));
  EXPECT_EQ(arming(), Arming::tripped);
  EXPECT_TRUE(until([&] { return wire->closed == 1; }));
}

TEST_F(AWorkbench, RecordsAndClosesTheFileBesideTheWindow) {
  for (int i = 0; i < 2; ++i) {
    record_something();
    bench->toggle_recording();
    ASSERT_TRUE(until([&] { return said("Recorded"); }));
    bench->notices.clear();
    std::this_thread::sleep_for(1100ms);  // names have seconds
  }
  ASSERT_EQ(recordings().size(), 2u);
  for (const fs::path& file : recordings()) EXPECT_GT(read_session(file).size(), 100u);
}

TEST_F(AWorkbench, CompletesARecordingWhenItEnds) {
  record_something();
  bench->drop_pictures();
  bench.reset();
  ASSERT_EQ(recordings().size(), 1u);
  EXPECT_EQ(recordings()[0].extension(), ".h5");
  EXPECT_GT(read_session(recordings()[0]).size(), 100u);
}

TEST_F(AWorkbench, LeavesNothingBehindWhenItEndsBeforeARecordingBegan) {
  bench->toggle_recording();
  bench->drop_pictures();
  bench.reset();
  EXPECT_TRUE(recordings().empty());
}

// Rows of another width must not go into the file.
TEST_F(AWorkbench, CompletesARecordingWhenADeviceBringsAnotherArm) {
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

TEST_F(AWorkbench, SaysThatItCannotRecordAndGoesOn) {
  fs::remove_all(dir / "data");
  std::ofstream(dir / "data") << "a file where a folder should be";
  bench->toggle_recording();
  EXPECT_TRUE(until([&] { return !bench->notices.empty() && bench->notices.back().bad; }));
  EXPECT_FALSE(bench->recording());
  const auto ticks = bench->live.status().ticks;
  EXPECT_TRUE(until([&] { return bench->live.status().ticks > ticks + 50; }));
}

// With the device in the loop that it was recorded with.
TEST_F(AWorkbench, HoldsADeviceToItsLimitsAndRecordsThem) {
  bench->devices.hub.use("device");
  bench->devices.hub.notes("device").limits.tip_force = 1.25;
  plug_in(3);
  frames(2);
  EXPECT_EQ(bench->controls.limits.tip_force, 1.25);
  record_something();
  bench->toggle_recording();
  ASSERT_TRUE(until([&] { return said("Recorded"); }));
  ASSERT_EQ(recordings().size(), 1u);
  EXPECT_NE(read_session(recordings()[0]).info.safety.find("tip_force = 1.25"), std::string::npos);
}

TEST_F(AWorkbench, ChangesNoDeviceInARecording) {
  record_something();
  bench->devices.use(*bench, "another");
  EXPECT_EQ(bench->devices.hub.in_use(), "");
  EXPECT_TRUE(said("Stop the recording"));
}

TEST_F(AWorkbench, OffersToPlayWhatItHasRecovered) {
  const fs::path sessions = dir / "data/limpid/sessions";
  fs::create_directories(sessions);
  RunPlan plan;
  plan.arm = test::omni();
  plan.hand.source = "mouse";
  Recorder(sessions / "cut.h5", session_info(plan), Parameters{}, false);  // never finished
  ASSERT_TRUE(fs::exists(sessions / "cut.h5.part"));
  bench->recover_leftovers();
  EXPECT_TRUE(said("Recovered cut.h5"));
  EXPECT_EQ(bench->last_recording, sessions / "cut.h5");
}

TEST_F(AWorkbench, KeepsChangesOfTheSceneWhenADeviceComesAndGoes) {
  bench->add_object(Sphere{.name = "mine", .radius = 0.01, .material = {500}});
  ASSERT_TRUE(bench->editor.dirty());
  plug_in(3);
  EXPECT_TRUE(has("mine"));
  EXPECT_TRUE(bench->editor.dirty());
  bench->close_device();
  EXPECT_FALSE(bench->live.device_in_place());
  EXPECT_TRUE(has("mine"));
  EXPECT_TRUE(bench->editor.dirty());
}

TEST_F(AWorkbench, PutsASceneAsideForADeviceThatReachesNothingOfIt) {
  const std::string file = bench->scene_file;
  bench->add_object(Sphere{.name = "mine", .radius = 0.01, .material = {500}});
  plug_in(2);
  EXPECT_FALSE(has("mine"));
  EXPECT_NE(bench->scene_file, file);
  ASSERT_NE(bench->unsaved_set_aside(), nullptr);
  bench->close_device();
  EXPECT_TRUE(has("mine"));
  EXPECT_TRUE(bench->editor.dirty());
  EXPECT_EQ(bench->scene_file, file);
  EXPECT_EQ(bench->unsaved_set_aside(), nullptr);
}

// Only what the user had open is put aside, not what a device brought.
TEST_F(AWorkbench, KeepsTheSceneThatWasPutAsideFromOneDeviceToTheNext) {
  const std::string file = bench->scene_file;
  bench->add_object(Sphere{.name = "mine", .radius = 0.01, .material = {500}});
  plug_in(2);
  plug_in(3);
  bench->close_device();
  EXPECT_TRUE(has("mine"));
  EXPECT_TRUE(bench->editor.dirty());
  EXPECT_EQ(bench->scene_file, file);
}

TEST_F(AWorkbench, KeepsASceneWhoseFileHasVanished) {
  const fs::path file = dir / "scene.toml";
  bench->add_object(Sphere{.name = "saved", .radius = 0.01, .material = {500}});
  ASSERT_TRUE(bench->save_scene_as(file));
  bench->add_object(Sphere{.name = "mine", .radius = 0.01, .material = {500}});
  fs::remove(file);
  plug_in(3);
  bench->close_device();
  EXPECT_TRUE(has("saved"));
  EXPECT_TRUE(has("mine"));
  EXPECT_TRUE(bench->editor.dirty());
}

}  // namespace
}  // namespace limpid
