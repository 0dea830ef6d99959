// Session files that are cut, scrambled, or made by programs that got them wrong.
#include <fcntl.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>

#include "core/base/descriptor.h"
#include "core/coupling/laws.h"
#include "devices/files/session/hand_file.h"
#include "devices/files/session/hdf5_reading.h"
#include "devices/files/session/session.h"
#include "devices/files/session/session_file.h"
#include "devices/files/session/session_source.h"
#include "tests/devices/files/session/sample_session.h"
#include "tests/devices/files/test_files.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using test::refusal;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;

TEST(ReasonsOfHdf5, AreItsOwnWhereTheSystemHasNone) {
  const hdf5::Quiet quiet;
  EXPECT_LT(H5Dopen2(H5I_INVALID_HID, "rows", H5P_DEFAULT), 0);
  EXPECT_THAT(hdf5::last_error(), AnyOf(HasSubstr("location"), HasSubstr("identifier")));
}

TEST(DamagedSession, IsRefusedWhereverItIsCut) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 700);
  const std::string whole = test::file_bytes(dir / "a.h5");
  std::mt19937 random(3);
  for (int round = 0; round < 60; ++round) {
    const std::size_t length =
        round < 20 ? static_cast<std::size_t>(round) * 97 : random() % whole.size();
    test::write_file(dir / "cut.h5", whole.substr(0, length));
    EXPECT_THAT(refusal([&] { read_session(dir / "cut.h5"); }), HasSubstr("cut.h5")) << length;
    test::write_file(dir / "cut.h5.part", whole.substr(0, length));
    refusal([&] { read_session(dir / "cut.h5.part"); });  // gives rows or a refusal, never a crash
  }
}

TEST(DamagedSession, ThatWasCopiedInPartSaysHowMuchOfItIsThere) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 5000);
  const std::string whole = test::file_bytes(dir / "a.h5");
  ASSERT_GT(whole.size(), 200'000u);
  test::write_file(dir / "cut.h5", whole.substr(0, 100'000));
  EXPECT_THAT(refusal([&] { read_session(dir / "cut.h5"); }),
              AllOf(HasSubstr("ends after 0.1 of "), HasSubstr("copied completely")));
}

TEST(DamagedSession, NeverCrashesTheReader) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 700);
  const std::string whole = test::file_bytes(dir / "a.h5");
  std::mt19937 random(5);
  int refused = 0;
  for (int round = 0; round < 150; ++round) {
    std::string broken = whole;
    const std::size_t count = 1 + random() % 40;
    const std::size_t within = round % 2 ? whole.size() : whole.size() / 8;  // headers come first
    for (std::size_t i = 0; i < count; ++i) broken[random() % within] ^= char(1 + random() % 255);
    const fs::path file = dir / (round % 3 ? "b.h5" : "b.h5.part");
    test::write_file(file, broken);
    refused += refusal([&] { read_session(file); }).empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 50);
}

TEST(DamagedSession, SaysWhichRowsAreScrambled) {
  const test::TempDir dir;
  {
    const Descriptor made(open((dir / "a.h5").c_str(), O_RDWR | O_CREAT, 0600));
    SessionFile file(dir / "a.h5", *made, test::sample_info(), Storage::safe);
    file.append(test::sample_rows(RowLayout(3), 0, 5000));
    file.close();
  }
  std::string bytes = test::file_bytes(dir / "a.h5");
  double wanted = 4.321;  // /time of row 4321
  const std::size_t at = bytes.find(std::string(reinterpret_cast<char*>(&wanted), sizeof wanted));
  ASSERT_NE(at, std::string::npos);
  bytes[at] ^= 1;
  test::write_file(dir / "a.h5", bytes);
  EXPECT_THAT(refusal([&] { read_session(dir / "a.h5"); }), HasSubstr("/time"));
  test::write_file(dir / "a.h5.part", bytes);
  EXPECT_LE(read_session(dir / "a.h5.part").size(), 4321u);
}

