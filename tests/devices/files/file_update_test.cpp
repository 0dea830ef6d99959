#include <fcntl.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include "devices/files/atomic_file.h"
#include "devices/files/text_file.h"
#include "tests/devices/files/test_files.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class FileUpdate : public testing::Test {
 protected:
  void append(const std::string& line) const {
    update_file_under_lock(file_, [&](const std::string& text) { return text + line + "\n"; });
  }

  test::TempDir dir_;
  fs::path file_ = dir_ / "folder/notes.toml";
};

TEST_F(FileUpdate, HandsOverWhatIsThereAndMakesTheFolder) {
  append("one");
  append("two");
  EXPECT_EQ(test::file_bytes(file_), "one\ntwo\n");
}

// Without the lock each program would read before another one has written, and most lines would be
// lost.
TEST_F(FileUpdate, OfSeveralProgramsAtOnceLosesNothing) {
  constexpr int kPrograms = 4, kLines = 8;
  std::vector<pid_t> programs;
  for (int program = 0; program < kPrograms; ++program) {
    const pid_t id = fork();
    if (id == 0) {
      for (int line = 0; line < kLines; ++line) {
        // On a slow disk the wait for the others may exceed its limit.
        while (!test::refusal([&] { append(fmt::format("{} {}", program, line)); }).empty()) {
        }
      }
      _exit(0);
    }
    programs.push_back(id);
  }
  for (const pid_t id : programs) {
    int status = 0;
    ASSERT_EQ(waitpid(id, &status, 0), id);
    EXPECT_EQ(status, 0);
  }
  const std::string all = "\n" + test::file_bytes(file_);
  for (int program = 0; program < kPrograms; ++program) {
    for (int line = 0; line < kLines; ++line) {
      EXPECT_THAT(all, HasSubstr(fmt::format("\n{} {}\n", program, line)));
    }
  }
}

TEST_F(FileUpdate, ThatIsGivenUpLeavesTheFileAsItWas) {
  append("one");
  EXPECT_THROW(update_file_under_lock(
                   file_, [](const std::string&) -> std::string { throw FileError("no"); }),
               FileError);
  EXPECT_EQ(test::file_bytes(file_), "one\n");
  append("two");
  EXPECT_EQ(test::file_bytes(file_), "one\ntwo\n") << "and leaves no lock behind";
}

TEST_F(FileUpdate, SaysThatAnotherProgramHoldsTheFileAndDoesNotWaitForEver) {
  append("one");
  const int holder = ::open((file_.string() + ".lock").c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_GE(holder, 0);
  ASSERT_EQ(::flock(holder, LOCK_EX), 0);
  try {
    append("two");
    ADD_FAILURE() << "it was written";
  } catch (const FileError& e) {
    EXPECT_THAT(e.what(), HasSubstr("notes.toml.lock: cannot be locked: another program"));
  }
  ::close(holder);
  EXPECT_EQ(test::file_bytes(file_), "one\n");
}

TEST_F(FileUpdate, KeepsWhatCannotBeReadAndNoEarlierOneIsReplaced) {
  append("first");
  keep_unread(file_);
  append("second");
  keep_unread(file_);
  EXPECT_EQ(test::file_bytes(file_.string() + ".unread"), "first\n");
  EXPECT_EQ(test::file_bytes(file_.string() + ".unread-2"), "first\nsecond\n");
}

TEST_F(FileUpdate, NamesAFolderThatCannotBeMade) {
  test::write_file(dir_ / "folder", "in the way");
  try {
    append("one");
    ADD_FAILURE() << "it was written";
  } catch (const FileError& e) {
    EXPECT_THAT(e.what(), HasSubstr("notes.toml: cannot be written"));
  }
}

}  // namespace
}  // namespace limpid
