// Folders that are one click away in file dialogs.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>

#include "app/desktop/widgets/path_dialog.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

class Places : public testing::Test {
 protected:
  Places() {
    for (const char* name : {"home", "home/Papers", "scenes", "far/models", "config"}) {
      fs::create_directories(dir_ / name);
    }
    for (const char* name : {"HOME", "XDG_CONFIG_HOME"}) {
      const char* value = getenv(name);
      before_.emplace_back(name, value != nullptr ? value : "");
    }
    setenv("HOME", (dir_ / "home").c_str(), 1);
    setenv("XDG_CONFIG_HOME", (dir_ / "config").c_str(), 1);
  }
  ~Places() override {
    for (const auto& [name, value] : before_) {
      value.empty() ? unsetenv(name.c_str()) : setenv(name.c_str(), value.c_str(), 1);
    }
  }
  std::vector<std::string> names(const std::vector<PathDialog::Place>& places) {
    std::vector<std::string> all;
    for (const auto& place : places) {
      EXPECT_TRUE(fs::is_directory(place.folder)) << place.folder;
      all.push_back(place.name);
    }
    return all;
  }

  test::TempDir dir_;
  std::vector<std::pair<std::string, std::string>> before_;
};

TEST_F(Places, AreThoseThatThereAre) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(names(PathDialog::places({}, {})), Names{"Home"});
  std::ofstream(dir_ / "config/user-dirs.dirs")
      << "# by xdg-user-dirs\nXDG_DOCUMENTS_DIR=\"$HOME/Papers\"\n";
  const auto places = PathDialog::places(
      {{"My scenes", dir_ / "scenes"}, {"gone", dir_ / "no such folder"}},
      {(dir_ / "far/models/gear.glb").string(), (dir_ / "scenes/table.toml").string(),
       (dir_ / "far/models/other.glb").string(), (dir_ / "lost/x.toml").string()});
  EXPECT_EQ(names(places), (Names{"Home", "Documents", "My scenes", "models"}));
  EXPECT_EQ(places[1].folder, dir_ / "home/Papers");
}

TEST_F(Places, AreNotTooMany) {
  std::vector<std::string> recent;
  for (int i = 0; i < 30; ++i) {
    const fs::path folder = dir_ / ("folder" + std::to_string(i)).c_str();
    fs::create_directories(folder);
    recent.push_back((folder / "x.toml").string());
  }
  EXPECT_LE(PathDialog::places({}, recent).size(), 10u);
}

}  // namespace
}  // namespace limpid
