#include "devices/files/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <thread>

#include "devices/files/text_file.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

std::span<const unsigned char> bytes(std::string_view text) {
  return {reinterpret_cast<const unsigned char*>(text.data()), text.size()};
}

TEST(AtomicFile, TakesANameWithoutAFolder) {
  const test::TempDir dir;
  const fs::path before = fs::current_path();
  fs::current_path(dir / ".");
  EXPECT_EQ(try_write_atomically("a.txt", "here"), "");
  EXPECT_EQ(read_text("a.txt", 100), "here");
  update_file_under_lock("a.txt", [](const std::string& text) { return text + " too"; });
  EXPECT_EQ(read_text("a.txt", 100), "here too");
  EXPECT_EQ(try_write_atomically("new/b.txt", "there"), "");
  EXPECT_TRUE(fs::exists("new/b.txt"));
  fs::current_path(before);
}

// A pipe stands for /dev/stdout and /dev/null, which a privileged program could replace.
TEST(AtomicFile, WritesIntoAPipeInsteadOfReplacingIt) {
  const test::TempDir dir;
  const fs::path pipe = dir / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::string got;
  std::jthread reader([&] {
    const int in = open(pipe.c_str(), O_RDONLY);
    std::array<char, 64> some{};
    for (ssize_t n = 0; (n = read(in, some.data(), some.size())) > 0;) {
      got.append(some.data(), static_cast<std::size_t>(n));
    }
    close(in);
  });
  write_atomically(pipe, bytes("what was asked for"));
  reader.join();
  EXPECT_EQ(got, "what was asked for");
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(AtomicFile, SaysThatADeviceTakesNoMore) {
  try {
    write_atomically("/dev/full", bytes("anything"));
    FAIL() << "nothing fits there";
  } catch (const FileError& e) {
    EXPECT_NE(std::string(e.what()).find("/dev/full"), std::string::npos);
  }
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(Place, IsNeverThatOfADevice) {
  EXPECT_THROW(check_place("/dev/full", true), FileError);
  EXPECT_THROW(check_place("/dev/full", false), FileError);
}

}  // namespace
}  // namespace limpid
