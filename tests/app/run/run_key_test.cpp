// Keys of files and runs: equal only for what is equal.
#include "app/run/run_key.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <string>

#include "tests/support/temp_dir.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

// Published values of FNV-1a with 64 bits.
TEST(ADigest, IsTheKnownOneOfKnownBytes) {
  const auto of = [](const std::string& bytes) {
    Digest digest;
    digest.add(bytes.data(), bytes.size());
    return digest.value();
  };
  EXPECT_EQ(of(""), 0xcbf29ce484222325u);
  EXPECT_EQ(of("a"), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(of("foobar"), 0x85944171f73967e8u);
}

TEST(ADigest, TellsListsApartThatRunIntoTheSameBytes) {
  const auto of_texts = [](const std::string& one, const std::string& other) {
    Digest digest;
    digest.add(one);
    digest.add(other);
    return digest.value();
  };
  EXPECT_NE(of_texts("ab", "c"), of_texts("a", "bc"));
  const auto of_lists = [](const std::vector<double>& one, const std::vector<double>& other) {
    Digest digest;
    digest.add_all(one);
    digest.add_all(other);
    return digest.value();
  };
  EXPECT_NE(of_lists({0, 0}, {}), of_lists({0}, {0}));
  EXPECT_NE(of_lists({1, 2}, {}), of_lists({2, 1}, {}));
}

class AFilesDigest : public testing::Test {
 protected:
  std::uint64_t of(const std::string& bytes) {
    std::ofstream(dir_ / "a", std::ios::binary) << bytes;
    return file_digest(dir_ / "a").value();
  }
  const test::TempDir dir_;
};

TEST_F(AFilesDigest, IsAnotherOneForEachLength) {
  std::set<std::uint64_t> all;
  for (std::size_t size = 0; size < 80; ++size) all.insert(of(std::string(size, '\0')));
  for (const std::size_t size : {65535u, 65536u, 65537u}) all.insert(of(std::string(size, '\0')));
  EXPECT_EQ(all.size(), 83u);
}

// The file is read in pieces of 64 KiB.
TEST_F(AFilesDigest, IsAnotherOneForEachByteThatIsOtherwise) {
  std::string bytes;
  for (int i = 0; i < 70'000; ++i) bytes += static_cast<char>(i % 251);
  const std::uint64_t whole = of(bytes);
  EXPECT_EQ(of(bytes), whole) << "the same for the same";
  std::set<std::uint64_t> all{whole};
  for (const std::size_t at : {0, 1, 7, 8, 9, 15, 16, 24, 31, 32, 65'535, 65'536, 69'999}) {
    for (const int bit : {1, 128}) {
      std::string other = bytes;
      other[at] = static_cast<char>(other[at] ^ bit);
      EXPECT_TRUE(all.insert(of(other)).second) << at << ", " << bit;
    }
  }
  std::string swapped = bytes;
  std::swap_ranges(swapped.begin(), swapped.begin() + 8, swapped.begin() + 32);
  EXPECT_TRUE(all.insert(of(swapped)).second);
}

TEST_F(AFilesDigest, IsNoneOfAFileThatIsNotThere) {
  EXPECT_FALSE(file_digest(dir_ / "none"));
  EXPECT_NE(program_digest(), 0u) << "this program can be read";
}

TEST(TrialKey, KnowsWhereBodiesArePulled) {
  RunPlan plan = test::plan("table.toml", "touch.csv", 0.1);
  std::set<std::uint64_t> keys{trial_key(plan, 1)};
  plan.hand.pull.assign(plan.hand.time.size(), {});
  EXPECT_TRUE(keys.insert(trial_key(plan, 1)).second);
  BodyPull& pull = plan.hand.pull[3];
  pull.body = 0;
  EXPECT_TRUE(keys.insert(trial_key(plan, 1)).second) << "the body";
  pull.point.y() = 0.01;
  EXPECT_TRUE(keys.insert(trial_key(plan, 1)).second) << "the point";
  pull.target.z() = 0.01;
  EXPECT_TRUE(keys.insert(trial_key(plan, 1)).second) << "the target";
  std::swap(plan.hand.pull[3], plan.hand.pull[4]);
  EXPECT_TRUE(keys.insert(trial_key(plan, 1)).second) << "when it begins";
  EXPECT_EQ(trial_key(plan, 1), trial_key(plan, 1));
  EXPECT_NE(trial_key(plan, 1), trial_key(plan, 2)) << "another program";
}

}  // namespace
}  // namespace limpid
