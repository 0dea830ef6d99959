// Sessions whose program was killed, whose disk was full.
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <random>
#include <thread>

#include "devices/files/session.h"
#include "sample_session.h"
#include "test_files.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using test::refusal;
using test::sample_info;
using test::sample_rows;
using testing::HasSubstr;

void expect_sample(const Session& session) {
  const auto wanted = sample_rows(session.layout, 0, session.size());
  EXPECT_EQ(session.rows.size(), wanted.size());
  EXPECT_EQ(std::memcmp(session.rows.data(), wanted.data(), wanted.size() * sizeof(double)), 0);
}

// Writes for ever in a process of its own and tells through a pipe how many rows are handed over.
class Recording {
 public:
  explicit Recording(const fs::path& out) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("pipe");
    told_ = ends[0];
    child_ = fork();
    if (child_ == 0) write_for_ever(out, ends[1]);
    close(ends[1]);
  }
  ~Recording() { close(told_); }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  // Rows handed over when it died.
  std::uint64_t kill_after(std::uint64_t rows, std::chrono::microseconds more) {
    std::uint64_t handed = 0;
    while (handed < rows && read(told_, &handed, sizeof handed) == sizeof handed) {
    }
    std::this_thread::sleep_for(more);
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
    while (read(told_, &handed, sizeof handed) == sizeof handed) {
    }
    return handed;
  }

 private:
  [[noreturn]] static void write_for_ever(const fs::path& out, int tell) {
    try {
      SessionWriter writer(out, sample_info(), false);
      const RowLayout layout(3);
      for (;;) {
        const std::uint64_t before = writer.rows_written();
        if (before % 1000 == 0) writer.append(SettingChange{before, "coupling.eta = 1"});
        writer.append(sample_rows(layout, before, 50));
        const std::uint64_t now = writer.rows_written();
        if (write(tell, &now, sizeof now) < 0) break;
      }
    } catch (const std::exception&) {
    }
    _exit(1);
  }

  int told_ = -1;
  pid_t child_ = -1;
};

TEST(KilledRecording, LacksAtMostTheLastSecondAndIsRecovered) {
  std::mt19937 random(7);
  for (int round = 0; round < 12; ++round) {
    const test::TempDir dir;
    Recording recording(dir / "a.h5");
    const std::uint64_t handed =
        recording.kill_after(1000 + random() % 4000, std::chrono::microseconds(random() % 20000));
    const Session left = read_session(dir / "a.h5.part");
    EXPECT_GE(left.size() + 1000, handed);
    expect_sample(left);

    const Recovered recovered = recover_session(dir / "a.h5.part", false);
    EXPECT_EQ(recovered.file, dir / "a.h5");
    EXPECT_EQ(recovered.rows, left.size());
    EXPECT_FALSE(fs::exists(dir / "a.h5.part"));
    const Session session = read_session(dir / "a.h5");
    EXPECT_EQ(session.size(), left.size());
    EXPECT_EQ(session.info.created, sample_info().created);
    EXPECT_EQ(session.changes.size(), (left.size() + 999) / 1000);
    expect_sample(session);
  }
}

TEST(AbandonedRecording, IsLeftAsAKilledOne) {
  const test::TempDir dir;
  {
    SessionWriter writer(dir / "a.h5", sample_info(), false);
    writer.append(sample_rows(RowLayout(3), 0, 1700));
  }
  EXPECT_FALSE(fs::exists(dir / "a.h5"));
  EXPECT_EQ(recover_session(dir / "a.h5.part", false).rows, 1500u);
  expect_sample(read_session(dir / "a.h5"));
}

TEST(Recovery, RefusesWhatItCannotDo) {
  const test::TempDir dir;
  EXPECT_THAT(refusal([&] { recover_session(dir / "none.h5.part", false); }),
              HasSubstr("none.h5.part"));
  EXPECT_THAT(refusal([&] { recover_session(dir / "a.h5", false); }), HasSubstr(".part"));
  test::write_file(dir / "text.h5.part", "no HDF5 at all");
  EXPECT_THAT(refusal([&] { recover_session(dir / "text.h5.part", false); }), HasSubstr("HDF5"));
  EXPECT_TRUE(fs::exists(dir / "text.h5.part"));

  { SessionWriter(dir / "a.h5", sample_info(), false).append(sample_rows(RowLayout(3), 0, 500)); }
  test::write_file(dir / "a.h5", "precious");
  EXPECT_THAT(refusal([&] { recover_session(dir / "a.h5.part", false); }), HasSubstr("--force"));
  EXPECT_EQ(test::file_bytes(dir / "a.h5"), "precious");
  EXPECT_EQ(recover_session(dir / "a.h5.part", true).rows, 500u);
}

