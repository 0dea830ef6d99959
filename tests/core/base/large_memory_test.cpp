#include "core/base/large_memory.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/statfs.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <optional>
#include <string>

#include "core/base/descriptor.h"

namespace limpid {
namespace {

constexpr std::size_t kMebibyte = 1 << 20;

// Sets TMPDIR to another value during its life.
class WithFolder {
 public:
  explicit WithFolder(const char* folder) {
    if (const char* was = std::getenv("TMPDIR")) was_ = was;
    setenv("TMPDIR", folder, 1);
  }
  ~WithFolder() { was_ ? setenv("TMPDIR", was_->c_str(), 1) : unsetenv("TMPDIR"); }
  WithFolder(const WithFolder&) = delete;
  WithFolder& operator=(const WithFolder&) = delete;

 private:
  std::optional<std::string> was_;
};

// Resident memory of mapped files [bytes].
std::size_t resident_of_files() {
  std::ifstream status("/proc/self/status");
  std::size_t all = 0;
  for (std::string word; status >> word;) {
    std::size_t kibibytes = 0;
    const bool file = word == "RssFile:" || word == "RssShmem:";  // the latter on a tmpfs
    if (file && status >> kibibytes) all += kibibytes << 10;
  }
  return all;
}

// Whether a file of some MiB can be set aside where blocks go: not on a full disk, a file system
// without fallocate(), one that copies on write, or one that is memory.
bool disk_has_room() {
  const char* wanted = std::getenv("TMPDIR");
  std::string name = std::string(wanted != nullptr ? wanted : "/var/tmp") + "/room-XXXXXX";
  const Descriptor file(::mkstemp(name.data()));
  if (*file < 0) return false;
  ::unlink(name.c_str());
  struct statvfs disk {};
  struct statfs kind {};
  if (::fstatvfs(*file, &disk) != 0 || ::fstatfs(*file, &kind) != 0) return false;
  constexpr std::array<std::uint32_t, 4> kOthers{0x9123683e, 0x2fc12fc1, 0xca451a4e, 0x01021994};
  for (const std::uint32_t one : kOthers) {
    if (static_cast<std::uint32_t>(kind.f_type) == one) return false;
  }
  const std::uint64_t free = std::uint64_t{disk.f_bavail} * disk.f_frsize;
  return free > (std::uint64_t{5} << 28) && ::fallocate(*file, 0, 0, 1 << 20) == 0;
}

TEST(LargeMemory, IsPlainAsLongAsThereIsLittleOfIt) {
  const LargeVector<double> some(32 * kMebibyte / sizeof(double), 1.5);
  EXPECT_EQ(large_bytes_on_disk(), 0u);
  EXPECT_EQ(some.back(), 1.5);
}

TEST(LargeMemory, LiesOnTheDiskBeyondItsBudgetAndGoesWithItsOwner) {
  if (!disk_has_room()) GTEST_SKIP() << "no disk with room beside memory here";
  {
    LargeVector<double> plain, beyond;
    plain.reserve(kPlainBudget / sizeof(double));
    beyond.reserve(16 * kMebibyte / sizeof(double));
    EXPECT_EQ(large_bytes_on_disk(), 16 * kMebibyte);
  }
  EXPECT_EQ(large_bytes_on_disk(), 0u);
  const LargeVector<double> again(16 * kMebibyte / sizeof(double));
  EXPECT_EQ(large_bytes_on_disk(), 0u) << "the budget was not given back";
}

TEST(LargeMemory, IsForgottenAndReadAgain) {
  if (!disk_has_room()) GTEST_SKIP() << "no disk with room beside memory here";
  LargeVector<double> plain, beyond;
  plain.reserve(kPlainBudget / sizeof(double));
  beyond.resize(64 * kMebibyte / sizeof(double));
  std::iota(beyond.begin(), beyond.end(), 0.25);
  const std::size_t before = resident_of_files();
  forget_large_blocks();
  EXPECT_LT(resident_of_files() + 48 * kMebibyte, before);
  for (std::size_t i = 0; i < beyond.size(); ++i) {
    ASSERT_EQ(beyond[i], static_cast<double>(i) + 0.25);
  }
}

TEST(LargeMemory, RefusesWhatNeitherDiskNorMemoryHasRoomFor) {
  const WithFolder none("/proc/self");
  LargeVector<double> more;
  try {
    more.reserve(physical_memory() / sizeof(double));
    FAIL() << "all of the memory was handed out";
  } catch (const NoRoom& no_room) {
    EXPECT_THAT(no_room.what(), ::testing::HasSubstr("/proc/self: "));
    EXPECT_THAT(no_room.what(), ::testing::HasSubstr("TMPDIR"));
  }
}

class FoldersWithoutRoom : public testing::TestWithParam<const char*> {};
// /dev/shm is memory itself.
INSTANTIATE_TEST_SUITE_P(Folders, FoldersWithoutRoom, testing::Values("/proc/self", "/dev/shm"));

TEST_P(FoldersWithoutRoom, LeaveBlocksPlain) {
  const WithFolder none(GetParam());
  LargeVector<double> plain;
  plain.reserve(kPlainBudget / sizeof(double));
  const LargeVector<double> beyond(16 * kMebibyte / sizeof(double), 3.0);
  EXPECT_EQ(large_bytes_on_disk(), 0u);
  EXPECT_EQ(beyond.front() + beyond.back(), 6.0);
}

}  // namespace
}  // namespace limpid
