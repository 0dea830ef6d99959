// Marks that people set at moments of a session, and their survival of whatever happens to the
// file.
#include "devices/files/session/session_marks.h"

#include <hdf5.h>
#include <sys/resource.h>

#include <array>
#include <thread>

#include "tests/devices/files/session/sample_session.h"
#include "tests/devices/files/test_files.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using test::refusal;
using test::sample_info;
using test::sample_rows;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<Mark> marks_of(const fs::path& file) { return read_session(file).marks; }

TEST(Marks, AreKeptWithWhatIsRecordedInTheOrderOfTheirTicks) {
  const test::TempDir dir;
  SessionWriter writer(dir / "a.h5", sample_info(3), false);
  writer.append(Mark{600, "\xCE\xB7 too small?"});
  writer.append(sample_rows(RowLayout(3), 0, 700));
  writer.append(Mark{2, "the hand touches"});
  writer.close();
  EXPECT_THAT(marks_of(dir / "a.h5"),
              ElementsAre(Mark{2, "the hand touches"}, Mark{600, "\xCE\xB7 too small?"}));
}

TEST(Marks, OfASessionWithoutAnyAreNone) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 10);
  EXPECT_THAT(marks_of(dir / "a.h5"), IsEmpty());
}

// Programs that take every list with a unit for a channel would cut all channels to the marks'
// length.
TEST(Marks, HaveNoUnit) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 10);
  const hdf5::File file = hdf5::open_to_read(dir / "a.h5");
  for (const char* path : {kMarkTickPath, kMarkTextPath}) {
    const hdf5::Dataset list = hdf5::open_dataset(file.get(), path, dir / "a.h5");
    EXPECT_EQ(H5Aexists(list.get(), "unit"), 0) << path;
  }
}

// A killed recording keeps the marks that were on the disk with their rows.
TEST(Marks, AreRecoveredWithTheRowsTheyBelongTo) {
  const test::TempDir dir;
  {
    SessionWriter writer(dir / "a.h5", sample_info(3), false);
    writer.append(Mark{100, "early"});
    writer.append(sample_rows(RowLayout(3), 0, 512));
    writer.append(Mark{1150, "of a row that is lost"});
    writer.append(sample_rows(RowLayout(3), 512, 700));
  }
  EXPECT_THAT(marks_of(dir / "a.h5.part"), ElementsAre(Mark{100, "early"}));
  recover_session(dir / "a.h5.part", false);
  EXPECT_THAT(marks_of(dir / "a.h5"), ElementsAre(Mark{100, "early"}));
}

TEST(Marks, AreReplacedInAWholeNewFile) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 600);
  fs::create_hard_link(dir / "a.h5", dir / "before.h5");
  const std::string before = test::file_bytes(dir / "a.h5");
  const LargeVector<double> rows = read_session(dir / "a.h5").rows;
  const std::vector<Mark> first{{5, "one"}, {500, "two"}}, second{{599, "three"}};
  write_marks(dir / "a.h5", first, {});
  EXPECT_EQ(marks_of(dir / "a.h5"), first);
  write_marks(dir / "a.h5", second, first);
  EXPECT_EQ(marks_of(dir / "a.h5"), second);
  EXPECT_EQ(read_session(dir / "a.h5").rows, rows);
  write_marks(dir / "a.h5", {}, second);
  EXPECT_THAT(marks_of(dir / "a.h5"), IsEmpty());
  EXPECT_EQ(test::file_bytes(dir / "before.h5"), before) << "the finished file was written to";
  EXPECT_EQ(std::distance(fs::directory_iterator(dir / ""), {}), 2);
}

// Sessions of earlier editions have no list of marks; they get one.
TEST(Marks, AreGivenToASessionThatHasNoListOfThem) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 10);
  {
    const hdf5::Quiet quiet;
    hdf5::File file(H5Fopen((dir / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
    ASSERT_GE(H5Ldelete(file.get(), "marks", H5P_DEFAULT), 0);
  }
  EXPECT_THAT(marks_of(dir / "a.h5"), IsEmpty());
  const std::vector<Mark> some{{3, "there"}};
  write_marks(dir / "a.h5", some, {});
  EXPECT_EQ(marks_of(dir / "a.h5"), some);
}

// The shell's limit of file size stands for a full disk: it stops the copy, and the session stays
// unchanged.
TEST(Marks, ThatCannotBeWrittenLeaveTheSessionAsItIs) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 600);
  const std::vector<Mark> first{{5, "one"}};
  write_marks(dir / "a.h5", first, {});
  const std::string before = test::file_bytes(dir / "a.h5");
  const std::vector<Mark> many(5000, Mark{1, std::string(kMarkLength, 'x')});
  for (const std::size_t room : {before.size() / 2, before.size() + 20'000}) {
    rlimit usual{};
    getrlimit(RLIMIT_FSIZE, &usual);
    const rlimit limit{room, usual.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    const std::string said = refusal([&] { write_marks(dir / "a.h5", many, first); });
    setrlimit(RLIMIT_FSIZE, &usual);
    EXPECT_THAT(said, HasSubstr("a.h5")) << room;
    EXPECT_EQ(test::file_bytes(dir / "a.h5"), before) << room;
    EXPECT_EQ(std::distance(fs::directory_iterator(dir / ""), {}), 1) << room;
  }
}

TEST(Marks, OfTooLongATextAreRefused) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 10);
  const std::vector<Mark> longer{{1, std::string(kMarkLength + 1, 'x')}};
  EXPECT_THAT(refusal([&] { write_marks(dir / "a.h5", longer, {}); }),
              testing::AllOf(HasSubstr("201 bytes"), HasSubstr("200")));
  const std::vector<Mark> longest{{1, std::string(kMarkLength, 'x')}};
  write_marks(dir / "a.h5", longest, {});
  EXPECT_EQ(marks_of(dir / "a.h5"), longest);
}

