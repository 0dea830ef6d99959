#include "app/sweep/sweep_work.h"

#include <gmock/gmock.h>
#include <hdf5.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "devices/files/text_file.h"
#include "tests/app/sweep/plans.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class SweepWork : public testing::Test {
 protected:
  bool work(const fs::path& out, SweepShare share, const TakeBlock& take = {}) {
    const SweepFolder folder(plan_, out);
    return work_off(plan_, folder, share, stop_, done_, take);
  }
  // Bytes of the table.
  std::string gathered(const fs::path& out) { return test::gathered(plan_, out, complete_); }
  std::string reference() {
    work(dir_ / "reference", {.threads = 1});
    return gathered(dir_ / "reference");
  }

  test::TempDir dir_;
  SweepPlan plan_ = test::sweep_plan(dir_, test::kShort);
  std::atomic<bool> stop_{false};
  std::atomic<std::uint64_t> done_{0};
  bool complete_ = false;
};

TEST_F(SweepWork, GivesTheSameTableWhoeverDoesIt) {
  const std::string table = reference();
  EXPECT_TRUE(complete_);
  EXPECT_EQ(done_, plan_.points());
  ASSERT_TRUE(work(dir_ / "threads", {.threads = 3}));
  EXPECT_EQ(gathered(dir_ / "threads"), table);
  for (const std::uint64_t shard : {2, 0, 1}) {
    ASSERT_TRUE(work(dir_ / "shards", {.shard = shard, .shards = 3, .threads = 1}));
    gathered(dir_ / "shards");
    EXPECT_EQ(complete_, shard == 1);
  }
  EXPECT_EQ(gathered(dir_ / "shards"), table);
  ASSERT_TRUE(work(dir_ / "helped", {.shard = 4, .shards = 5, .helps = true, .threads = 2}));
  EXPECT_EQ(gathered(dir_ / "helped"), table);
}

TEST_F(SweepWork, GoesOnWhereItWasStopped) {
  const std::string table = reference();
  int taken = 0;
  EXPECT_FALSE(work(dir_ / "stopped", {.threads = 1}, [&](std::uint64_t, const auto&) {
    if (++taken == 3) stop_ = true;
  }));
  EXPECT_EQ(taken, 3);
  EXPECT_NE(gathered(dir_ / "stopped"), table);
  EXPECT_FALSE(complete_);
  stop_ = false;
  std::vector<std::uint64_t> left;
  const SweepFolder folder(plan_, dir_ / "stopped");
  for (std::uint64_t b = 0; b < blocks_of(plan_); ++b) {
    if (!folder.there(block_of(plan_, b))) left.push_back(b);
  }
  EXPECT_EQ(left.size(), blocks_of(plan_) - 3);
  ASSERT_TRUE(work(dir_ / "stopped", {.threads = 2}));
  EXPECT_EQ(gathered(dir_ / "stopped"), table);
}

TEST_F(SweepWork, DoesDamagedAndCutBlocksAgain) {
  const std::string table = reference();
  const SweepFolder folder(plan_, dir_ / "reference");
  for (const std::uint64_t block : {1u, 2u}) {
    std::string bytes = test::bytes_of(folder.file(block_of(plan_, block)));
    // A value of the block, found by its bits.
    double value = folder.read(block_of(plan_, block))->front();
    const auto at = bytes.find(std::string(reinterpret_cast<const char*>(&value), sizeof value));
    ASSERT_NE(at, std::string::npos);
    if (block == 1) bytes[at + 2] = static_cast<char>(bytes[at + 2] ^ 1);
    if (block == 2) bytes.resize(bytes.size() / 2);
    std::ofstream(folder.file(block_of(plan_, block)), std::ios::binary) << bytes;
    EXPECT_FALSE(folder.read(block_of(plan_, block))) << block;
  }
  gathered(dir_ / "reference");
  EXPECT_FALSE(complete_);
  ASSERT_TRUE(work(dir_ / "reference", {}));
  EXPECT_EQ(gathered(dir_ / "reference"), table);
}

