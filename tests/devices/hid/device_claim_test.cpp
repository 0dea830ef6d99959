#include "devices/hid/device_claim.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <functional>

#include "devices/hid/hid_transport.h"
#include "tests/support/temp_dir.h"

namespace limpid {

bool has_locks = true;
// Stands before the system's own, as on a file system without locks.
extern "C" int flock(int file, int how) noexcept {
  if (has_locks) return static_cast<int>(syscall(SYS_flock, file, how));
  errno = ENOLCK;
  return -1;
}

namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

struct AClaim : testing::Test {
  AClaim() { fs::permissions(folder, fs::perms::all | fs::perms::sticky_bit); }

  DeviceClaim take(const std::string& key = "hidraw:240:3") const {
    return DeviceClaim(key, folder);
  }
  std::string refusal(const std::string& key = "hidraw:240:3") const {
    try {
      take(key);
    } catch (const HidError& error) {
      return error.what();
    }
    return {};
  }
  // The only file in the folder.
  fs::path file() const { return fs::directory_iterator(folder)->path(); }

  const test::TempDir dir;
  const fs::path folder = dir / "";
};

// A child process that has done something and waits to be killed.
class Another {
 public:
  explicit Another(const std::function<void()>& first) {
    int ready[2];
    EXPECT_EQ(pipe(ready), 0);
    id = fork();
    if (id == 0) {
      first();
      [[maybe_unused]] const auto said = write(ready[1], "x", 1);
      for (;;) pause();
    }
    char byte = 0;
    EXPECT_EQ(read(ready[0], &byte, 1), 1);
    close(ready[0]);
    close(ready[1]);
  }
  ~Another() { end(); }
  Another(const Another&) = delete;
  Another& operator=(const Another&) = delete;
  void end() {
    if (id <= 0) return;
    kill(id, SIGKILL);
    waitpid(id, nullptr, 0);
    id = 0;
  }

