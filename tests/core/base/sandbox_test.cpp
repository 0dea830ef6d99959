// Abilities of a program that reads files of strangers, once it has shut itself in. Each attempt is
// a process of its own, and its result the exit status.
#include "core/base/sandbox.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/landlock.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <functional>
#include <vector>

#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

constexpr int kDone = 42;

class Sandbox : public testing::Test {
 protected:
  Sandbox() {
    mkdir((dir_ / "own").c_str(), 0700);
    std::ofstream(dir_ / "own/a.mtl") << "newmtl a\n";
    std::ofstream(dir_ / "key") << "secret\n";
  }
  void SetUp() override {
    if (kSanitized) GTEST_SKIP() << "sanitized";
  }

  // Exit status of a process that makes `attempt` in the sandbox: errno if the attempt returns a
  // negative number.
  int leaves_with(const std::function<long()>& attempt, const std::filesystem::path& folder) {
    const pid_t child = fork();
    if (child == 0) {
      enter_sandbox(folder);
      _exit(attempt() < 0 ? errno : kDone);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  int leaves_with(const std::function<long()>& attempt) {
    return leaves_with(attempt, dir_ / "own");
  }

  const test::TempDir dir_;
};

TEST_F(Sandbox, ReadsWhatLiesInTheFolder) {
  EXPECT_EQ(leaves_with([&] { return open((dir_ / "own/a.mtl").c_str(), O_RDONLY); }), kDone);
  EXPECT_EQ(leaves_with([&] {
              std::ifstream file(dir_ / "own/a.mtl");
              std::string word;
              return file >> word && word == "newmtl" ? 0 : -1;
            }),
            kDone);
  EXPECT_EQ(leaves_with([&] {
              return std::filesystem::canonical(dir_ / "own/../own/a.mtl").empty() ? -1 : 0;
            }),
            kDone);
}

TEST_F(Sandbox, OfASingleFileReadsThatOneOnly) {
  const auto own = dir_ / "own/a.mtl", key = dir_ / "key", folder = dir_ / "own";
  EXPECT_EQ(leaves_with([&] { return open(own.c_str(), O_RDONLY); }, own), kDone);
  if (syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION) < 1) {
    GTEST_SKIP() << "this kernel has no Landlock";
  }
  EXPECT_EQ(leaves_with([&] { return open(key.c_str(), O_RDONLY); }, own), EACCES);
  EXPECT_EQ(leaves_with([&] { return open(folder.c_str(), O_RDONLY | O_DIRECTORY); }, own), EACCES);
}

TEST_F(Sandbox, ReadsNothingElseWhereTheKernelHasLandlock) {
  if (syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION) < 1) {
    GTEST_SKIP() << "this kernel has none";
  }
  const auto key = dir_ / "key";
  EXPECT_EQ(leaves_with([&] { return open(key.c_str(), O_RDONLY); }), EACCES);
  EXPECT_EQ(leaves_with([&] { return open((dir_ / "own/../key").c_str(), O_RDONLY); }), EACCES);
  EXPECT_EQ(leaves_with([] { return open("/etc/passwd", O_RDONLY); }), EACCES);
  EXPECT_EQ(leaves_with([&] { return open((dir_ / "own/a.mtl").c_str(), O_RDONLY); }, ""), EACCES);
}

TEST_F(Sandbox, ChangesNoFile) {
  const auto own = dir_ / "own/a.mtl", fresh = dir_ / "own/new";
  EXPECT_EQ(leaves_with([&] { return open(own.c_str(), O_WRONLY); }), EACCES);
  EXPECT_EQ(leaves_with([&] { return open(own.c_str(), O_RDWR); }), EACCES);
  EXPECT_EQ(leaves_with([&] { return open(own.c_str(), O_RDONLY | O_TRUNC); }), EACCES);
  EXPECT_EQ(leaves_with([&] { return open(fresh.c_str(), O_RDONLY | O_CREAT, 0600); }), EACCES);
  EXPECT_EQ(leaves_with([&] { return open((dir_ / "own").c_str(), O_TMPFILE | O_RDWR, 0600); }),
            EACCES);
  for (const auto& attempt : std::initializer_list<std::function<long()>>{
           [&] { return unlink(own.c_str()); }, [&] { return rename(own.c_str(), fresh.c_str()); },
           [&] { return symlink("/", fresh.c_str()); }, [&] { return mkdir(fresh.c_str(), 0700); },
           [&] { return chmod(own.c_str(), 0777); }, [&] { return truncate(own.c_str(), 0); },
           [&] { return creat(fresh.c_str(), 0600); }}) {
    EXPECT_EQ(leaves_with(attempt), EPERM);
  }
  EXPECT_EQ(std::filesystem::file_size(own), 9u);
  EXPECT_FALSE(std::filesystem::exists(fresh));
}

