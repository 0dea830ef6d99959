// Session files in SI, and rows that lose nothing by the conversion.
#include "devices/files/session/session_units.h"

#include <hdf5.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "core/dynamics/arm_description.h"
#include "devices/files/session/derived_columns.h"
#include "devices/files/session/session_source.h"
#include "tests/devices/files/session/sample_session.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using test::refusal;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Scaled = SessionUnits::Scaled;

constexpr Scaled kTravel{Column::device_position, 0, false}, kForce{Column::motor_torque, 0, true};

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

TEST(SessionUnits, HaveTenCentimetresForAUnitOfTravelAndTenNewtonsForAUnitOfEffort) {
  EXPECT_EQ(SessionUnits::filed(kTravel, 2.5).value, 0.25);
  EXPECT_EQ(SessionUnits::filed(kTravel, -1).value, -0.1);
  EXPECT_EQ(SessionUnits::filed(kForce, 0.25).value, 2.5);
  const SessionUnits units(RowLayout(2), {false, true});
  const auto of = [&](Column c) { return units.units(kColumnInfo[static_cast<std::size_t>(c)]); };
  using Units = std::vector<std::string>;
  EXPECT_EQ(of(Column::proxy_position), (Units{"rad", "m"}));
  EXPECT_EQ(of(Column::measured_velocity), (Units{"rad/s", "m/s"}));
  EXPECT_EQ(of(Column::hand_torque_estimate), (Units{"N m", "N"}));
  EXPECT_EQ(of(Column::hand_target), Units{"m"});
  EXPECT_EQ(SessionUnits(RowLayout(2), {}).units(kColumnInfo[1]), Units{"rad"});
}

// A column of another unit, one number a joint or not, is filed as it is.
TEST(SessionUnits, ScaleNothingButAnglesAndTorquesOfJoints) {
  const SessionUnits units(RowLayout(2), {true, false});
  EXPECT_FALSE(units.scaled().empty());
  for (const Scaled& scaled : units.scaled()) {
    const ColumnInfo& column = kColumnInfo[static_cast<std::size_t>(scaled.column)];
    EXPECT_EQ(column.width, ColumnWidth::dof) << column.path;
    EXPECT_THAT(column.unit, testing::AnyOf(testing::StrEq("rad"), testing::StrEq("rad/s"),
                                            testing::StrEq("rad/s^2"), testing::StrEq("N m")))
        << column.path;
    EXPECT_EQ(scaled.part, 0) << column.path;
  }
}

// Work is not scaled: a unit of effort over a unit of travel is a joule.
TEST(SessionUnits, KeepTheWorkOfEffortOverTravel) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> any(0, 3);
  for (int i = 0; i < 1000; ++i) {
    const double travel = any(random), effort = any(random);
    const double work =
        SessionUnits::filed(kTravel, travel).value * SessionUnits::filed(kForce, effort).value;
    EXPECT_NEAR(work, travel * effort, 1e-15 * std::abs(work));
  }
}

TEST(SessionUnits, GiveEveryNumberBackToItsLastBit) {
  std::mt19937_64 random(2);
  std::vector<double> numbers{0.0,         -0.0,  5e-324, -5e-324, 4e-323, 2.2250738585072014e-308,
                              1e-310,      1e300, 0.1,    1,       10,     1.6,
                              std::nan("")};
  while (numbers.size() < 200000) {
    const double x = std::bit_cast<double>(random());
    if (std::abs(x) < 1e306) numbers.push_back(x);
    numbers.push_back(std::ldexp(static_cast<double>(random() >> 11), -53));
  }
  int shared = 0;
  for (const Scaled& scaled : {kTravel, kForce}) {
    for (const double x : numbers) {
      const SessionUnits::Filed filed = SessionUnits::filed(scaled, x);
      const auto back = SessionUnits::unfiled(scaled, filed);
      ASSERT_TRUE(back) << x;
      ASSERT_EQ(bits(*back), bits(x)) << x;
      shared += bits(SessionUnits::unfiled(scaled, filed.value)) != bits(x) && !std::isnan(x);
    }
  }
  EXPECT_GT(shared, 1000) << "the file's number alone would do, and its rounding is for nothing";
}

