#include "app/desktop/scene/scene_loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "core/touch/triangle_mesh.h"
#include "devices/files/urdf_file.h"
#include "render/model/model_file.h"
#include "tests/devices/files/test_files.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

fs::path table() { return test::assets() / "scenes/table.glb"; }

std::optional<Loaded> wait_for(SceneLoader& loader) {
  while (loader.busy()) {
    if (auto loaded = loader.take()) return loaded;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return std::nullopt;
}

TEST(LoadModel, GivesItsPictureAndItsShape) {
  const LoadedModel loaded = load_model(table());
  const Mesh& mesh = std::get<Mesh>(loaded.mesh.shape);
  EXPECT_EQ(loaded.mesh.name, "table");
  EXPECT_EQ(loaded.file.path, fs::absolute(table()).lexically_normal().string());
  EXPECT_EQ(mesh.model, loaded.file.path);
  EXPECT_EQ(loaded.mesh.material.stiffness, 600);
  EXPECT_GT(mesh.triangles->triangles(), 0u);
  EXPECT_LE(mesh.triangles->triangles(), loaded.model->indices.size() / 3);
}

TEST(LoadModel, RefusesInOneLineThatNamesTheFile) {
  test::TempDir dir;
  test::write_file(dir / "broken.glb", "glTF? no");
  for (const char* name : {"broken.glb", "missing.glb"}) {
    const std::string said = test::refusal([&] { load_model(dir / name); });
    EXPECT_THAT(said, HasSubstr(name));
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  }
}

// STL without a unit is read in metres if its numbers are small, otherwise in millimetres.
TEST(LoadModel, WarnsOfSizesThatAreLikelyAnotherUnit) {
  test::TempDir dir;
  const auto stl = [&](double size) {
    test::write_file(dir / "part.stl",
                     fmt::format("solid part\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"
                                 "vertex {0} 0 0\nvertex 0 {0} 0\nendloop\nendfacet\nendsolid\n",
                                 size));
    std::vector<std::string> lines = load_model(dir / "part.stl").warnings;
    std::erase_if(
        lines, [](const std::string& line) { return line.find(" long, ") == std::string::npos; });
    return lines;
  };
  EXPECT_THAT(stl(50), testing::IsEmpty());
  EXPECT_THAT(stl(494'000), testing::ElementsAre(HasSubstr("494 m long")));
  EXPECT_THAT(stl(2e-5), testing::ElementsAre(HasSubstr("0.02 mm long")));
}

// The window, `limpid check` and a recording's arm read pictures this way.
TEST(LoadArm, KnowsByItsCollisionShapesWhichWayUpItsPicturesAre) {
  test::TempDir dir;
  fs::copy_file(test::assets() / "devices/omni/forearm.glb", dir / "forearm.glb");
  const Model model = load_model_file(dir / "forearm.glb");
  // An arm with a collision box around the picture, either as in the file, which has y up, or
  // turned to z up.
  const auto arm = [&](bool as_it_is) {
    const Eigen::AlignedBox3d box = model.bounds();
    const Vec3 c = box.center(), s = box.sizes();
    const Vec3 at = as_it_is ? c : Vec3(c.x(), -c.z(), c.y());
    const Vec3 size = as_it_is ? s : Vec3(s.x(), s.z(), s.y());
    const auto text = [](const Vec3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); };
    test::write_file(
        dir / "arm.urdf",
        "<robot name='r'><link name='a'/><joint name='j' type='revolute'><parent link='a'/>"
        "<child link='b'/><limit lower='-1' upper='1' effort='1' velocity='1'/></joint>"
        "<link name='b'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0'"
        " izz='1'/></inertial><visual><geometry><mesh filename='forearm.glb'/></geometry></visual>"
        "<collision><origin xyz='" +
            text(at) + "'/><geometry><box size='" + text(size) +
            "'/></geometry></collision><collision><geometry><mesh filename='gone.stl'/></geometry>"
            "</collision></link></robot>");
    return load_arm(dir / "arm.urdf", "", Xacro::refuse).arm;
  };
  const auto z_up = [](const std::string& warning) {
    return warning.find("z up") != std::string::npos;
  };
  EXPECT_FALSE(std::ranges::any_of(arm(false).warnings, z_up));
  EXPECT_TRUE(std::ranges::any_of(arm(true).warnings, z_up));
  EXPECT_LT((arm(true).visuals[0].model->bounds().max() - model.bounds().max()).norm(), 1e-9);
}

TEST(SceneLoader, BringsInOneAfterTheOther) {
  SceneLoader loader;
  loader.add_model(table());
  loader.add_model(test::assets() / "devices/omni/forearm.glb");
  EXPECT_TRUE(loader.busy());
  EXPECT_FALSE(loader.opening_scene());
  for (const char* name : {"table", "forearm"}) {
    const auto loaded = wait_for(loader);
    ASSERT_TRUE(loaded);
    EXPECT_EQ(std::get<LoadedModel>(*loaded).mesh.name, name);
  }
  EXPECT_FALSE(loader.busy());
}

TEST(SceneLoader, GoesOnAfterAFileThatCannotBeRead) {
  SceneLoader loader;
  loader.add_model("/nowhere/gear.glb");
  loader.add_model(table());
  EXPECT_THAT(test::refusal([&] { wait_for(loader); }), HasSubstr("/nowhere/gear.glb"));
  EXPECT_TRUE(wait_for(loader));
}

TEST(SceneLoader, OpensScenes) {
  const ArmDescription arm = read_urdf((test::assets() / "devices/omni.urdf").string());
  SceneLoader loader;
  loader.open_scene(test::assets() / "scenes/obstacles.toml", [&] { return arm; });
  EXPECT_TRUE(loader.opening_scene());
  const auto loaded = wait_for(loader);
  ASSERT_TRUE(loaded);
  EXPECT_EQ(std::get<LoadedScene>(*loaded).document.title, "Obstacles");
  EXPECT_EQ(std::get<LoadedScene>(*loaded).urdf, arm.urdf);
}

// The scene waits behind an arm, as when both are dropped on the window at once.
TEST(SceneLoader, ReadsASceneForTheArmThatIsThereWhenItsTurnComes) {
  ArmDescription there = read_urdf((test::assets() / "devices/joystick.urdf").string());
  SceneLoader loader;
  loader.open_arm(test::assets() / "devices/omni.urdf", "", Xacro::refuse);
  loader.open_scene(test::assets() / "scenes/proximal.toml", [&] { return there; });
  EXPECT_TRUE(loader.opening_arm());
  const auto first = wait_for(loader);
  ASSERT_TRUE(first && std::holds_alternative<LoadedArm>(*first));
  there = std::get<LoadedArm>(*first).arm;
  const auto second = wait_for(loader);
  ASSERT_TRUE(second && std::holds_alternative<LoadedScene>(*second));
  EXPECT_EQ(std::get<LoadedScene>(*second).urdf, there.urdf);
  EXPECT_FALSE(loader.opening_arm());
}

TEST(SceneLoader, GivesNothingOnceItWasCancelled) {
  SceneLoader loader;
  loader.add_model(table());
  loader.add_model("/nowhere/gear.glb");
  loader.cancel();
  EXPECT_FALSE(wait_for(loader));
  loader.add_model(table());
  EXPECT_TRUE(wait_for(loader)) << "and works again";
}

}  // namespace
}  // namespace limpid