// Puts a list in place of another whose bytes are not those that HDF5 has its sum of.
void put_unreadable(hid_t file, const char* path) {
  const hid_t before = H5Dopen2(file, path, H5P_DEFAULT);
  const hid_t type = H5Dget_type(before);
  H5Dclose(before);
  H5Ldelete(file, path, H5P_DEFAULT);
  const hsize_t one = 1, first = 0;
  const hid_t space = H5Screate_simple(1, &one, nullptr);
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(creation, 1, &one);
  H5Pset_fletcher32(creation);
  const hid_t data = H5Dcreate2(file, path, type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
  const std::string bytes(H5Tget_size(type) + 4, 'x');
  EXPECT_GE(H5Dwrite_chunk(data, H5P_DEFAULT, 0, &first, bytes.size(), bytes.data()), 0);
  H5Dclose(data);
  H5Pclose(creation);
  H5Sclose(space);
  H5Tclose(type);
}

TEST(DamagedSession, SaysWhichListBesideTheRowsCannotBeRead) {
  for (const char* path : {kEventRowPath, kEventSettingPath, kMarkTickPath, kMarkTextPath}) {
    const test::TempDir dir;
    test::write_sample(dir / "a.h5", 50);
    write_marks(dir / "a.h5", std::vector<Mark>{{5, "here"}}, {});
    const hid_t file = H5Fopen((dir / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    put_unreadable(file, path);
    H5Fclose(file);
    EXPECT_THAT(refusal([&] { read_session(dir / "a.h5"); }),
                AllOf(HasSubstr(path), HasSubstr("cannot be read")));
  }
}

// Extends all columns by `rows` beyond the written ones.
void extend(const fs::path& file, hsize_t rows) {
  const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  for (const ColumnInfo& column : kColumnInfo) {
    if (!RowLayout(3).has(column.column)) continue;
    const hid_t data = H5Dopen2(opened, column.path, H5P_DEFAULT);
    const hid_t space = H5Dget_space(data);
    std::array<hsize_t, 2> extent{};
    H5Sget_simple_extent_dims(space, extent.data(), nullptr);
    extent[0] += rows;
    EXPECT_GE(H5Dset_extent(data, extent.data()), 0) << column.path;
    H5Sclose(space);
    H5Dclose(data);
  }
  H5Fclose(opened);
}

TEST(DamagedSession, DoesNotTakeRowsForRealThatWereNeverWritten) {
  for (const hsize_t rows : {1, 511, 512, 9000}) {
    const test::TempDir dir;
    test::write_sample(dir / "a.h5", 1024);
    extend(dir / "a.h5", rows);
    fs::copy(dir / "a.h5", dir / "b.h5.part");
    EXPECT_NE(refusal([&] { read_session(dir / "a.h5"); }), "") << rows;
    EXPECT_EQ(read_session(dir / "b.h5.part").size(), 1024u) << rows;
  }
}

TEST(DamagedSession, IsNoticedByASingleNumberThatIsAnother) {
  for (const ColumnInfo& column : kColumnInfo) {
    if (!summed(RowLayout(3), column)) continue;  // durations of ticks have no sum
    const test::TempDir dir;
    test::write_sample(dir / "a.h5", 1200);
    {
      const hid_t file = H5Fopen((dir / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
      const hid_t data = H5Dopen2(file, column.path, H5P_DEFAULT);
      const hid_t space = H5Dget_space(data);
      const hsize_t one = 1;
      const hid_t memory = H5Screate_simple(1, &one, nullptr);
      const std::array<hsize_t, 2> at{700, 0};
      H5Sselect_elements(space, H5S_SELECT_SET, 1, at.data());
      double value = 0;
      H5Dread(data, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, &value);
      value = column.byte ? 1 - std::min(value, 1.0) : std::nextafter(value, 10.0);
      H5Dwrite(data, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, &value);
      H5Sclose(memory);
      H5Sclose(space);
      H5Dclose(data);
      H5Fclose(file);
    }
    EXPECT_THAT(refusal([&] { read_session(dir / "a.h5"); }),
                AllOf(HasSubstr(column.path), HasSubstr("rows 512 to 1023")));
    fs::copy(dir / "a.h5", dir / "b.h5.part");
    EXPECT_EQ(read_session(dir / "b.h5.part").size(), 512u);
  }
}

TEST(Session, RefusesAFileThatIsNotHdf5) {
  const test::TempDir dir;
  for (const std::string& text :
       {std::string(), std::string("time_s,x_m\n"), std::string(10000, '\0')}) {
    test::write_file(dir / "a.h5", text);
    EXPECT_THAT(refusal([&] { read_session(dir / "a.h5"); }), HasSubstr("not an HDF5 file"));
  }
  EXPECT_THAT(refusal([&] { read_session(dir / "none.h5"); }), HasSubstr("no such file"));
  EXPECT_THAT(refusal([] { read_session("/tmp"); }), HasSubstr("/tmp"));
}

TEST(Session, SaysHowToSaveAFileThatWasRenamedInsteadOfRecovered) {
  const test::TempDir dir;
  {
    SessionWriter writer(dir / "a.h5", test::sample_info(), false);
    writer.append(test::sample_rows(RowLayout(3), 0, 1000));
  }
  fs::rename(dir / "a.h5.part", dir / "a.h5");
  EXPECT_THAT(refusal([&] { read_session(dir / "a.h5"); }), HasSubstr("limpid recover"));
}

// Changes a good file with HDF5 itself, as somebody else's program might.
class Vandal {
 public:
  explicit Vandal(const fs::path& file) : file_(H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT)) {}
  ~Vandal() { H5Fclose(file_); }
  Vandal(const Vandal&) = delete;
  Vandal& operator=(const Vandal&) = delete;

  void remove(const char* path) { H5Ldelete(file_, path, H5P_DEFAULT); }
  void remove_attribute(const char* name) { H5Adelete(file_, name); }

  template <class T>
  void attribute(const char* name, hid_t type, T value, hsize_t count = 1) {
    H5Adelete(file_, name);
    const hid_t space = H5Screate_simple(1, &count, nullptr);
    const hid_t made = H5Acreate2(file_, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    const std::vector<T> values(count, value);
    H5Awrite(made, type, values.data());
    H5Aclose(made);
    H5Sclose(space);
  }

  void dataset(const char* path, hid_t type, std::vector<hsize_t> shape) {
    H5Ldelete(file_, path, H5P_DEFAULT);
    const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
    H5Dclose(H5Dcreate2(file_, path, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    H5Sclose(space);
  }

  void number(const char* path, hsize_t element, double value) {
    const hid_t data = H5Dopen2(file_, path, H5P_DEFAULT);
    const hid_t space = H5Dget_space(data);
    const hsize_t one = 1;
    const hid_t memory = H5Screate_simple(1, &one, nullptr);
    const std::array<hsize_t, 2> at{element, 0};
    H5Sselect_elements(space, H5S_SELECT_SET, 1, at.data());
    H5Dwrite(data, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, &value);
    H5Sclose(memory);
    H5Sclose(space);
    H5Dclose(data);
  }

 private:
  hid_t file_;
};

TEST(ForeignSession, IsRefusedWithWhatIsWrong) {
  struct Case {
    std::function<void(Vandal&)> spoil;
    std::vector<std::string> said;
  };
  const Case cases[] = {
      {[](Vandal& v) { v.remove("/time"); }, {"/time", "missing"}},
      {[](Vandal& v) { v.remove("/hand"); }, {"/hand/target", "missing"}},
      {[](Vandal& v) { v.remove("/proxy/velocity"); }, {"/proxy/velocity", "missing"}},
      {[](Vandal& v) { v.dataset("/time", H5T_IEEE_F64LE, {49}); }, {"/time", "49", "50"}},
      {[](Vandal& v) {
         v.dataset("/hand/target", H5T_IEEE_F64LE, {50, 2});
       },
       {"/hand/target", "2 wide", "N x 3"}},
      {[](Vandal& v) { v.dataset("/hand/target", H5T_IEEE_F64LE, {150}); }, {"/hand/target"}},
      {[](Vandal& v) {
         v.dataset("/hand/target", H5T_IEEE_F64LE, {5, 10, 3});
       },
       {"/hand/target"}},
      {[](Vandal& v) { v.dataset("/coupling/eta", H5T_STD_I32LE, {50}); },
       {"/coupling/eta", "float64"}},
      {[](Vandal& v) { v.dataset("/coupling/eta", H5T_STD_I64LE, {50}); },
       {"/coupling/eta", "float64"}},
      {[](Vandal& v) { v.dataset("/coupling/kind", H5T_IEEE_F64LE, {50}); },
       {"/coupling/kind", "uint8"}},
      {[](Vandal& v) { v.dataset("/coupling/eta", H5T_C_S1, {50}); }, {"/coupling/eta"}},
      {[](Vandal& v) { v.dataset("/time", H5T_IEEE_F64LE, {50}); }, {"/time", "row 1", "increas"}},
      {[](Vandal& v) { v.number("/time", 7, NAN); }, {"/time", "row 7", "nan"}},
      {[](Vandal& v) { v.number("/time", 7, INFINITY); }, {"/time", "row 7", "inf"}},
      {[](Vandal& v) { v.number("/time", 7, 0.006); }, {"/time", "row 7"}},
      {[](Vandal& v) { v.number("/coupling/kind", 9, kLaws); }, {"/coupling/kind", "row 9", "9"}},
      {[](Vandal& v) { v.remove_attribute("format"); }, {"format", "missing"}},
      {[](Vandal& v) { v.remove_attribute("scene"); }, {"scene", "missing"}},
      {[](Vandal& v) { v.attribute("format", H5T_NATIVE_DOUBLE, 1.0); }, {"format", "text"}},
      {[](Vandal& v) { v.attribute("format", H5T_C_S1, 'x'); }, {"format", "limpid-session"}},
      {[](Vandal& v) { v.attribute("version", H5T_NATIVE_INT, 3); }, {"version 3"}},
      {[](Vandal& v) { v.attribute("version", H5T_NATIVE_DOUBLE, 1.0); }, {"version"}},
      {[](Vandal& v) { v.attribute("tick", H5T_NATIVE_DOUBLE, 0.0); }, {"tick 0"}},
      {[](Vandal& v) { v.attribute("tick", H5T_NATIVE_DOUBLE, double(NAN)); }, {"tick nan"}},
      {[](Vandal& v) { v.attribute("tick", H5T_NATIVE_DOUBLE, 0.2); }, {"tick 0.2"}},
      {[](Vandal& v) { v.attribute("tick", H5T_NATIVE_DOUBLE, 0.001, 2); }, {"tick", "single"}},
      {[](Vandal& v) { v.attribute("dof", H5T_NATIVE_INT, 0); }, {"dof 0"}},
      {[](Vandal& v) { v.attribute("dof", H5T_NATIVE_INT, 33); }, {"dof 33"}},
      {[](Vandal& v) { v.attribute("dof", H5T_NATIVE_INT, -1); }, {"dof"}},
      {[](Vandal& v) { v.attribute("dof", H5T_NATIVE_INT, 4); }, {"/device/position", "N x 4"}},
      {[](Vandal& v) { v.dataset("/events/row", H5T_STD_U64LE, {2}); }, {"/events"}},
      {[](Vandal& v) { v.dataset("/events/row", H5T_IEEE_F64LE, {1}); }, {"/events/row"}},
      {[](Vandal& v) { v.dataset("/events/setting", H5T_STD_U64LE, {1}); }, {"/events/setting"}},
      {[](Vandal& v) { v.number("/events/row", 0, 51); }, {"/events/row", "51"}},
  };
  for (std::size_t i = 0; i < std::size(cases); ++i) {
    const test::TempDir dir;
    test::write_sample(dir / "a.h5", 50);
    {
      Vandal vandal(dir / "a.h5");
      cases[i].spoil(vandal);
    }
    testing::internal::CaptureStderr();
    const std::string said = refusal([&] { read_session(dir / "a.h5"); });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << i;
    EXPECT_THAT(said, HasSubstr("a.h5")) << i;
    for (const std::string& part : cases[i].said) EXPECT_THAT(said, HasSubstr(part)) << i;
  }
}

// The first edition had no checksums. In a killed recording of it, announced but unwritten values
// read as a not-a-number that nothing else makes.
TEST(LeftoverOfTheFirstEdition, EndsWhereAColumnWasNeverWritten) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 1000);
  const Session whole = read_session(dir / "a.h5");
  {
    Vandal vandal(dir / "a.h5");
    vandal.remove("/check");
    vandal.remove("/hand/target");
  }
  {
    const hid_t file = H5Fopen((dir / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const std::array<hsize_t, 2> extent{1000, 3}, written{500, 3}, none{0, 0};
    const std::uint64_t never = 0x7ff8'6c69'6d70'6964;
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(creation, 2, written.data());
    H5Pset_fill_value(creation, H5T_NATIVE_DOUBLE, &never);
    const hid_t space = H5Screate_simple(2, extent.data(), nullptr);
    const hid_t data =
        H5Dcreate2(file, "/hand/target", H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    const hid_t memory = H5Screate_simple(2, written.data(), nullptr);
    std::vector<double> targets;
    for (std::size_t k = 0; k < 500; ++k) {
      const auto target = whole.at(k, Column::hand_target);
      targets.insert(targets.end(), target.begin(), target.end());
    }
    H5Sselect_hyperslab(space, H5S_SELECT_SET, none.data(), nullptr, written.data(), nullptr);
    H5Dwrite(data, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, targets.data());
    H5Sclose(memory);
    H5Dclose(data);
    H5Sclose(space);
    H5Pclose(creation);
    H5Fclose(file);
  }
  fs::rename(dir / "a.h5", dir / "a.h5.part");
  const Session left = read_session(dir / "a.h5.part");
  ASSERT_EQ(left.size(), 500u);
  EXPECT_TRUE(std::ranges::equal(left.rows, std::span(whole.rows).first(left.rows.size())));
}

TEST(ForeignSession, NeedNotHaveWhatTheContractDoesNotAskFor) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 50);
  {
    Vandal vandal(dir / "a.h5");
    for (const char* path : {"/hand/grip", "/device/force_wanted", "/energy/contact_potential",
                             "/events", "/contact"}) {
      vandal.remove(path);
    }
  }
  const Session session = read_session(dir / "a.h5");
  ASSERT_EQ(session.size(), 50u);
  EXPECT_TRUE(session.changes.empty());
  for (std::size_t k = 0; k < 50; ++k) {
    EXPECT_EQ(session.at(k, Column::hand_grip)[0], 1);
    EXPECT_EQ(session.at(k, Column::force_wanted)[0], 1);
    EXPECT_EQ(session.at(k, Column::contact_potential)[0], 0);
    // The file does not say where it was touched, nor that it was not.
    for (const Column c : {Column::contact_point, Column::contact_force}) {
      ASSERT_EQ(session.at(k, c).size(), 12u);
      EXPECT_TRUE(std::ranges::all_of(session.at(k, c), [](double x) { return std::isnan(x); }));
    }
  }
}

TEST(ForeignSession, MustNotClaimMoreThanItHolds) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 50);
  {
    Vandal vandal(dir / "a.h5");
    for (const ColumnInfo& column : kColumnInfo) {
      std::vector<hsize_t> shape{hsize_t{1} << 40};
      const auto width = static_cast<hsize_t>(RowLayout(3).width(column.column));
      if (width == 0) continue;
      if (width > 1) shape.push_back(width);
      vandal.dataset(column.path, column.byte ? H5T_STD_U8LE : H5T_IEEE_F64LE, shape);
    }
  }
  EXPECT_THAT(refusal([&] { read_session(dir / "a.h5"); }), HasSubstr("more than"));
}

TEST(Hand, OfASessionMustBeFinite) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 50);
  {
    Vandal vandal(dir / "a.h5");
    vandal.number("/hand/target", 9, NAN);
    vandal.remove("/check");
  }
  EXPECT_THAT(refusal([&] { read_hand(dir / "a.h5"); }), HasSubstr("/hand/target: row 9: nan"));
}

}  // namespace
}  // namespace limpid
