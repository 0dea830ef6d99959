#include "app/desktop/scene/unsaved.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>

#include "app/base/folders.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/urdf_file.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

class Unsaved : public testing::Test {
 protected:
  void SetUp() override { document.scene.add({"ball", pose_at({0.1, 0, 0.05}), Sphere{0.02}}); }

  const test::TempDir dir;
  const fs::path folder = dir / "unsaved";
  ArmDescription arm = read_urdf(default_device().string());
  SceneDocument document;
};

TEST_F(Unsaved, ChangesAreThereAtTheNextStartAndToldOfOnce) {
  const fs::path kept = keep_unsaved(document, arm, "table", folder);
  EXPECT_EQ(kept, folder / "table-unsaved.toml");
  const auto found = take_unsaved(folder);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found.front(), folder / "table-recovered.toml");
  const Scene again = read_scene(found.front().string(), arm).scene;
  ASSERT_EQ(again.objects.size(), 1u);
  EXPECT_EQ(again.objects.front().name, "ball");
  EXPECT_TRUE(take_unsaved(folder).empty());
}

TEST_F(Unsaved, EarlierOnesAreNeverReplaced) {
  keep_unsaved(document, arm, "table", folder);
  keep_unsaved(document, arm, "table", folder);
  EXPECT_EQ(take_unsaved(folder).size(), 2u);
  keep_unsaved(document, arm, "table", folder);
  EXPECT_EQ(take_unsaved(folder).size(), 1u);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 3);
}

TEST_F(Unsaved, TheNewestIsLastWhateverTheirNames) {
  const fs::path first = keep_unsaved(document, arm, "table", folder);
  const fs::path older = keep_unsaved(document, arm, "walls", folder);
  document.scene.add({"newest", pose_at({0.1, 0, 0.1}), Sphere{0.01}});
  const fs::path last = keep_unsaved(document, arm, "table", folder);
  const auto now = fs::file_time_type::clock::now();
  fs::last_write_time(first, now - std::chrono::hours(2));
  fs::last_write_time(older, now - std::chrono::hours(1));
  fs::last_write_time(last, now);
  const auto found = take_unsaved(folder);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(read_scene(found.back().string(), arm).scene.objects.back().name, "newest");
  EXPECT_EQ(found[1].filename(), "walls-recovered.toml");
}

TEST_F(Unsaved, OtherScenesAreLeftAlone) {
  fs::create_directories(folder);
  std::ofstream(folder / "mine.toml") << "title = \"mine\"\n";
  EXPECT_TRUE(take_unsaved(folder).empty());
  EXPECT_TRUE(fs::exists(folder / "mine.toml"));
  EXPECT_TRUE(take_unsaved(folder / "not there").empty());
}

}  // namespace
}  // namespace limpid
