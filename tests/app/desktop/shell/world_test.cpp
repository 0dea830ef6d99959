// Files on their way into the window: at its start, dropped on it, and refused.
#include "app/desktop/shell/world.h"

#include <fmt/format.h>
#include <imgui.h>

#include <fstream>

#include "app/base/folders.h"
#include "tests/app/desktop/shell/a_desktop.h"
#include "tests/support/built_in.h"
#include "tests/support/device_traits.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

struct AWorld : ADesktop {
  void SetUp() override {
    ImGui::CreateContext();
    ADesktop::SetUp();
  }
  void TearDown() override {
    ADesktop::TearDown();
    ImGui::DestroyContext();
  }
  World& world() const { return desktop->world; }
  Settings& settings() const { return desktop->settings; }
  const ArmDescription& arm() const { return desktop->live.stage().arm(); }
  static fs::path shipped(const char* file) { return fs::path(LIMPID_ASSETS_DIR) / file; }
  fs::path a_scene(const char* name, const std::string& title) const {
    std::ofstream(dir / name) << "title = \"" << title << "\"\ntip_radius = 0.004\n"
                              << "[[sphere]]\nname = \"ball\"\ncenter = [0.2, 0, 0]\n"
                              << "radius = 0.02\nstiffness = 500\n";
    return dir / name;
  }
  std::string last_said() const {
    return desktop->notices.all().empty() ? "" : desktop->notices.all().back().text;
  }
  // Opens the arm, whatever becomes of the scene's changes.
  void change_to(const char* urdf) {
    const std::string name = read_urdf(shipped(urdf)).name;
    world().open_arm(shipped(urdf));
    ASSERT_TRUE(until([&] {
      if (document().asking()) document().discard_and_leave();
      return arm().name == name;
    }));
  }
};

TEST_F(AWorld, BeginsWithTheArmAndSceneOfLastTime) {
  const std::string scene = a_scene("last.toml", "Last").string();
  settings().device = shipped("devices/paddle.urdf").string();
  settings().scene = scene;
  world().open_last("", "", "", false);
  EXPECT_EQ(arm().name, "paddle");
  EXPECT_EQ(world().arm_file().file, settings().device);
  EXPECT_FALSE(world().built_in_arm());
  EXPECT_EQ(document().file(), scene);
  EXPECT_TRUE(has("ball"));
  EXPECT_TRUE(said("Arm: paddle, 1 joint to "));
  desktop->notices.clear();
  world().open_last(shipped("devices/omni.urdf"), "", shipped("scenes/free.toml"), false);
  EXPECT_EQ(arm().name, "omni") << "as it is named";
  EXPECT_EQ(document().file(), shipped("scenes/free.toml"));
  EXPECT_TRUE(said("Arm: omni, 3 joints to "));
  desktop->notices.clear();
  settings().device.clear();
  world().open_last("", "", "", false);
  EXPECT_TRUE(world().built_in_arm());
  EXPECT_EQ(document().file(), scene) << "the last one fits the built-in arm";
  EXPECT_FALSE(said("Arm:")) << "nothing special";
}

TEST_F(AWorld, BeginsAsAtFirstWhereTheFilesOfLastTimeAreGone) {
  const std::string first = document().file();
  settings().device = (dir / "gone.urdf").string();
  settings().device_tip = "hand";
  settings().scene = (dir / "gone.toml").string();
  desktop->notices.clear();
  world().open_last("", "", "", false);
  EXPECT_TRUE(said("gone.urdf"));
  EXPECT_TRUE(said("gone.toml"));
  for (const Notice& notice : desktop->notices.all()) EXPECT_TRUE(notice.bad) << notice.text;
  EXPECT_EQ(settings().device, "");
  EXPECT_EQ(settings().device_tip, "");
  EXPECT_TRUE(world().built_in_arm());
  EXPECT_EQ(document().file(), first);
  EXPECT_THROW(world().open_last("", "", (dir / "gone.toml").string(), false), std::exception)
      << "it was asked for now";
  EXPECT_THROW(world().open_last((dir / "gone.urdf").string(), "", "", false), std::exception);
}

