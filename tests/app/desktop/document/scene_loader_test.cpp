#include "app/desktop/document/scene_loader.h"

#include <thread>

#include "core/touch/triangle_mesh.h"
#include "devices/files/arm/urdf_file.h"
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
  EXPECT_EQ(loaded.mesh.name, "table");
  EXPECT_EQ(loaded.file.path, fs::absolute(table()).lexically_normal().string());
  EXPECT_EQ(loaded.mesh.model, loaded.file.path);
  EXPECT_EQ(loaded.mesh.material.stiffness, 600);
  EXPECT_GT(loaded.mesh.shape->triangles(), 0u);
  EXPECT_LE(loaded.mesh.shape->triangles(), loaded.model->indices.size() / 3);
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
  loader.open_scene(test::assets() / "scenes/obstacles.toml", arm);
  EXPECT_TRUE(loader.opening_scene());
  const auto loaded = wait_for(loader);
  ASSERT_TRUE(loaded);
  EXPECT_EQ(std::get<LoadedScene>(*loaded).document.title, "Obstacles");
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
