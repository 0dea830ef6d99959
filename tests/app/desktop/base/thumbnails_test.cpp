#include "app/desktop/base/thumbnails.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

TEST(Thumbnails, HaveOneNameAFile) {
  EXPECT_EQ(thumbnail_of("/a/b/one.h5"), thumbnail_of("/a/c/../b/one.h5"));
  EXPECT_NE(thumbnail_of("/a/b/one.h5"), thumbnail_of("/a/b/two.h5"));
  EXPECT_NE(thumbnail_of("/a/one.h5"), thumbnail_of("/b/one.h5"));
  EXPECT_EQ(thumbnail_of("/a/b/one.h5").extension(), ".png");
}

TEST(Thumbnails, TheOldestGoAndOtherFilesStay) {
  const test::TempDir temp;
  const fs::path folder = temp / "pictures";
  fs::create_directory(folder);
  const auto now = fs::file_time_type::clock::now();
  for (int i = 0; i < 6; ++i) {
    const fs::path file = folder / fmt::format("{}.png", i);
    std::ofstream(file) << "x";
    fs::last_write_time(file, now - std::chrono::hours(i));
  }
  std::ofstream(folder / "notes.txt") << "x";
  keep_newest(folder, 3);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(fs::exists(folder / fmt::format("{}.png", i)), i < 3) << i;
  }
  EXPECT_TRUE(fs::exists(folder / "notes.txt"));
  keep_newest(folder / "none", 3);  // an absent folder is no error
}

// A scene's picture lies beside it. A session's is the one made of it, else the one that came
// along.
TEST(Thumbnails, OfScenesAndSessionsAreWhereTheyLie) {
  const test::TempDir temp;
  setenv("XDG_CACHE_HOME", (temp / "cache").c_str(), 1);
  EXPECT_EQ(picture_of(temp / "scenes/table.toml"), temp / "scenes/thumbnails/table.png");
  const fs::path session = temp / "sessions/table.h5";
  const fs::path made = thumbnail_of(session), shipped = temp / "scenes/thumbnails/table.png";
  EXPECT_EQ(picture_of(session), made) << "neither is there";
  fs::create_directories(shipped.parent_path());
  std::ofstream(shipped) << "x";
  EXPECT_EQ(picture_of(session), shipped) << "one came along";
  fs::create_directories(made.parent_path());
  std::ofstream(made) << "x";
  EXPECT_EQ(picture_of(session), made) << "both are there";
  fs::remove(shipped);
  EXPECT_EQ(picture_of(session), made);
  unsetenv("XDG_CACHE_HOME");
}

}  // namespace
}  // namespace limpid
