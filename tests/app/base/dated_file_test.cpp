// Names by the time: each is of something new.
#include "app/base/dated_file.h"

#include <gmock/gmock.h>

#include <fstream>
#include <set>

#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

TEST(DatedFile, NamesFolderSubjectTimeAndKind) {
  const fs::path file = dated_file("somewhere", "session", "h5");
  EXPECT_EQ(file.parent_path(), "somewhere");
  EXPECT_THAT(file.filename().string(), testing::MatchesRegex("session-20[0-9]{6}-[0-9]{6}\\.h5"));
  EXPECT_THAT(dated_file("somewhere", "a walk").filename().string(),
              testing::MatchesRegex("a walk-20[0-9]{6}-[0-9]{6}"));
}

// Several within a second, and of files and folders alike.
TEST(DatedFile, NeverNamesWhatExists) {
  const test::TempDir temporary;
  const fs::path folder = temporary / "";
  std::set<fs::path> names;
  for (int i = 0; i < 4; ++i) {
    const fs::path file = dated_file(folder, "session", "h5");
    EXPECT_FALSE(fs::exists(file)) << file;
    std::ofstream(file) << i;
    const fs::path made = dated_file(folder, "sweep");
    EXPECT_TRUE(fs::create_directory(made)) << made;
    names.insert({file, made});
  }
  EXPECT_EQ(names.size(), 8);
}

}  // namespace
}  // namespace limpid