TEST_F(Sandbox, StartsNothingAndSpeaksToNobody) {
  for (const auto& attempt : std::initializer_list<std::function<long()>>{
           [] { return execl("/bin/true", "true", nullptr); },
           [] { return syscall(SYS_execveat, AT_FDCWD, "/bin/true", nullptr, nullptr, 0); },
           [] { return fork(); }, [] { return socket(AF_INET, SOCK_STREAM, 0); },
           [] { return socket(AF_UNIX, SOCK_STREAM, 0); },
           [] { return ptrace(PTRACE_ATTACH, getppid(), nullptr, nullptr); },
           [] { return kill(getppid(), SIGTERM); },
           [] { return syscall(SYS_tgkill, getppid(), getppid(), SIGTERM); },
           [] { return syscall(SYS_prlimit64, getppid(), 0, nullptr, nullptr); },
           [] { return syscall(SYS_io_uring_setup, 1, nullptr); },
           [] { return syscall(SYS_unshare, 0); },
           [] { return syscall(SYS_bpf, 0, nullptr, 0); }}) {
    EXPECT_EQ(leaves_with(attempt), EPERM);
  }
  EXPECT_EQ(leaves_with([] {
              return mmap(nullptr, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1,
                          0) == MAP_FAILED
                         ? -1
                         : 0;
            }),
            EACCES);
}

// Calls with many uses: uses that change or reach something outside are refused, the others stay.
TEST_F(Sandbox, HasOfCallsOfManyUsesOnlyThoseThatReadingNeeds) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  ASSERT_EQ(dup2(ends[1], 3), 3);  // this one stays open
  f_owner_ex owner{F_OWNER_PID, getpid()};
  struct flock lock {};
  lock.l_type = F_RDLCK;
  for (const auto& attempt : std::initializer_list<std::function<long()>>{
           [] { return fcntl(3, F_SETOWN, getppid()); },
           [&] { return fcntl(3, F_SETOWN_EX, &owner); },
           [] { return fcntl(3, F_SETSIG, SIGKILL); }, [] { return fcntl(3, F_SETFL, O_ASYNC); },
           [] { return fcntl(3, F_NOTIFY, DN_MODIFY); },
           [] { return fcntl(3, F_SETLEASE, F_WRLCK); },
           [] { return fcntl(3, F_SETPIPE_SZ, 1 << 20); }, [&] { return fcntl(3, F_SETLK, &lock); },
           [&] { return fcntl(3, F_OFD_SETLK, &lock); }, [] { return syscall(SYS_flock, 3, 1); }}) {
    EXPECT_EQ(leaves_with(attempt), EPERM);
  }
  for (const auto& attempt : std::initializer_list<std::function<long()>>{
           [] { return fcntl(3, F_GETFD); }, [] { return fcntl(3, F_SETFD, FD_CLOEXEC); },
           [] { return fcntl(3, F_GETFL); }, [] { return fcntl(3, F_DUPFD_CLOEXEC, 5); }}) {
    EXPECT_EQ(leaves_with(attempt), kDone);
  }
  close(3), close(ends[0]), close(ends[1]);
}

TEST_F(Sandbox, ChangesNoOtherProcessAndNotItself) {
  static rlimit more{RLIM_INFINITY, RLIM_INFINITY};
  for (const auto& attempt : std::initializer_list<std::function<long()>>{
           [] { return syscall(SYS_prlimit64, 0, RLIMIT_CPU, &more, nullptr); },
           [] { return prctl(PR_SET_DUMPABLE, 1); },
           [] { return syscall(SYS_ioctl, 0, 0x5412 /* TIOCSTI */, "x"); },
           [] { return syscall(SYS_clone, SIGCHLD, nullptr, nullptr, nullptr, nullptr); },
           [] { return syscall(SYS_clone3, nullptr, 0); },
           [] { return syscall(SYS_tkill, getppid(), SIGTERM); },
           [] { return syscall(SYS_rt_sigqueueinfo, getppid(), SIGTERM, nullptr); },
           [] { return syscall(SYS_pidfd_open, getppid(), 0); },
           [] { return syscall(SYS_process_vm_writev, getppid(), nullptr, 0, nullptr, 0, 0); },
           [] { return syscall(SYS_socketpair, AF_UNIX, SOCK_STREAM, 0, nullptr); },
           [] { return syscall(SYS_memfd_create, "x", 0); },
           [] { return syscall(SYS_personality, 0x0400000 /* READ_IMPLIES_EXEC */); },
           [] { return syscall(SYS_madvise, 0, 4096, MADV_REMOVE); },
           [] { return syscall(SYS_madvise, 0, 4096, MADV_HWPOISON); }}) {
    EXPECT_EQ(leaves_with(attempt), EPERM);
  }
  EXPECT_EQ(leaves_with([] {
              rlimit now{};
              return syscall(SYS_prlimit64, 0, RLIMIT_CPU, nullptr, &now);
            }),
            kDone);
  EXPECT_EQ(leaves_with([] {
              void* page =
                  mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
              return mprotect(page, 4096, PROT_READ | PROT_EXEC);
            }),
            EACCES);
}

TEST_F(Sandbox, HasNoDescriptorsOfTheProgramThatStartedIt) {
  const int file = open((dir_ / "key").c_str(), O_RDWR);  // without O_CLOEXEC
  const int inherited = fcntl(file, F_DUPFD, 10);
  ASSERT_GE(inherited, 10);
  EXPECT_EQ(leaves_with([&] { return write(inherited, "x", 1); }), EBADF);
  EXPECT_EQ(write(inherited, "x", 1), 1) << "here it is open";
  close(inherited);
  close(file);
}

TEST_F(Sandbox, EndsInAnOrderlyWay) {
  EXPECT_EQ(leaves_with([] {
              const std::vector<char> much(64 << 20, 'x');
              return much.back() == 'x' ? 0L : -1L;
            }),
            kDone);
  EXPECT_EQ(leaves_with([]() -> long { std::abort(); }), -SIGABRT);
}

}  // namespace
}  // namespace limpid
