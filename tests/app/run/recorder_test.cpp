#include "app/run/recorder.h"

#include <sys/resource.h>

#include <cstring>
#include <vector>

#include "tests/devices/files/session/sample_session.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

using test::sample_info;
using test::sample_rows;
using testing::HasSubstr;

class RecorderOfJoints : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Arms, RecorderOfJoints, testing::Values(1, 3, 32));

TEST_P(RecorderOfJoints, WritesEveryRowInOrder) {
  const test::TempDir dir;
  const SessionInfo info = sample_info(GetParam());
  const RowLayout layout(info.dof);
  constexpr std::size_t kRows = 5000;
  const std::vector<double> rows = sample_rows(layout, 0, kRows);
  const auto stride = static_cast<std::size_t>(layout.stride());
  Recorder recorder(dir / "a.h5", info, Parameters{}, false);
  for (std::size_t k = 0; k < kRows; ++k) {
    ASSERT_TRUE(recorder.push_waiting(std::span(rows).subspan(k * stride, stride)));
  }
  EXPECT_EQ(recorder.rows(), kRows);
  recorder.finish();
  EXPECT_EQ(recorder.dropped(), 0u);
  const Session session = read_session(dir / "a.h5");
  ASSERT_EQ(session.size(), kRows);
  EXPECT_EQ(std::memcmp(session.rows.data(), rows.data(), rows.size() * sizeof(double)), 0);
}

TEST(Recorder, KeepsMarksAtRowsThatThereAre) {
  const test::TempDir dir;
  const SessionInfo info = sample_info(3);
  Recorder recorder(dir / "a.h5", info, Parameters{}, false);
  EXPECT_EQ(recorder.newest(), 0u);
  recorder.mark({0, "before the first row"});
  const RowLayout layout(3);
  const auto stride = static_cast<std::size_t>(layout.stride());
  const std::vector<double> rows = sample_rows(layout, 0, 900);
  for (std::size_t k = 0; k < 900; ++k) {
    ASSERT_TRUE(recorder.push_waiting(std::span(rows).subspan(k * stride, stride)));
    if (k == 450) recorder.mark({recorder.newest(), "in the middle"});
  }
  recorder.mark({5000, "behind the end"});
  EXPECT_THROW(recorder.mark({1, std::string(kMarkLength + 1, 'x')}), FileError);
  recorder.finish();
  EXPECT_EQ(read_session(dir / "a.h5").marks,
            (std::vector<Mark>{
                {0, "before the first row"}, {450, "in the middle"}, {899, "behind the end"}}));
}

// A further mark would make the recording unreadable: it is refused, and the recording goes on.
TEST(Recorder, TakesAsManyMarksAsTheReaderDoes) {
  const test::TempDir dir;
  Recorder recorder(dir / "a.h5", sample_info(3), Parameters{}, false);
  const std::vector<double> rows = sample_rows(RowLayout(3), 0, 1);
  ASSERT_TRUE(recorder.push_waiting(rows));
  for (std::size_t i = 0; i < kMostMarks; ++i) recorder.mark({0, "x"});
  EXPECT_THROW(recorder.mark({0, "one more"}), FileError);
  recorder.finish();
  EXPECT_EQ(read_session(dir / "a.h5").marks.size(), kMostMarks);
}

// A file without rows has no moment to mark: it would be refused when it is read.
TEST(Recorder, KeepsNoMarksWithoutRows) {
  const test::TempDir dir;
  Recorder recorder(dir / "a.h5", sample_info(3), Parameters{}, false);
  recorder.mark({0, "too early"});
  recorder.finish();
  EXPECT_TRUE(read_session(dir / "a.h5").marks.empty());
}

TEST(Recorder, WritesWhatBodiesBeginWithBeforeTheFirstRow) {
  const test::TempDir dir;
  SessionInfo info = sample_info(3);
  info.bodies = {"die"};
  info.beside = {""};
  Recorder recorder(dir / "a.h5", info, std::vector<Parameters>(2), false);
  const std::vector<double> world{1, 2, 3}, other{4, 5};
  recorder.begins(world);
  recorder.begins(other, kTwinLane);
  const auto row = sample_rows(info.layout(), 0, 1);
  std::vector<double> both = row;
  both.insert(both.end(), row.begin(), row.end());
  ASSERT_TRUE(recorder.push(both));
  recorder.finish();
  EXPECT_EQ(recorder.dropped(), 0u);
  const Session session = read_session(dir / "a.h5");
  EXPECT_EQ(session.world, world);
  EXPECT_EQ(session.lane(kTwinLane).world, other);
  EXPECT_EQ(session.info.bodies, info.bodies);
}

