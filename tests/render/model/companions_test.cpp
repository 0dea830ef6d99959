// Files beside a model, which are limited all together.
#include "render/model/companions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

class CompanionFiles : public testing::Test {
 protected:
  void write(const char* name, std::size_t size) {
    std::ofstream(dir_ / name, std::ios::binary) << std::string(size, 'x');
  }
  std::string refusal(Companions& companions, const std::string& uri) {
    try {
      companions.read(uri);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  const test::TempDir dir_;
  const std::string name_ = "part.gltf";
};

TEST_F(CompanionFiles, MayBeSoLargeTogetherWithTheModel) {
  write("a.bin", 600);
  write("b.bin", 400);
  write("c.bin", 1);
  Companions companions(name_, dir_ / "", kLargestModelFiles - 1000);
  EXPECT_EQ(companions.read("a.bin")->size(), 600u);
  EXPECT_EQ(companions.read("b.bin")->size(), 400u);
  EXPECT_THAT(refusal(companions, "c.bin"), testing::HasSubstr("larger than the limit of 512 MiB"));
}

TEST_F(CompanionFiles, CountEachTimeTheyAreRead) {
  write("a.bin", 600);
  Companions companions(name_, dir_ / "", kLargestModelFiles - 1000);
  EXPECT_EQ(companions.read("a.bin")->size(), 600u);
  EXPECT_THAT(refusal(companions, "a.bin"), testing::HasSubstr("larger than the limit of 512 MiB"));
}

TEST_F(CompanionFiles, AreNothingWhereThereIsNone) {
  Companions companions(name_, dir_ / "", 0);
  EXPECT_EQ(companions.read("a.bin"), std::nullopt);
  EXPECT_THAT(refusal(companions, "../a.bin"), testing::HasSubstr("in its own folder"));
}

}  // namespace
}  // namespace limpid