// Everything in a process of its own, whose files may not grow beyond `bytes`.
int exit_status_with_limit(rlim_t bytes, int (*work)(const fs::path&), const fs::path& out) {
  const pid_t child = fork();
  if (child == 0) {
    const rlimit limit{bytes, RLIM_INFINITY};
    setrlimit(RLIMIT_FSIZE, &limit);
    int status = 99;
    try {
      status = work(out);
    } catch (const std::exception&) {
    }
    const rlimit none{RLIM_INFINITY, RLIM_INFINITY};
    setrlimit(RLIMIT_FSIZE, &none);  // what is printed may go to a file
    exit(status);                    // with everything that libraries do at exit
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

int record_until_it_fails(const fs::path& out) {
  SessionWriter writer(out, sample_info(), false);
  const RowLayout layout(3);
  const std::string said = refusal([&] {
    for (std::size_t k = 0; k < 200000; k += 100) writer.append(sample_rows(layout, k, 100));
  });
  if (said.find("File too large") == std::string::npos) return 1;
  if (said.find(out.string()) == std::string::npos) return 2;
  if (refusal([&] { writer.append(sample_rows(layout, 0, 1)); }).empty()) return 3;
  const Session left = read_session(writer.part());  // in the same process, too
  return left.size() > 0 ? 0 : 4;
}

TEST(FullDisk, IsAnErrorAndKeepsWhatWasFlushed) {
  for (const rlim_t bytes : {600'000, 1'000'001, 3'333'333, 10'000'000}) {
    const test::TempDir dir;
    EXPECT_EQ(exit_status_with_limit(bytes, &record_until_it_fails, dir / "a.h5"), 0) << bytes;
    const auto left = read_session(dir / "a.h5.part");
    // A row of three joints takes 51 numbers; half a second may be lost.
    EXPECT_GT(left.size() + 1000, (bytes - 400'000) / (51 * 8)) << bytes;
    expect_sample(left);
    EXPECT_EQ(recover_session(dir / "a.h5.part", false).rows, left.size());
  }
}

TEST(FullDisk, IsAnErrorWhenClosingToo) {
  const test::TempDir dir;
  const auto close_late = [](const fs::path& out) {
    SessionWriter writer(out, sample_info(), false);
    writer.append(sample_rows(RowLayout(3), 0, 999));
    const rlimit limit{fs::file_size(writer.part()), RLIM_INFINITY};
    setrlimit(RLIMIT_FSIZE, &limit);
    return refusal([&] { writer.close(); }).find("File too large") == std::string::npos ? 1 : 0;
  };
  EXPECT_EQ(exit_status_with_limit(RLIM_INFINITY, close_late, dir / "a.h5"), 0);
  EXPECT_FALSE(fs::exists(dir / "a.h5"));
  EXPECT_EQ(read_session(dir / "a.h5.part").size(), 500u);
}

TEST(FullDisk, LeavesNothingWhenThereIsNoRoomToBegin) {
  const test::TempDir dir;
  const auto begin = [](const fs::path& out) {
    const std::string said = refusal([&] { SessionWriter(out, sample_info(), false); });
    return said.find("File too large") == std::string::npos ? 1 : 0;
  };
  EXPECT_EQ(exit_status_with_limit(5000, begin, dir / "a.h5"), 0);
  EXPECT_FALSE(fs::exists(dir / "a.h5.part"));
}

TEST(FullDisk, IsToldByTheSystemsOwnWords) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const test::TempDir dir;
  fs::create_symlink("/dev/full", dir / "a.h5.part");
  EXPECT_NE(refusal([&] { SessionWriter(dir / "a.h5", sample_info(), true); }), "");
}

}  // namespace
}  // namespace limpid