TEST(Recorder, WritesChangesBesideTheRowTheyHoldFrom) {
  const test::TempDir dir;
  const RowLayout layout(3);
  Recorder recorder(dir / "a.h5", sample_info(3), Parameters{}, false);
  Parameters p;
  for (std::size_t k = 0; k < 100; ++k) {
    if (k == 40) {
      p.k_vc = 8;
      p.kind = CouplingKind::standard;
      recorder.changed(p);
    }
    if (k == 70) {
      p.damping = 0.1;
      recorder.changed(p);
    }
    if (k == 90) {
      p.damping = kFromArm;
      recorder.changed(p);
    }
    ASSERT_TRUE(recorder.push(sample_rows(layout, k, 1)));
  }
  recorder.changed(p);  // no change
  recorder.finish();
  const auto changes = read_session(dir / "a.h5").changes;
  ASSERT_EQ(changes.size(), 4u);
  EXPECT_EQ(changes[0].row, 40u);
  EXPECT_EQ(changes[0].setting, "coupling.kind = \"standard\"");
  EXPECT_EQ(changes[1].row, 40u);
  EXPECT_EQ(changes[1].setting, "coupling.k_vc = 8.0");
  EXPECT_EQ(changes[2].row, 70u);
  EXPECT_EQ(changes[2].key(), "device.damping");
  EXPECT_EQ(changes[3].row, 90u);
  EXPECT_EQ(changes[3].key(), "device.damping");
}

TEST(Recorder, LeavesAPartThatCanBeRecoveredIfItIsNotFinished) {
  const test::TempDir dir;
  const RowLayout layout(3);
  {
    Recorder recorder(dir / "a.h5", sample_info(3), Parameters{}, false);
    for (std::size_t k = 0; k < 2000; ++k) {
      ASSERT_TRUE(recorder.push_waiting(sample_rows(layout, k, 1)));
    }
  }
  EXPECT_FALSE(std::filesystem::exists(dir / "a.h5"));
  EXPECT_EQ(recover_session(dir / "a.h5.part", false).file, dir / "a.h5");
  const Session session = read_session(dir / "a.h5");
  EXPECT_EQ(session.size(), 3 * 512u) << "every block that was full";
  const auto wanted = sample_rows(layout, 0, session.size());
  EXPECT_EQ(std::memcmp(session.rows.data(), wanted.data(), wanted.size() * sizeof(double)), 0);
}

// Changes come faster than the writing thread takes them, as it rests between its rounds.
TEST(Recorder, CountsChangesThatFoundNoRoom) {
  const test::TempDir dir;
  Recorder recorder(dir / "a.h5", sample_info(3), Parameters{}, false);
  Parameters p;
  std::uint64_t refused = 0, kept = 0;
  for (int i = 0; refused < 10 && i < 10'000'000; ++i) {
    p.k_vc = 5 + 1e-6 * i;
    recorder.changed(p) ? ++kept : ++refused;
  }
  ASSERT_GE(refused, 10u);
  EXPECT_EQ(recorder.dropped(), refused);
  ASSERT_TRUE(recorder.push_waiting(sample_rows(RowLayout(3), 0, 1)));
  recorder.finish();
  EXPECT_EQ(recorder.dropped(), refused);
  EXPECT_EQ(read_session(dir / "a.h5").changes.size(), kept);
}

// Limits files of this program to `bytes` during its life.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &before_); }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
};