  pid_t id = 0;
};

TEST_F(AClaim, IsHadByOneAtATimeAlsoWithinAProcess) {
  DeviceClaim first = take();
  EXPECT_TRUE(first.held());
  EXPECT_THAT(refusal(), HasSubstr("in use by"));
  EXPECT_EQ(refusal("hidraw:240:4"), "") << "another device is free";
  const DeviceClaim moved = std::move(first);
  EXPECT_THAT(refusal(), HasSubstr("in use by")) << "it goes where its claim goes";
}

TEST_F(AClaim, IsFreeOnceItIsGivenBack) {
  { const DeviceClaim first = take(); }
  EXPECT_EQ(refusal(), "");
  DeviceClaim again = take();
  again = DeviceClaim();
  EXPECT_EQ(refusal(), "");
}

TEST_F(AClaim, SaysWhichProcessHasItAndWhatThatDoes) {
  const Another other([this] { new DeviceClaim(take()); });
  std::ifstream command("/proc/self/comm");
  std::string name;
  std::getline(command, name);
  for (const std::string& said : {refusal(), claimed_by("hidraw:240:3", folder)}) {
    EXPECT_THAT(said, HasSubstr("process " + std::to_string(other.id) + " (" + name));
    EXPECT_THAT(said, HasSubstr("since 20"));
  }
  EXPECT_EQ(claimed_by("hidraw:240:4", folder), "");
}

TEST_F(AClaim, OfThisProcessIsNobodyElses) {
  EXPECT_EQ(claimed_by("hidraw:240:3", folder), "") << "nobody ever had it";
  const DeviceClaim own = take();
  EXPECT_EQ(claimed_by("hidraw:240:3", folder), "");
}

TEST_F(AClaim, IsLetGoOfByTheKernelWhenItsHolderIsKilled) {
  Another other([this] { new DeviceClaim(take()); });
  EXPECT_NE(refusal(), "");
  other.end();
  EXPECT_EQ(refusal(), "");
  EXPECT_EQ(claimed_by("hidraw:240:3", folder), "");
}

// The guardian keeps a claim like this, as it outlives the program.
TEST_F(AClaim, IsKeptByWhoeverStillHasItsDescriptor) {
  pid_t child = 0;
  {
    const DeviceClaim claim = take();
    child = fork();
    if (child == 0) {
      for (;;) pause();
    }
  }
  EXPECT_NE(refusal(), "");
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(refusal(), "");
}

TEST_F(AClaim, CanBeTakenByEveryUserWhateverTheMask) {
  const mode_t before = umask(077);
  { const DeviceClaim first = take(); }
  umask(before);
  struct stat is {};
  ASSERT_EQ(stat(file().c_str(), &is), 0);
  EXPECT_EQ(is.st_mode & 0777, 0666u);
}

// A file of another user that cannot be written to can still be locked.
TEST_F(AClaim, TakesAFileOfAnotherUser) {
  if (geteuid() != 0) GTEST_SKIP() << "only the superuser can be somebody else";
  { const DeviceClaim first = take(); }
  fs::permissions(file(), fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read |
                              fs::perms::others_read);
  Another other([this] {
    if (setgid(65534) != 0 || setuid(65534) != 0) _exit(1);
    new DeviceClaim(take());
  });
  EXPECT_THAT(refusal(), HasSubstr("in use by")) << "another user's claim holds for us";
  other.end();
  EXPECT_EQ(refusal(), "");
}

TEST_F(AClaim, FollowsNoLinkAndWritesIntoNothingThatIsNoPlainFile) {
  { const DeviceClaim first = take(); }
  const fs::path lock = file();
  fs::remove(lock);
  const fs::path victim = dir / "victim";
  std::ofstream(victim) << "precious";
  fs::create_symlink(victim, lock);
  EXPECT_THAT(refusal(), HasSubstr("plain file"));
  fs::remove(lock);
  fs::create_hard_link(victim, lock);
  EXPECT_THAT(refusal(), HasSubstr("plain file"));
  fs::remove(lock);
  ASSERT_EQ(mkfifo(lock.c_str(), 0666), 0);
  EXPECT_THAT(refusal(), HasSubstr("plain file"));
  fs::remove(lock);
  fs::create_directory(lock);
  EXPECT_NE(refusal(), "");
  std::string text;
  std::getline(std::ifstream(victim), text);
  EXPECT_EQ(text, "precious");
}

TEST_F(AClaim, DoesNotTrustWhatTheFileSays) {
  { const DeviceClaim first = take(); }
  const int locked = open(file().c_str(), O_RDWR);
  ASSERT_EQ(flock(locked, LOCK_EX), 0);
  const auto say = [&](const std::string& text) {
    ASSERT_EQ(ftruncate(locked, 0), 0);
    ASSERT_EQ(pwrite(locked, text.data(), text.size(), 0), static_cast<ssize_t>(text.size()));
  };
  say("");
  EXPECT_EQ(refusal(), "in use by another program");
  say("-1\nall of them\nnow\n");
  EXPECT_EQ(refusal(), "in use by another program");
  say("1\n\x1b[2J" + std::string(400, 'a') + "\nnow\n");
  EXPECT_THAT(refusal(), HasSubstr("process 1 (?[2Jaaa"));
  EXPECT_LT(refusal().size(), 200u);
  close(locked);
}

// A lock on a deleted file would hold nobody back.
TEST_F(AClaim, IsTakenOnTheFileThatIsThere) {
  const DeviceClaim first = take();
  fs::remove(file());
  const DeviceClaim second = take();
  EXPECT_NE(refusal(), "");
}

TEST_F(AClaim, HasNamesThatCannotLeaveItsFolder) {
  const DeviceClaim claim = take("socket:/run/user/1000/limpid/../a b.device");
  EXPECT_EQ(file().filename(),
            "limpid-socket:%2Frun%2Fuser%2F1000%2Flimpid%2F..%2Fa%20b.device.lock");
  EXPECT_THAT(refusal(std::string(300, 'a')), HasSubstr("is too long"));
}

TEST_F(AClaim, IsRefusedWhereNobodyCanTell) {
  EXPECT_THAT(refusal("a"), "");
  try {
    DeviceClaim("a", dir / "no such folder");
    FAIL();
  } catch (const HidError& error) {
    EXPECT_THAT(error.what(), HasSubstr("No such file or directory, so nobody can tell"));
  }
}

TEST_F(AClaim, IsRefusedWithoutLocksAndThatIsSaid) {
  has_locks = false;
  const std::string said = refusal("a"), by = claimed_by("a", folder);
  has_locks = true;
  EXPECT_THAT(said, HasSubstr("limpid-a.lock: cannot be locked: No locks available, so nobody"));
  EXPECT_EQ(by, "");
  EXPECT_EQ(refusal("a"), "");
}

// Two containers may share the node without a common folder of claims.
TEST_F(AClaim, OfANodeIsOneProgramsByWhateverNameItIsOpened) {
  const fs::path node = dir / "hidraw0", other = dir / "other name";
  std::ofstream(node) << "";
  fs::create_hard_link(node, other);
  {
    const DeviceClaim first = DeviceClaim::on_node(node);
    EXPECT_TRUE(first.held());
    try {
      DeviceClaim::on_node(other);
      FAIL() << "two have one device";
    } catch (const HidError& error) {
      EXPECT_THAT(error.what(), HasSubstr("in use by another program, perhaps in a container"));
    }
  }
  EXPECT_TRUE(DeviceClaim::on_node(other).held());
  EXPECT_THROW(DeviceClaim::on_node(dir / "no such node"), HidError);
}

TEST_F(AClaim, IsLookedForWhereEveryUserMayMakeFiles) {
  fs::create_directory(dir / "own");
  fs::permissions(dir / "own", fs::perms::owner_all);
  const std::array<fs::path, 3> places{dir / "none", dir / "own", folder};
  EXPECT_EQ(claim_folder(places), folder);
  try {
    claim_folder(std::span(places).first(2));
    FAIL();
  } catch (const HidError& error) {
    EXPECT_THAT(error.what(), HasSubstr("needed: " + places[0].string() + " or "));
  }
}

}  // namespace
}  // namespace limpid