TEST(SessionUnits, RefuseARoundingThatIsNotOfItsNumber) {
  EXPECT_FALSE(SessionUnits::unfiled(kTravel, {0.25, 100}));
  EXPECT_FALSE(SessionUnits::unfiled(kForce, {2.5, -3}));
  EXPECT_FALSE(SessionUnits::unfiled(kForce, {std::nan(""), 1}));
}

// A session of an arm that turns and slides.
class SlidingSession : public testing::Test {
 protected:
  SlidingSession() : info_(test::sample_info(kDof)) {
    auto arm = std::make_shared<ArmDescription>(test::random_arm(kDof, 5, test::Slides::some));
    arm->tip_link = "the end";
    info_.arm = arm;
    rows_ = test::sample_rows(RowLayout(kDof), 0, 1300);
    for (double& x : layout_.in(row(0), Column::hand_torque)) x = std::nan("");
  }

  std::span<double> row(std::size_t k) {
    const auto stride = static_cast<std::size_t>(layout_.stride());
    return std::span(rows_).subspan(k * stride, stride);
  }
  void write(const fs::path& out) {
    SessionWriter writer(out, info_, false);
    writer.append(rows_);
    writer.close();
  }
  void expect_same(std::span<const double> again) const {
    ASSERT_EQ(again.size(), rows_.size());
    EXPECT_EQ(std::memcmp(again.data(), rows_.data(), rows_.size() * sizeof(double)), 0);
  }

  static constexpr int kDof = 4;
  const test::TempDir dir_;
  const RowLayout layout_{kDof};
  SessionInfo info_;
  std::vector<double> rows_;
};

TEST_F(SlidingSession, ComesBackBitForBit) {
  write(dir_ / "a.h5");
  const Session session = read_session(dir_ / "a.h5");
  EXPECT_EQ(session.info.slides, slides_of(*info_.arm));
  EXPECT_GT(std::ranges::count(session.info.slides, true), 0);
  EXPECT_GT(std::ranges::count(session.info.slides, false), 0);
  expect_same(session.rows);
}

TEST_F(SlidingSession, ComesBackBitForBitFromWhatAKilledProgramLeft) {
  {
    SessionWriter writer(dir_ / "a.h5", info_, false);
    writer.append(rows_);
  }
  const std::size_t left = read_session(dir_ / "a.h5.part").rows.size();
  ASSERT_GT(left, 0u);
  rows_.resize(left);
  expect_same(read_session(dir_ / "a.h5.part").rows);
  recover_session(dir_ / "a.h5.part", false);
  const Session session = read_session(dir_ / "a.h5");
  EXPECT_EQ(session.info.slides, slides_of(*info_.arm));
  expect_same(session.rows);
}

// First number of a dataset, that of the first row.
template <class T>
T first_number(const fs::path& file, const char* path, std::size_t at, hid_t type, const T* to) {
  const hid_t opened = H5Fopen(file.c_str(), to ? H5F_ACC_RDWR : H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t data = H5Dopen2(opened, path, H5P_DEFAULT);
  const hid_t space = H5Dget_space(data);
  std::vector<T> all(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data());
  if (to) {
    all[at] = *to;
    H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data());
  }
  H5Sclose(space);
  H5Dclose(data);
  H5Fclose(opened);
  return all[at];
}

TEST_F(SlidingSession, IsRefusedWhereItsRoundingIsDamaged) {
  write(dir_ / "a.h5");
  const auto spoilt = static_cast<std::int8_t>(77);
  first_number<std::int8_t>(dir_ / "a.h5", "/check/rounding", 3, H5T_NATIVE_INT8, &spoilt);
  EXPECT_THAT(refusal([&] { read_session(dir_ / "a.h5"); }),
              AllOf(HasSubstr("/check/rounding"), HasSubstr("row 0")));
}