TEST(Recorder, LetsTheRunGoOnWhenTheDiskIsFullAndKeepsWhatWasWritten) {
  const test::TempDir dir;
  const RowLayout layout(3);
  std::size_t pushed = 0;
  std::string said;
  {
    const std::size_t chunk = 8000 * static_cast<std::size_t>(layout.stride()) * sizeof(double);
    const FileSizeLimit limit(2 * chunk + chunk / 8);  // a second chunk of rows, but no third
    Recorder recorder(dir / "a.h5", sample_info(3), Parameters{}, false);
    while (recorder.push_waiting(sample_rows(layout, pushed, 1)) && pushed < 200'000) ++pushed;
    EXPECT_TRUE(recorder.failed());
    // A loop with a clock neither waits for a failed recorder nor ends.
    for (int k = 0; k < 100'000; ++k) recorder.push(sample_rows(layout, pushed, 1));
    EXPECT_GT(recorder.dropped(), 0u);
    EXPECT_THAT(recorder.error(), HasSubstr("File too large"));
    EXPECT_THAT(recorder.error(), HasSubstr("a.h5.part"));
    said = test::refusal([&] { recorder.finish(); });
  }
  EXPECT_THAT(said, HasSubstr("File too large"));
  const Session left = read_session(dir / "a.h5.part");
  EXPECT_GT(left.size(), 8000u);
  EXPECT_LE(left.size(), pushed);
  const auto wanted = sample_rows(layout, 0, left.size());
  EXPECT_EQ(std::memcmp(left.rows.data(), wanted.data(), wanted.size() * sizeof(double)), 0);
  EXPECT_EQ(recover_session(dir / "a.h5.part", false).rows, left.size());
}

TEST(Recorder, RefusesAtOnceWhatItCannotWrite) {
  const test::TempDir dir;
  EXPECT_THAT(test::refusal([&] {
                Recorder(dir / "no/such/folder/a.h5", sample_info(3), Parameters{}, false);
              }),
              HasSubstr("no/such/folder"));
  test::write_file(dir / "a.h5", "mine");
  EXPECT_THAT(test::refusal([&] { Recorder(dir / "a.h5", sample_info(3), Parameters{}, false); }),
              HasSubstr("a.h5"));
  EXPECT_EQ(test::file_bytes(dir / "a.h5"), "mine");
}

TEST(Recorder, SaysThatItEndedByItselfAndHowToSaveThePart) {
  const test::TempDir dir;
  const std::string file = (dir / "a.h5").string();
  const RowLayout layout(3);
  const std::size_t chunk = 8000 * static_cast<std::size_t>(layout.stride()) * sizeof(double);
  const FileSizeLimit limit(2 * chunk + chunk / 8);
  Recorder recorder(file, sample_info(3), Parameters{}, false);
  EXPECT_FALSE(recorder.failed());
  EXPECT_EQ(lock_note(recorder), recorder.is_locked() ? ""
                                                      : file +
                                                            ": the file system has no locks; no "
                                                            "other program may record into this "
                                                            "file");
  const std::vector<double> row = sample_rows(layout, 0, 1);
  for (int k = 0; k < 200'000 && recorder.push_waiting(row); ++k) continue;
  ASSERT_TRUE(recorder.failed());
  EXPECT_FALSE(recorder.push_waiting(row)) << "nobody waits for a recording that has failed";
  EXPECT_EQ(why_it_ended(recorder), "the recording has ended by itself: " + recorder.error() +
                                        "; `limpid recover " + file +
                                        ".part` saves the recorded part");
}

// Two lanes' rows and settings, told apart in one file.
TEST(Recorder, KeepsTheRowsAndChangesOfEachLaneApart) {
  const test::TempDir dir;
  SessionInfo info = sample_info(3);
  info.beside = {""};
  Recorder recorder(dir / "a.h5", info, std::vector<Parameters>(2), false);
  const RowLayout layout(3);
  const auto stride = static_cast<std::size_t>(layout.stride());
  EXPECT_EQ(recorder.lanes(), 2u);
  EXPECT_EQ(recorder.stride(), 2 * stride);
  Parameters p;
  for (std::size_t k = 0; k < 700; ++k) {
    if (k == 300) {
      p.k_vc = 8;
      EXPECT_TRUE(recorder.changed(p, kTwinLane));
    }
    std::vector<double> both = sample_rows(layout, k, 1);
    const std::vector<double> twin = sample_rows(layout, 5000 + k, 1);
    both.insert(both.end(), twin.begin(), twin.end());
    ASSERT_TRUE(recorder.push_waiting(both));
    EXPECT_EQ(recorder.newest(), k);
  }
  recorder.finish();
  const Session session = read_session(dir / "a.h5");
  ASSERT_EQ(session.lanes(), 2u);
  const auto first = sample_rows(layout, 0, 700), twin = sample_rows(layout, 5000, 700);
  EXPECT_TRUE(test::same_numbers(session.rows, first));
  EXPECT_TRUE(test::same_numbers(session.lane(kTwinLane).rows, twin));
  EXPECT_TRUE(session.changes.empty());
  ASSERT_EQ(session.lane(kTwinLane).changes.size(), 1u);
  EXPECT_EQ(session.lane(kTwinLane).changes[0].row, 300u);
  EXPECT_EQ(session.lane(kTwinLane).changes[0].setting, "coupling.k_vc = 8.0");
}

}  // namespace
}  // namespace limpid
