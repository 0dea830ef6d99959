// Files that came along: their names, and what a person meant who mistyped one.
#include "app/run/shipped_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "tests/support/built_in.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

// Names in a folder of the sources' assets, of files with one of these endings.
std::vector<std::string> names_in_assets(const char* kind, const std::set<std::string>& endings) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(test::assets_dir() / kind)) {
    if (entry.is_regular_file() && endings.contains(entry.path().extension().string())) {
      names.push_back(entry.path().filename().string());
    }
  }
  std::ranges::sort(names);
  return names;
}

TEST(ShippedFiles, AreListedByTheirKindInOrder) {
  EXPECT_EQ(shipped_names("devices"), names_in_assets("devices", {".urdf"}))
      << "a file of keys beside an arm is none";
  EXPECT_EQ(shipped_names("scenes"), names_in_assets("scenes", {".toml", ".glb"}));
  EXPECT_EQ(shipped_names("hands"), names_in_assets("hands", {".csv"}));
  EXPECT_EQ(shipped_names("sessions"), names_in_assets("sessions", {".h5"}));
  EXPECT_THAT(shipped_names("sweeps"), testing::Not(testing::IsEmpty()));
  EXPECT_THAT(shipped_names("none"), testing::IsEmpty());
}

TEST(ShippedFiles, AreFoundByNameInTheFirstFolderThatHasIt) {
  const auto found = shipped_file("table.toml", {"devices", "scenes"});
  ASSERT_TRUE(found);
  EXPECT_TRUE(fs::equivalent(*found, test::assets_dir() / "scenes/table.toml"));
  EXPECT_FALSE(shipped_file("table.toml", {"devices"}));
  EXPECT_FALSE(shipped_file("scenes/table.toml", {"scenes"})) << "a path is the person's own";
  EXPECT_FALSE(shipped_file("", {"scenes"})) << "the folder itself is no file";
  EXPECT_FALSE(shipped_file("thumbnails", {"scenes"}));
}

TEST(ShippedFiles, AreSuggestedToWhoMistypedOne) {
  EXPECT_EQ(shipped_hint("tabel.toml", {"scenes"}), "; did you mean table.toml?");
  EXPECT_EQ(shipped_hint("touhc", {"hands"}), "; did you mean touch.csv?") << "without an ending";
  EXPECT_EQ(shipped_hint("omnii.urdf", {"scenes", "devices"}), "; did you mean omni.urdf?");
  EXPECT_EQ(shipped_hint("cup.csv", {"sessions", "hands"}), "; did you mean cup.csv?")
      << "its own ending comes first";
  EXPECT_EQ(shipped_hint("cup.h5", {"hands"}), "; did you mean cup.csv?") << "of another kind";
  EXPECT_EQ(shipped_hint("cupp.h5", {"hands"}), "") << "of another kind, and not its name";
  EXPECT_EQ(shipped_hint("mine/tabel.toml", {"scenes"}), "");
  EXPECT_EQ(shipped_hint("something-else.toml", {"scenes"}), "");
  EXPECT_EQ(shipped_hint("tabel.toml", {}), "");
}

}  // namespace
}  // namespace limpid