TEST_F(SlidingSession, IsReadToOneUlpWithoutItsCheck) {
  write(dir_ / "a.h5");
  const hid_t file = H5Fopen((dir_ / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(H5Ldelete(file, "/check", H5P_DEFAULT), 0);
  H5Fclose(file);
  const Session session = read_session(dir_ / "a.h5");
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (!std::isnan(rows_[i])) {
      ASSERT_NEAR(session.rows[i], rows_[i], 3e-16 * std::abs(rows_[i]));
    }
  }
}

TEST_F(SlidingSession, IsRefusedWhereItSaysAnotherKindOfJoint) {
  write(dir_ / "a.h5");
  const hid_t file = H5Fopen((dir_ / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(H5Adelete(file, "joint_types"), 0);
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, 6);
  const hsize_t count = kDof;
  const hid_t space = H5Screate_simple(1, &count, nullptr);
  const hid_t attribute = H5Acreate2(file, "joint_types", type, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, type, "screw\0screw\0screw\0screw\0");
  H5Aclose(attribute);
  H5Sclose(space);
  H5Tclose(type);
  H5Fclose(file);
  EXPECT_THAT(refusal([&] { read_session(dir_ / "a.h5"); }),
              AllOf(HasSubstr("joint_types"), HasSubstr("screw"), HasSubstr("prismatic")));
}

TEST(SessionPoints, AreNoNumbersOnlyWhereNothingTouches) {
  // Nothing; a touch at the origin; a touch without force; values that an old recording lacks.
  const double nan = std::nan("");
  const std::vector<double> before{0, 0, 0, 0, 0, 0, 1, 2, 3, nan, nan, nan};
  const std::vector<double> forces{0, 0, 0, 0, 0, 1, 0, 0, 0, nan, nan, nan};
  std::vector<double> points = before;
  file_points(points, forces);
  for (const std::size_t i : {0u, 1u, 2u, 9u, 10u, 11u}) EXPECT_TRUE(std::isnan(points[i])) << i;
  EXPECT_THAT(std::vector(points.begin() + 3, points.begin() + 9),
              testing::ElementsAre(0, 0, 0, 1, 2, 3));
  unfile_points(points, forces);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(points[i], before[i]) << i;
  for (std::size_t i = 9; i < 12; ++i) EXPECT_TRUE(std::isnan(points[i])) << i;
}

TEST(Session, HasNoPlaceForContactsThatAreNotThere) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 10);
  const auto first = [&](const char* path) {
    return first_number<double>(dir / "a.h5", path, 0, H5T_NATIVE_DOUBLE, nullptr);
  };
  EXPECT_TRUE(std::isnan(first("/contact/point")));
  EXPECT_EQ(first("/contact/force"), 0);
  EXPECT_EQ(read_session(dir / "a.h5").at(0, Column::contact_point)[0], 0);
}

// Durations of ticks differ in every run: with their sums equal runs would be unequal.
TEST(Session, HasSumsOfEverythingButTheTiming) {
  EXPECT_THAT(check_columns(RowLayout(3)),
              AllOf(HasSubstr("/time\n"), HasSubstr("/energy/compensation\n"),
                    Not(HasSubstr("timing")), Not(HasSubstr("objects"))));
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 600);
  const double another = 0.25;
  first_number<double>(dir / "a.h5", "/timing/compute", 3, H5T_NATIVE_DOUBLE, &another);
  EXPECT_EQ(read_session(dir / "a.h5").at(3, Column::compute)[0], another);
  first_number<double>(dir / "a.h5", "/coupling/eta", 3, H5T_NATIVE_DOUBLE, &another);
  EXPECT_THAT(refusal([&] { read_session(dir / "a.h5"); }), HasSubstr("/coupling/eta"));
}

TEST(Session, KeepsTheStoryThatItTells) {
  const test::TempDir dir;
  SessionInfo info = test::sample_info();
  info.story = "once upon a time";
  SessionWriter writer(dir / "a.h5", info, false);
  writer.append(test::sample_rows(RowLayout(3), 0, 10));
  writer.close();
  EXPECT_EQ(read_session(dir / "a.h5").info.story, "once upon a time");
}

}  // namespace
}  // namespace limpid