TEST_F(AWorld, AsksBeforeItExpandsAnArmOfLastTime) {
  const fs::path file = dir / "arm.xacro";
  std::ofstream(file) << "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\" name=\"mine\">"
                         "<xacro:property name=\"a\" value=\"1\"/></robot>";
  settings().device = file.string();
  world().open_last("", "", "", false);
  EXPECT_TRUE(world().built_in_arm());
  EXPECT_EQ(desktop->dialog.name(), "expand xacro");
  ASSERT_TRUE(world().xacro());
  EXPECT_EQ(world().xacro()->file, file);
  EXPECT_EQ(settings().device, file.string()) << "it is asked about, not forgotten";
}

TEST_F(AWorld, NamesWhatItCannotOpenAndWhatItCould) {
  const auto told = [&](const std::vector<fs::path>& files) {
    desktop->notices.clear();
    world().open_files(files);
    EXPECT_EQ(desktop->notices.all().size(), 1u);
    EXPECT_TRUE(desktop->notices.all().back().bad);
    return last_said();
  };
  fs::create_directory(dir / "folder");
  EXPECT_THAT(told({"/x/a.txt"}), StartsWith("a.txt: not opened. Drop models ("));
  EXPECT_THAT(told({"/x/a.txt", dir / "folder", "/x/c", "/x/d.doc"}),
              StartsWith("a.txt, folder, c, d.doc: not opened."));
  EXPECT_THAT(told({"/x/a", "/x/b", "/x/c", "/x/d", "/x/e"}),
              StartsWith("a, b, c, d and 1 more: not opened."));
  const std::string all = told({"/x/a", "/x/b", "/x/c", "/x/d", "/x/e", "/x/f"});
  EXPECT_THAT(all, StartsWith("a, b, c, d and 2 more: not opened."));
  for (const char* kind : {".glb", ".stl", "scenes (.toml)", "recordings (.h5)",
                           "a sweep's folder or table", "a hand's path (.csv)", "(.urdf)"}) {
    EXPECT_THAT(all, HasSubstr(kind));
  }
  desktop->notices.clear();
  world().open_files({});
  EXPECT_TRUE(desktop->notices.all().empty());
}

// Whatever their order: the arm first, then the scene for it.
TEST_F(AWorld, OpensEachKindOfFileInTheOrderInWhichTheyNeedEachOther) {
  const fs::path scene = a_scene("Mine.TOML", "Mine");
  world().open_files({scene, shipped("devices/paddle.urdf")});
  ASSERT_TRUE(until([&] { return said("Scene: Mine"); }));
  EXPECT_EQ(arm().name, "paddle");
  EXPECT_EQ(document().file(), scene);
  EXPECT_EQ(settings().scene, scene.string());
  EXPECT_EQ(settings().recent,
            (std::vector{scene.string(), shipped("devices/paddle.urdf").string()}));
  change_to("devices/omni.urdf");
  world().open_files({shipped("sessions/table.h5")});
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  EXPECT_EQ(desktop->playback.shown()->file(), shipped("sessions/table.h5"));
  desktop->playback.close();
  world().open_files({shipped("hands/touch.csv")});
  EXPECT_THAT(desktop->playback.what(), HasSubstr("touch.csv"));
  desktop->playback.cancel_loading();
  world().open_files({scene});
  ASSERT_TRUE(until([&] { return has("ball"); }));
  const std::size_t objects = document().scene().objects.size();
  world().open_files({shipped("scenes/ball_1.glb")});
  ASSERT_TRUE(until([&] { return document().scene().objects.size() == objects + 1; }));
  EXPECT_TRUE(has_shape<Mesh>(document().scene().objects.back()));
  EXPECT_EQ(document().editor().selected(), objects);
  const Bounds box = document().selected_bounds();
  EXPECT_LT(box.center().norm(), 0.5) << "within reach";
  EXPECT_FALSE(box.contains(Vec3(0.2, 0, 0))) << "beside the ball that is there";
}

TEST_F(AWorld, KeepsTheSceneForAnArmOfLikeSizeAndLeavesItForAnother) {
  world().add_object({"mine", Pose::Identity(), Sphere{0.01}, {500}});
  settings().scene = "/a/scene.toml";
  ASSERT_TRUE(document().editor().dirty());
  world().open_arm(shipped("devices/touch.urdf"));
  ASSERT_TRUE(until([&] { return !world().built_in_arm(); }));
  EXPECT_TRUE(has("mine"));
  EXPECT_TRUE(document().editor().dirty()) << "no file has it yet";
  EXPECT_EQ(settings().scene, "/a/scene.toml");
  EXPECT_EQ(settings().device, shipped("devices/touch.urdf"));
  EXPECT_EQ(settings().recent.front(), settings().device);
  world().open_arm(shipped("devices/paddle.urdf"));
  ASSERT_TRUE(until([&] { return document().asking(); })) << "its changes would be lost";
  EXPECT_EQ(arm().name, "touch");
  document().discard_and_leave();
  EXPECT_EQ(arm().name, "paddle");
  EXPECT_FALSE(has("mine"));
  EXPECT_EQ(settings().scene, "") << "its default one";
  EXPECT_FALSE(document().editor().dirty());
  run("arm.built_in");
  ASSERT_TRUE(until([&] { return world().built_in_arm(); }));
  EXPECT_EQ(settings().device, "");
}

