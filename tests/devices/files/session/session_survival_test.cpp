// Sessions whose program was killed, or whose disk was full.
#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <new>
#include <optional>
#include <random>
#include <set>

#include "devices/files/session/session.h"
#include "tests/devices/files/session/endless_recording.h"
#include "tests/devices/files/session/sample_session.h"
#include "tests/devices/files/test_files.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using test::refusal;
using test::sample_info;
using test::sample_rows;
using testing::HasSubstr;

constexpr std::size_t kPage = 4096;

// Pages this process still writes before it is killed; none: it is never killed.
std::optional<std::size_t> pages_left;

// If `wanted`, stops this process where a kill would do most harm: in the middle of the next write
// across a page's end, if there is one soon.
struct Stopping {
  bool wanted = false;
  int patience = 0;  // writes to wait for one that can be cut
};
std::optional<Stopping> stopping;

// Pages that still fit on the disk this process writes to; none: the disk has no end.
std::optional<std::size_t> disk_left;
std::set<std::size_t> disk_pages;

// Part of a write that still fits on the disk [bytes].
std::size_t room_on_disk(std::size_t begin, std::size_t size) {
  for (std::size_t page = begin / kPage; page * kPage < begin + size; ++page) {
    if (disk_pages.contains(page)) continue;
    if (*disk_left == 0) return page * kPage < begin ? 0 : page * kPage - begin;
    --*disk_left;
    disk_pages.insert(page);
  }
  return size;
}

void expect_sample(const Session& session) {
  const auto wanted = sample_rows(session.layout, 0, session.size());
  EXPECT_EQ(session.rows.size(), wanted.size());
  EXPECT_EQ(std::memcmp(session.rows.data(), wanted.data(), wanted.size() * sizeof(double)), 0);
}