TEST_F(SweepWork, RefusesBlocksOfAnotherBuild) {
  reference();
  const SweepFolder folder(plan_, dir_ / "reference");
  const std::uint64_t other = 0x1234;
  const hid_t file = H5Fopen(folder.file(block_of(plan_, 3)).c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t attribute = H5Aopen(file, "build", H5P_DEFAULT);
  H5Awrite(attribute, H5T_NATIVE_UINT64, &other);
  H5Aclose(attribute);
  H5Fclose(file);
  try {
    gathered(dir_ / "reference");
    FAIL() << "taken";
  } catch (const FileError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("000003.h5"), HasSubstr("another build"),
                                HasSubstr("0000000000001234")));
  }
}

TEST_F(SweepWork, RefusesAFolderOfAnotherPlan) {
  reference();
  const SweepPlan other = test::sweep_plan(dir_, test::kShort + "# and more\n");
  try {
    const SweepFolder folder(other, dir_ / "reference");
    FAIL() << "taken";
  } catch (const FileError& e) {
    EXPECT_THAT(e.what(), HasSubstr("another plan"));
  }
}

TEST_F(SweepWork, LeavesATableOfWhatIsDone) {
  work(dir_ / "part", {.shard = 1, .shards = 2, .threads = 1});
  gathered(dir_ / "part");
  const hid_t file = H5Fopen((dir_ / "part/table.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const auto column = [&](const char* path) {
    std::vector<double> values(plan_.points());
    const hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT);
    EXPECT_GE(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    H5Dclose(dataset);
    return values;
  };
  const auto eta = column("/axis/eta"), done = column("/done"), rms = column("/measure/human_rms");
  H5Fclose(file);
  for (std::uint64_t i = 0; i < plan_.points(); ++i) {
    EXPECT_NEAR(eta[i], 0.4 + 0.1 * static_cast<double>(i % 7), 1e-12);
    EXPECT_EQ(done[i], i / 4 % 2);  // every other block of 4
    EXPECT_EQ(std::isnan(rms[i]), done[i] == 0);
  }
}

// Two tables of the same values are the same bytes, whenever each was written; and what a disk has
// changed is refused by the library when it is read.
TEST_F(SweepWork, HasNoTimesInItsTableAndASumOfEachPiece) {
  reference();
  const hid_t file = H5Fopen((dir_ / "reference/table.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  for (const char* path : {"/done", "/repeat"}) {
    const hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT);
    ASSERT_GE(dataset, 0) << path;
#if H5_VERSION_GE(1, 12, 0)
    H5O_info2_t about{};
    ASSERT_GE(H5Oget_info3(dataset, &about, H5O_INFO_TIME), 0);
#else
    H5O_info_t about{};
    ASSERT_GE(H5Oget_info(dataset, &about), 0);
#endif
    EXPECT_EQ(about.mtime, 0) << path;
    EXPECT_EQ(about.ctime, 0) << path;
    const hid_t creation = H5Dget_create_plist(dataset);
    unsigned flags = 0;
    std::size_t values = 0;
    EXPECT_GE(H5Pget_filter_by_id2(creation, H5Z_FILTER_FLETCHER32, &flags, &values, nullptr, 0,
                                   nullptr, nullptr),
              0)
        << path;
    H5Pclose(creation);
    H5Dclose(dataset);
  }
  H5Fclose(file);
}

// 21 points in blocks of four: the last block has one.
TEST_F(SweepWork, IsCutIntoBlocksThatHoldEachPointOnce) {
  ASSERT_EQ(plan_.points(), 21u);
  ASSERT_EQ(blocks_of(plan_), 6u);
  std::uint64_t next = 0;
  for (std::uint64_t b = 0; b < 6; ++b) {
    const SweepBlock block = block_of(plan_, b);
    EXPECT_EQ(block.number, b);
    EXPECT_EQ(block.first, next);
    EXPECT_EQ(block.size, b < 5 ? 4u : 1u);
    next += block.size;
  }
  const SweepFolder folder(plan_, dir_ / "out");
  EXPECT_EQ(folder.path(), dir_ / "out");
  EXPECT_EQ(folder.table(), dir_ / "out/table.h5");
  EXPECT_EQ(folder.file(block_of(plan_, 5)), dir_ / "out/blocks/000005.h5");
}

TEST_F(SweepWork, TakesBlocksAsTheyComeAndCountsTheirPoints) {
  const SweepFolder folder(plan_, dir_ / "out");
  SweepBook book(plan_, folder, false);
  EXPECT_EQ(book.gather(), 0u);
  folder.write(block_of(plan_, 1), std::vector<double>(12, 0.5));
  folder.write(block_of(plan_, 5), {1, 2, 3});
  EXPECT_TRUE(folder.there(block_of(plan_, 5)));
  EXPECT_EQ(folder.read(block_of(plan_, 5)), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(book.gather(), 5u);
  EXPECT_EQ(book.gather(), 0u) << "each block once";
  EXPECT_TRUE(book.has(1) && book.has(5) && !book.has(0));
  EXPECT_EQ(book.table().count(), 5u);
  EXPECT_EQ(book.table().at(4, 2), 0.5);
  EXPECT_EQ(book.table().at(20, 1), 2);
  EXPECT_FALSE(book.complete());
}

TEST_F(SweepWork, HasAFolderThatKnowsItsPlan) {
  const fs::path out = dir_ / "out";
  EXPECT_FALSE(is_sweep_folder(out));
  EXPECT_EQ(plan_behind(out), out / "plan.toml") << "not yet a sweep's";
  check_plan_of(plan_, out);
  { const SweepFolder made(plan_, out); }
  EXPECT_TRUE(is_sweep_folder(out));
  EXPECT_EQ(plan_behind(out), fs::weakly_canonical(dir_ / "plan.toml"));
  check_plan_of(plan_, out);
  const SweepPlan other = test::sweep_plan(dir_, test::kShort + "# and more\n");
  try {
    check_plan_of(other, out);
    ADD_FAILURE() << "taken";
  } catch (const FileError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("sweep.key: made from another plan"),
                                HasSubstr(hex(plan_.key)), HasSubstr("needed: " + hex(other.key))));
  }
  // The folder of the plan is gone: its files may lie beside the table.
  fs::create_directories(dir_ / "moved");
  std::ofstream(dir_ / "moved/sweep.key") << "plan 1\nbuild 2\nfrom /no/such/folder/plan.toml\n";
  EXPECT_EQ(plan_behind(dir_ / "moved"), dir_ / "moved/plan.toml");
}

TEST_F(SweepWork, RefusesAFolderWhoseNoteIsNone) {
  fs::create_directories(dir_ / "out");
  std::ofstream(dir_ / "out/sweep.key") << "milk, bread\n";
  try {
    const SweepFolder folder(plan_, dir_ / "out");
    FAIL() << "taken";
  } catch (const FileError& e) {
    EXPECT_THAT(e.what(), HasSubstr("sweep.key: this file is no note of a sweep"));
  }
  std::ofstream(dir_ / "file") << "in the way";
  EXPECT_THROW(SweepFolder(plan_, dir_ / "file"), FileError);
}

TEST_F(SweepWork, WritesItsTableNotBeforeItIsTime) {
  const SweepFolder folder(plan_, dir_ / "out");
  const SweepBook book(plan_, folder, false);
  TimedTable table(book);
  table.write_if_time();
  EXPECT_FALSE(fs::exists(folder.table())) << "two seconds are between two tables";
}

}  // namespace
}  // namespace limpid