TEST_F(AWorld, TellsTheFirstDefectsOfAnArmAndHowToSeeAll) {
  const fs::path file = dir / "bare.urdf";
  std::string text = test::omni().urdf;
  const std::size_t end = text.rfind("</robot>");
  ASSERT_NE(end, std::string::npos);
  for (std::size_t at = 0, i = 0; (at = text.find("filename=\"", at)) != std::string::npos; ++i) {
    at += 10;
    text.replace(at, text.find('"', at) - at, fmt::format("none{}.stl", i));
  }
  std::ofstream(file) << text;
  const std::vector<std::string> defects = read_urdf(file).warnings;
  ASSERT_GT(defects.size(), 3u);
  world().open_arm(file);
  ASSERT_TRUE(until([&] { return !world().built_in_arm(); }));
  std::size_t told = 0;
  for (const std::string& defect : defects) told += said(defect) ? 1 : 0;
  EXPECT_EQ(told, 3u);
  EXPECT_TRUE(said(defects.front()));
  EXPECT_TRUE(said(
      fmt::format("{} more warnings. To see them: limpid check bare.urdf", defects.size() - 3)));
}

TEST_F(AWorld, StaysAsItIsDuringARecording) {
  const std::string scene = document().file();
  record_something();
  desktop->notices.clear();
  world().open_arm(shipped("devices/paddle.urdf"));
  EXPECT_EQ(last_said(), "Stop the recording (R) before you open another arm.");
  world().open_scene(shipped("scenes/free.toml"));
  EXPECT_EQ(last_said(), "Stop the recording (R) before you open another scene.");
  const std::size_t objects = document().scene().objects.size();
  world().add_model(shipped("scenes/ball_1.glb"));
  EXPECT_THAT(last_said(), StartsWith("Stop the recording (R) before you change the scene"));
  EXPECT_FALSE(document().loader().busy());
  for (const Notice& notice : desktop->notices.all()) EXPECT_TRUE(notice.bad) << notice.text;
  frames(5);
  EXPECT_EQ(arm().name, "omni");
  EXPECT_EQ(document().file(), scene);
  EXPECT_EQ(document().scene().objects.size(), objects);
  world().toggle_recording();
  ASSERT_TRUE(until([&] { return said("Recorded "); }));
  EXPECT_EQ(world().why_fixed(), "");
  desktop->playback.open(shipped("sessions/table.h5"));
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  EXPECT_THAT(world().why_fixed(), StartsWith("This scene belongs to a recording."));
}

TEST_F(AWorld, HasAnotherLoopForAnotherNumberOfThingsThatMove) {
  EXPECT_EQ(loop().layout().bodies(), 0);
  Object die{"die", Pose::Identity(), Box{Vec3::Constant(0.01)}};
  die.body.emplace();
  world().add_object(die);
  ASSERT_TRUE(until([&] { return loop().layout().bodies() == 1; }));
  EXPECT_TRUE(has("die"));
  EXPECT_TRUE(until([&] { return loop().status().ticks > 20; })) << "it runs";
  document().undo();
  ASSERT_TRUE(until([&] { return loop().layout().bodies() == 0; }));
  plug_in(3);
  world().open_arm(shipped("devices/paddle.urdf"));
  EXPECT_THAT(last_said(), HasSubstr("Choose the virtual arm first."));
  world().add_object(die);
  ASSERT_TRUE(
      until([&] { return said("Choose the virtual arm before you add or remove objects"); }));
  EXPECT_EQ(loop().layout().bodies(), 0);
  world().toggle_recording();
  EXPECT_TRUE(said("Limpid cannot record: objects that move were added or removed"));
  EXPECT_FALSE(desktop->live.recording());
}

}  // namespace
}  // namespace limpid
