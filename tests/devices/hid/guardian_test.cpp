#include "devices/hid/guardian.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <functional>
#include <memory>

#include "devices/hid/device_claim.h"
#include "devices/hid/hid_transport.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

const std::vector<Report> kStop{{1, 0, 0}, {12, 3}};
const Report kStopBytes{1, 0, 0, 12, 3};

// The writing end of a pipe stands for the device.
struct GuardedPipe : testing::Test {
  GuardedPipe() { EXPECT_EQ(pipe(ends), 0); }
  ~GuardedPipe() override { close(ends[0]); }

  // Reads all bytes until the last writer is gone.
  Report received() {
    Report bytes;
    std::uint8_t byte = 0;
    while (read(ends[0], &byte, 1) == 1) bytes.push_back(byte);
    return bytes;
  }
  // Runs `life` in a child process, which may end it in any way.
  void in_another_process(const std::function<void(int device)>& life) {
    const pid_t child = fork();
    if (child == 0) {
      life(ends[1]);
      _exit(0);
    }
    close(ends[1]);
    waitpid(child, nullptr, 0);
  }

  int ends[2] = {-1, -1};
};

TEST_F(GuardedPipe, GetsTheStopReportsWhenWeAreKilled) {
  in_another_process([](int device) {
    const Guardian guardian(device, kStop);
    raise(SIGKILL);
  });
  EXPECT_EQ(received(), kStopBytes);
}

// While the kernel writes a dump, the guardian hears nothing of the crash.
TEST_F(GuardedPipe, LeavesNoCoreDump) {
  rlimit allowed{};
  getrlimit(RLIMIT_CORE, &allowed);
  if (allowed.rlim_max < 2) GTEST_SKIP() << "this computer allows no core dumps";
  in_another_process([](int device) {
    rlimit core{};
    getrlimit(RLIMIT_CORE, &core);
    core.rlim_cur = core.rlim_max;
    setrlimit(RLIMIT_CORE, &core);
    const int told = dup(device);
    const Guardian guardian(device, kStop);
    getrlimit(RLIMIT_CORE, &core);
    const auto limit = static_cast<std::uint8_t>(std::min<rlim_t>(core.rlim_cur, 0xFF));
    EXPECT_EQ(write(told, &limit, 1), 1);
    raise(SIGKILL);
  });
  const Report all = received();
  ASSERT_EQ(all.size(), 1 + kStopBytes.size());
  EXPECT_LE(all[0], 1);
}

TEST_F(GuardedPipe, GetsThemWhenWeEndWithoutAWord) {
  in_another_process([](int device) {
    [[maybe_unused]] auto* guardian = new Guardian(device, kStop);
    _exit(1);
  });
  EXPECT_EQ(received(), kStopBytes);
}

TEST_F(GuardedPipe, GetsThemWhenNobodyDismissedTheGuardian) {
  { const Guardian guardian(ends[1], kStop); }
  EXPECT_EQ(received(), kStopBytes);
}

TEST_F(GuardedPipe, GetsNothingAfterADismissal) {
  {
    Guardian guardian(ends[1], kStop);
    guardian.dismiss();
  }
  EXPECT_EQ(received(), Report{});
}

// Each guardian inherits the other's socket and must close it.
TEST_F(GuardedPipe, IsGuardedBesideOthers) {
  int other[2];
  ASSERT_EQ(pipe(other), 0);
  in_another_process([&](int device) {
    const Guardian first(device, kStop);
    const Guardian second(other[1], kStop);
    raise(SIGKILL);
  });
  close(other[1]);
  EXPECT_EQ(received(), kStopBytes);
  close(ends[0]);
  ends[0] = other[0];
  EXPECT_EQ(received(), kStopBytes);
}

TEST_F(GuardedPipe, SurvivesInterruptsSentToTheWholeGroup) {
  in_another_process([](int device) {
    setpgid(0, 0);
    const Guardian guardian(device, kStop);
    signal(SIGTERM, SIG_DFL);
    kill(0, SIGTERM);
    pause();
  });
  EXPECT_EQ(received(), kStopBytes);
}

// The next program with the device must not be stopped by the previous guardian.
TEST_F(GuardedPipe, IsClaimedUntilItHasItsStopReports) {
  const test::TempDir dir;
  const auto claimed = [&] { return !claimed_by("device", dir / "").empty(); };
  // More than a pipe holds: the guardian cannot finish until somebody reads.
  const std::vector<Report> long_stop(40, Report(4096, 7));
  in_another_process([&](int device) {
    const DeviceClaim claim("device", dir / "");
    const Guardian guardian(device, long_stop, claim.descriptor());
    raise(SIGKILL);
  });
  EXPECT_TRUE(claimed());
  EXPECT_THROW(DeviceClaim("device", dir / ""), HidError);
  EXPECT_EQ(received().size(), 40u * 4096);
  EXPECT_NO_THROW(DeviceClaim("device", dir / ""));
}

TEST(Guardian, SaysWhyItCannotOpenADevice) {
  try {
    Guardian("/nonexistent/hidraw0", kStop);
    FAIL();
  } catch (const HidError& error) {
    EXPECT_STREQ(error.what(), "/nonexistent/hidraw0: No such file or directory");
  }
}

// Without a session of its own the guardian would be killed with the rest.
TEST_F(GuardedPipe, GetsThemWhenTheWholeGroupIsKilled) {
  in_another_process([](int device) {
    setpgid(0, 0);
    const Guardian guardian(device, kStop);
    kill(0, SIGKILL);
    pause();
  });
  EXPECT_EQ(received(), kStopBytes);
}

// A device that is busy for a while: only repeated attempts get through.
TEST_F(GuardedPipe, GetsThemWhenItIsBusyAtFirst) {
  fcntl(ends[1], F_SETFL, O_NONBLOCK);
  const Report junk(1 << 16, 0xEE);
  while (write(ends[1], junk.data(), junk.size()) > 0) {
  }
  const std::vector<Report> many(400, Report(4096, 0x55));  // a write is whole or nothing
  const pid_t child = fork();
  if (child == 0) {
    const Guardian guardian(ends[1], many);
    raise(SIGKILL);
  }
  close(ends[1]);
  waitpid(child, nullptr, 0);
  usleep(50'000);
  const Report bytes = received();
  EXPECT_GE(std::count(bytes.begin(), bytes.end(), 0x55), 4096);
}

// The guardian lives as long as the device is guarded: it must not hold other pipes open.
TEST_F(GuardedPipe, KeepsNothingElseOpen) {
  int other[2];
  ASSERT_EQ(pipe(other), 0);
  Guardian guardian(ends[1], kStop);
  close(other[1]);
  pollfd wait{other[0], POLLIN, 0};
  EXPECT_EQ(poll(&wait, 1, 5000), 1) << "nobody can write any more";
  EXPECT_NE(wait.revents & POLLHUP, 0);
  close(other[0]);
  guardian.dismiss();
}

// Descriptors below the device's are closed like those above it.
TEST_F(GuardedPipe, KeepsNothingOpenBelowTheDevice) {
  int other[2];
  ASSERT_EQ(pipe(other), 0);
  const int device = fcntl(ends[1], F_DUPFD, other[1] + 1);
  ASSERT_GT(device, other[1]);
  close(ends[1]);
  Guardian guardian(device, kStop);
  close(other[1]);
  pollfd wait{other[0], POLLIN, 0};
  EXPECT_EQ(poll(&wait, 1, 5000), 1) << "nobody can write any more";
  EXPECT_NE(wait.revents & POLLHUP, 0);
  close(other[0]);
  guardian.dismiss();
}

}  // namespace
}  // namespace limpid