TEST(KilledRecording, LacksAtMostTheLastSecondAndIsRecovered) {
  std::mt19937 random(7);
  for (int round = 0; round < 12; ++round) {
    const test::TempDir dir;
    test::EndlessRecording recording(dir / "a.h5");
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

// Whether `work`, in a child process, is killed before it has written `pages` pages.
template <class Work>
bool is_killed_after(std::size_t pages, Work work) {
  const pid_t child = fork();
  if (child == 0) {
    pages_left = pages;
    try {
      work();
    } catch (const std::exception&) {
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status);
}

// Rows of an append, which are written at once and wait for nothing more: ticks of 0.64 s.
constexpr std::size_t kBlock = 64;

void record(const fs::path& out, std::size_t rows, int tell) {
  SessionInfo info = sample_info();
  info.tick = 0.01;
  SessionWriter writer(out, info, false);
  for (std::size_t k = 0; k < rows; k += kBlock) {
    writer.append(SettingChange{k, "coupling.eta = 1"});
    writer.append(sample_rows(RowLayout(3), k, kBlock));
    const std::uint64_t handed = k + kBlock;
    if (write(tell, &handed, sizeof handed) < 0) return;
  }
  writer.close();
}

TEST(KilledRecording, KeepsWhatWasWrittenWhereverTheLastWriteIsCut) {
  constexpr std::size_t kStep = 11;  // every 11th page boundary is tried
  bool killed = true;
  for (std::size_t pages = 0; killed; pages += kStep) {
    const test::TempDir dir;
    int ends[2];
    ASSERT_EQ(pipe2(ends, O_CLOEXEC | O_NONBLOCK), 0);
    killed = is_killed_after(pages, [&] { record(dir / "a.h5", 400, ends[1]); });
    std::uint64_t handed = 0;
    while (read(ends[0], &handed, sizeof handed) == sizeof handed) {
    }
    close(ends[0]);
    close(ends[1]);
    if (handed == 0) continue;  // there may be no file yet
    const fs::path left = dir / (fs::exists(dir / "a.h5") ? "a.h5" : "a.h5.part");
    std::optional<Session> session;
    EXPECT_EQ(refusal([&] { session = read_session(left); }), "") << pages;
    if (!session) continue;
    EXPECT_GE(session->size(), handed) << pages;
    EXPECT_EQ(session->changes.size(), session->size() / kBlock) << pages;
    expect_sample(*session);
  }
}

// Two hours at 10 Hz. The number of pieces of the file's columns, and so the size of HDF5's lists,
// depends on the time alone: a write covers the same time at any tick.
constexpr std::size_t kTwoHours = 72000;
constexpr std::size_t kSecond = 10;
constexpr int kMoments = 200;

[[noreturn]] void record_two_hours(const fs::path& out, const std::vector<double>& rows,
                                   std::atomic<std::uint64_t>& handed) {
  SessionInfo info = sample_info(1);
  info.tick = 0.1;
  SessionWriter writer(out, info, false);
  const std::size_t stride = rows.size() / kTwoHours;
  std::mt19937 random(11);
  stopping.emplace();
  // Moments are denser at the end, where the lists are longest.
  auto next_moment = [&, moment = 0]() mutable {
    const int m = moment++;
    return m < kMoments / 2 ? 620 * static_cast<std::size_t>(m) + random() % 700
                            : kTwoHours - 10000 + 99 * static_cast<std::size_t>(m - kMoments / 2);
  };
  std::size_t next = next_moment();
  for (std::size_t k = 0; k < kTwoHours; ++k) {
    if (k % 3000 == 0) writer.append(SettingChange{k, "coupling.eta = 1"});
    writer.append(std::span(rows).subspan(k * stride, stride));
    handed = k + 1;
    if (k < next) continue;
    // Nine of ten moments wait for a write that can be cut.
    stopping->patience = static_cast<int>(random() % 10 == 0 ? random() % 80 : 500);
    stopping->wanted = true;
    next = next_moment();
  }
  _exit(0);
}

TEST(KilledRecording, OfTwoHoursLacksAtMostTheLastSecond) {
  const test::TempDir dir;
  const fs::path part = dir / "a.h5.part";
  const std::vector<double> rows = sample_rows(RowLayout(1), 0, kTwoHours);
  void* shared = mmap(nullptr, kPage, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(shared, MAP_FAILED);
  auto& handed = *new (shared) std::atomic<std::uint64_t>(0);
  const pid_t child = fork();
  if (child == 0) record_two_hours(dir / "a.h5", rows, handed);

  int moments = 0;
  for (int status = 0; waitpid(child, &status, WUNTRACED) == child && WIFSTOPPED(status);) {
    ++moments;
    std::optional<Session> left;
    EXPECT_EQ(refusal([&] { left = read_session(part); }), "") << handed;
    if (left) {
      EXPECT_GE(left->size() + kSecond, handed);
      EXPECT_EQ(left->changes.size(), (left->size() + 2999) / 3000) << handed;
      EXPECT_EQ(std::memcmp(left->rows.data(), rows.data(), left->rows.size() * sizeof(double)), 0)
          << handed;
    }
    // A stopped process has written the same as a killed one; some really are killed.
    if (moments % 50 == 0) {
      const test::TempDir elsewhere;
      fs::copy(part, elsewhere / "a.h5.part");
      EXPECT_GE(recover_session(elsewhere / "a.h5.part", false).rows + kSecond, handed);
    }
    kill(child, moments == kMoments ? SIGKILL : SIGCONT);
  }
  EXPECT_EQ(moments, kMoments);
  EXPECT_GE(handed, kTwoHours - 200);
  EXPECT_GE(recover_session(part, false).rows + kSecond, handed);
  munmap(shared, kPage);
}

TEST(KilledRecovery, CanBeDoneAgain) {
  const test::TempDir made;
  { SessionWriter(made / "a.h5", sample_info(), false).append(sample_rows(RowLayout(3), 0, 1024)); }
  bool killed = true;
  for (std::size_t pages = 0; killed; pages += 29) {
    const test::TempDir dir;
    fs::copy(made / "a.h5.part", dir / "a.h5.part");
    killed = is_killed_after(pages, [&] { recover_session(dir / "a.h5.part", false); });
    EXPECT_EQ(fs::exists(dir / "a.h5"), !killed) << pages;
    if (killed) {
      EXPECT_EQ(recover_session(dir / "a.h5.part", false).rows, 1024u) << pages;
    }
    expect_sample(read_session(dir / "a.h5"));
    EXPECT_EQ(std::distance(fs::directory_iterator(dir / ""), {}), 1) << pages;
  }
}

TEST(AbandonedRecording, IsLeftAsAKilledOne) {
  const test::TempDir dir;
  {
    SessionWriter writer(dir / "a.h5", sample_info(), false);
    writer.append(sample_rows(RowLayout(3), 0, 1700));
  }
  EXPECT_FALSE(fs::exists(dir / "a.h5"));
  EXPECT_EQ(recover_session(dir / "a.h5.part", false).rows, 1536u);
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

  { SessionWriter(dir / "a.h5", sample_info(), false).append(sample_rows(RowLayout(3), 0, 512)); }
  test::write_file(dir / "a.h5", "precious");
  EXPECT_THAT(refusal([&] { recover_session(dir / "a.h5.part", false); }), HasSubstr("--force"));
  EXPECT_EQ(test::file_bytes(dir / "a.h5"), "precious");
  for (const char* itself : {"a.h5.part", "./a.h5.part"}) {
    EXPECT_THAT(refusal([&] { recover_session(dir / "a.h5.part", true, dir / itself); }),
                HasSubstr("is the file to recover"));
  }
  fs::create_symlink("a.h5.part", dir / "link.h5");
  EXPECT_THAT(refusal([&] { recover_session(dir / "a.h5.part", true, dir / "link.h5"); }),
              HasSubstr("is the file to recover"));
  EXPECT_EQ(recover_session(dir / "a.h5.part", true).rows, 512u);
}

// Exit status of `work` in a child process.
template <class Work>
int exit_status_of(Work work) {
  const pid_t child = fork();
  if (child == 0) {
    int status = 99;
    try {
      status = work();
    } catch (const std::exception&) {
    }
    const rlimit none{RLIM_INFINITY, RLIM_INFINITY};
    setrlimit(RLIMIT_FSIZE, &none);  // the output may go to a file
    disk_left.reset();
    exit(status);  // with the exit handlers of libraries
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// Exit status if files may not grow beyond `bytes`.
int exit_status_with_limit(rlim_t bytes, int (*work)(const fs::path&), const fs::path& out) {
  return exit_status_of([&] {
    const rlimit limit{bytes, RLIM_INFINITY};
    setrlimit(RLIMIT_FSIZE, &limit);
    return work(out);
  });
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
  // Each column takes room for eight seconds before the first takes more. A limit of length
  // therefore ends the recording with the last complete eight seconds.
  for (const rlim_t bytes : {5'000'000, 10'000'001, 13'333'333}) {
    const test::TempDir dir;
    EXPECT_EQ(exit_status_with_limit(bytes, &record_until_it_fails, dir / "a.h5"), 0) << bytes;
    const auto left = read_session(dir / "a.h5.part");
    // A row of three joints takes at most 89 numbers.
    EXPECT_GT(left.size() + 9000, (bytes - 400'000) / (89 * 8)) << bytes;
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
  EXPECT_GE(read_session(dir / "a.h5.part").size(), 500u);
}

int record_on_a_disk_of(std::size_t pages, const fs::path& out) {
  disk_left = pages;
  SessionWriter writer(out, sample_info(), false);
  const RowLayout layout(3);
  std::size_t handed = 0;
  const std::string said = refusal([&] {
    for (; handed < 200000; handed += 100) writer.append(sample_rows(layout, handed, 100));
  });
  if (said.find("No space left on device") == std::string::npos) return 1;
  if (said.find(out.string()) == std::string::npos) return 2;
  return read_session(writer.part()).size() + 1000 >= handed ? 0 : 3;
}

TEST(FullDisk, KeepsAllButTheLastSecond) {
  for (const std::size_t pages : {600, 1000, 1001, 1777}) {
    const test::TempDir dir;
    const auto work = [&] { return record_on_a_disk_of(pages, dir / "a.h5"); };
    EXPECT_EQ(exit_status_of(work), 0) << pages;
    const auto left = read_session(dir / "a.h5.part");
    expect_sample(left);
    // A row takes at most 600 bytes, and its contacts 1536 kB for eight seconds at once. The rows
    // are preceded by 400 kB, and a page may be half empty.
    EXPECT_GT(left.size() + 1000, (pages * 4096 - 600'000 - 1'536'000) / 600) << pages;
  }
}

TEST(FullDisk, KeepsTheLeftoverWhenThereIsNoRoomToRecoverIt) {
  const test::TempDir dir;
  { SessionWriter(dir / "a.h5", sample_info(), false).append(sample_rows(RowLayout(3), 0, 1000)); }
  const std::string left = test::file_bytes(dir / "a.h5.part");
  const auto recover = [](const fs::path& part) {
    const std::string said = refusal([&] { recover_session(part, false); });
    return said.find("File too large") == std::string::npos ? 1 : 0;
  };
  for (const rlim_t bytes : {5000, 300'000, 500'000}) {
    EXPECT_EQ(exit_status_with_limit(bytes, recover, dir / "a.h5.part"), 0) << bytes;
    EXPECT_EQ(test::file_bytes(dir / "a.h5.part"), left) << bytes;
    EXPECT_EQ(std::distance(fs::directory_iterator(dir / ""), {}), 1) << bytes;
  }
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

// Replaces the function that HDF5 writes with. The kernel copies page by page and looks for a
// deadly signal in between, so a killed program's last write can end only where a page does.
extern "C" ssize_t pwrite(int file, const void* data, size_t size, off_t at) {
  const auto begin = static_cast<std::size_t>(at);
  if (limpid::disk_left) {
    const std::size_t room = limpid::room_on_disk(begin, size);
    if (room == 0) return errno = ENOSPC, -1;
    size = room;
  }
  const std::size_t to_page_end = limpid::kPage - begin % limpid::kPage;
  if (limpid::stopping && limpid::stopping->wanted &&
      (size > to_page_end || --limpid::stopping->patience < 0)) {
    limpid::stopping->wanted = false;
    const std::size_t first = std::min(size, to_page_end);
    syscall(SYS_pwrite64, file, data, first, at);
    raise(SIGSTOP);
    if (first == size) return static_cast<ssize_t>(size);
    const ssize_t rest = syscall(SYS_pwrite64, file, static_cast<const char*>(data) + first,
                                 size - first, begin + first);
    return rest < 0 ? rest : static_cast<ssize_t>(first) + rest;
  }
  const std::size_t pages = (begin % limpid::kPage + size + limpid::kPage - 1) / limpid::kPage;
  const bool dies = limpid::pages_left && *limpid::pages_left < pages;
  if (dies)
    size =
        *limpid::pages_left == 0 ? 0 : *limpid::pages_left * limpid::kPage - begin % limpid::kPage;
  const ssize_t written = syscall(SYS_pwrite64, file, data, size, at);
  if (dies) raise(SIGKILL);
  if (limpid::pages_left) *limpid::pages_left -= pages;
  return written;
}