// Two windows show one recording: the marks of both stay.
TEST(Marks, OfAnotherProgramStay) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 100);
  const std::vector<Mark> mine{{5, "mine"}}, others{{50, "another's"}}, changed{{6, "mine"}};
  write_marks(dir / "a.h5", mine, {});
  write_marks(dir / "a.h5", others, {});
  EXPECT_THAT(marks_of(dir / "a.h5"), ElementsAre(mine[0], others[0]));
  write_marks(dir / "a.h5", changed, mine);
  EXPECT_THAT(marks_of(dir / "a.h5"), ElementsAre(changed[0], others[0]));
}

TEST(Marks, OfManyProgramsAtATimeAreAllKept) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 600);
  std::vector<Mark> all;
  {
    std::vector<std::jthread> programs;
    for (std::uint64_t i = 0; i < 6; ++i) {
      all.push_back({i, "of its own"});
      programs.emplace_back(
          [&dir, one = all.back()] { write_marks(dir / "a.h5", std::span(&one, 1), {}); });
    }
  }
  EXPECT_EQ(marks_of(dir / "a.h5"), all);
  EXPECT_EQ(std::distance(fs::directory_iterator(dir / ""), {}), 1);
}

// A shorter recording has taken the name.
TEST(Marks, OfRowsThatAreNotThereAnyMoreAreRefused) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 10);
  const std::string before = test::file_bytes(dir / "a.h5");
  const std::vector<Mark> behind{{10, "was there"}};
  EXPECT_THAT(refusal([&] { write_marks(dir / "a.h5", behind, {}); }),
              testing::AllOf(HasSubstr("10 rows"), HasSubstr("row 10 cannot be marked")));
  EXPECT_EQ(test::file_bytes(dir / "a.h5"), before);
}

TEST(Marks, GoThroughALinkAndLeaveItOne) {
  const test::TempDir dir;
  fs::create_directory(dir / "elsewhere");
  test::write_sample(dir / "elsewhere/a.h5", 10);
  fs::permissions(dir / "elsewhere/a.h5", fs::perms(0640));
  fs::create_symlink("elsewhere/a.h5", dir / "link.h5");
  const std::vector<Mark> one{{9, "last"}};
  write_marks(dir / "link.h5", one, {});
  EXPECT_TRUE(fs::is_symlink(dir / "link.h5"));
  EXPECT_EQ(marks_of(dir / "elsewhere/a.h5"), one);
  EXPECT_EQ(fs::status(dir / "elsewhere/a.h5").permissions(), fs::perms(0640));
}

// The reader takes so many; one more would make the recording unreadable.
TEST(Marks, AreNoMoreThanTheReaderTakes) {
  const test::TempDir dir;
  SessionWriter writer(dir / "a.h5", sample_info(3), false);
  for (std::size_t i = 0; i < kMostMarks; ++i) writer.append(Mark{0, "x"});
  EXPECT_THAT(refusal([&] { writer.append(Mark{0, "one more"}); }), HasSubstr("100000 marks"));
  writer.append(sample_rows(RowLayout(3), 0, 10));
  writer.close();
  EXPECT_EQ(marks_of(dir / "a.h5").size(), kMostMarks);
  const std::vector<Mark> more{{1, "one more"}};
  EXPECT_THAT(refusal([&] { write_marks(dir / "a.h5", more, {}); }), HasSubstr("100001 marks"));
}

// Another program's file has marks behind the end, lists of another length or type.
TEST(Marks, OfAStrangersFileAreNotBelieved) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 10);
  const std::vector<Mark> one{{9, "last"}};
  write_marks(dir / "a.h5", one, {});
  const auto with = [&](const auto& change) {
    fs::copy_file(dir / "a.h5", dir / "b.h5", fs::copy_options::overwrite_existing);
    const hdf5::Quiet quiet;
    {
      hdf5::File file(H5Fopen((dir / "b.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
      change(file.get());
    }
    return refusal([&] { read_session(dir / "b.h5"); });
  };
  EXPECT_THAT(with([](hid_t file) {
                const hdf5::Dataset ticks(H5Dopen2(file, kMarkTickPath, H5P_DEFAULT));
                const std::uint64_t behind = 10;
                H5Dwrite(ticks.get(), H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &behind);
              }),
              testing::AllOf(HasSubstr("/marks/tick"), HasSubstr("row 10"), HasSubstr("0 to 9")));
  EXPECT_THAT(with([](hid_t file) {
                const hdf5::Dataset ticks(H5Dopen2(file, kMarkTickPath, H5P_DEFAULT));
                const std::array<hsize_t, 1> two{2};
                H5Dset_extent(ticks.get(), two.data());
              }),
              HasSubstr("differ in length"));
  EXPECT_THAT(with([](hid_t file) {
                H5Ldelete(file, kMarkTextPath, H5P_DEFAULT);
                H5Lcreate_hard(file, kMarkTickPath, file, kMarkTextPath, H5P_DEFAULT, H5P_DEFAULT);
              }),
              HasSubstr("not text of at most 200 bytes"));
}

}  // namespace
}  // namespace limpid
