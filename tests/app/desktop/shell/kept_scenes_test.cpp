// Scenes that are kept while devices come and go, files vanish and recordings play.
#include <fstream>
#include <functional>

#include "app/base/folders.h"
#include "core/dynamics/arm.h"
#include "tests/app/desktop/shell/a_desktop.h"
#include "tests/support/built_in.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

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

TEST_F(ADesktop, TakesASceneInWhileARecordingPlays) {
  desktop->world.open_given("", "", fs::path(LIMPID_ASSETS_DIR) / "scenes/spheres.toml");
  desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
  EXPECT_TRUE(until([&] { return desktop->playback.on(); }));
  EXPECT_TRUE(until([&] { return !document().loader().busy(); }));
  EXPECT_TRUE(desktop->playback.on()) << "and goes on playing";
  desktop->playback.close();
  EXPECT_TRUE(std::ranges::any_of(document().scene().objects, has_shape<Mesh>));
}

}  // namespace
}  // namespace limpid
