// Sessions in which objects move.
#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "devices/files/session/hand_file.h"
#include "devices/files/session/session.h"
#include "devices/files/session/session_csv.h"
#include "tests/devices/files/session/sample_session.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using test::refusal;
using test::same_numbers;
using test::sample_rows;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

SessionInfo info_of(std::vector<std::string> bodies) {
  SessionInfo info = test::sample_info();
  info.bodies = std::move(bodies);
  return info;
}

// Sample rows with all columns of bodies and joints.
std::vector<double> rows_of(const SessionInfo& info, std::size_t count) {
  return sample_rows(info.layout(), 0, count);
}

void write_with_bodies(const fs::path& out, const SessionInfo& info, std::size_t rows) {
  SessionWriter writer(out, info, false);
  writer.append(rows_of(info, rows));
  writer.close();
}

TEST(RowLayout, HasRoomForWhatMoves) {
  const RowLayout none(3, 0), two(3, 2);
  for (const Column c : {Column::body_pose, Column::body_velocity, Column::energy_to_objects,
                         Column::objects_awake, Column::magnet}) {
    EXPECT_FALSE(none.has(c));
    EXPECT_TRUE(two.has(c));
  }
  // Each body has a pose and a velocity. All bodies share four energies, awake, sweeps, points left
  // out, standstills, cut turns, held, and the hand's magnet and pull: which body, where, where to.
  EXPECT_EQ(two.stride(), none.stride() + 2 * (7 + 6) + 11 + 1 + 3 + 3);
  EXPECT_EQ(none.offset(Column::body_pose), two.offset(Column::body_pose));
}

TEST(SessionWithBodies, SaysWhatWasPulled) {
  const test::TempDir dir;
  const SessionInfo info = info_of({"die", "key"});
  const RowLayout layout = info.layout();
  const auto hand = [&](double number, double far) {
    std::vector<double> rows = rows_of(info, 10);
    const auto row = std::span(rows).subspan(7 * static_cast<std::size_t>(layout.stride()));
    layout.in(row, Column::hand_pull)[0] = number;
    layout.in(row, Column::pull_target)[2] = far;
    SessionWriter writer(dir / "a.h5", info, true);
    writer.append(rows);
    writer.close();
    const Session session = read_session(dir / "a.h5");
    const HandPath path = hand_of(session, "a.h5");
    const BodyPull pull = path.pull_sample(7, info.tick);
    EXPECT_EQ(pull.target.z(), far);
    EXPECT_EQ(pull.point.x(), session.at(7, Column::pull_point)[0]);
    return pull.body;
  };
  EXPECT_EQ(hand(2, 0.3), 1);
  EXPECT_THAT(refusal([&] { hand(65, 0.3); }),
              AllOf(HasSubstr("a.h5: /hand/pull: row 7: 65"), HasSubstr("up to 64")));
  EXPECT_THAT(refusal([&] { hand(1, 11); }),
              AllOf(HasSubstr("/hand/pull_target: row 7: 11"), HasSubstr("-10 to 10 m")));
}

TEST(SessionWithBodies, ComesBackBitForBit) {
  const test::TempDir dir;
  for (const std::size_t count : {1, 2, 64}) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < count; ++i) names.push_back("body \xCE\xB7 " + std::to_string(i));
    const SessionInfo info = info_of(names);
    const fs::path file = dir / (std::to_string(count) + ".h5").c_str();
    write_with_bodies(file, info, 1234);
    const Session session = read_session(file);
    EXPECT_EQ(session.info.bodies, names);
    EXPECT_EQ(session.layout.bodies(), static_cast<int>(count));
    EXPECT_TRUE(same_numbers(session.rows, rows_of(info, 1234)));
  }
}

TEST(SessionWithBodies, OfATwinHasThoseOfBothRuns) {
  const test::TempDir dir;
  SessionInfo info = info_of({"die", "key"});
  info.beside = {""};
  const std::vector<double> first = rows_of(info, 700);
  const auto stride = static_cast<std::size_t>(info.layout().stride());
  std::vector<double> second = first;
  for (std::size_t k = 0; k < 700; ++k) {
    info.layout().in(std::span(second).subspan(k * stride, stride), Column::body_pose)[8] = 7;
  }
  const std::vector<double> world(1500, 0.25), other{1, std::nan(""), -0.0};
  {
    SessionWriter writer(dir / "a.h5", info, false);
    writer.append_world(world, kMainLane);
    writer.append_world(other, kTwinLane);
    writer.append(first, kMainLane);
    writer.append(second, kTwinLane);
    writer.close();
  }
  const Session session = read_session(dir / "a.h5");
  ASSERT_EQ(session.lanes(), 2u);
  EXPECT_TRUE(same_numbers(session.rows, first));
  EXPECT_TRUE(same_numbers(session.lane(kTwinLane).rows, second));
  EXPECT_TRUE(same_numbers(session.world, world));
  EXPECT_TRUE(same_numbers(session.lane(kTwinLane).world, other));
}

TEST(SessionWithBodies, NeedNotSayWithWhatTheyBegin) {
  const test::TempDir dir;
  write_with_bodies(dir / "a.h5", info_of({"die"}), 10);
  EXPECT_TRUE(read_session(dir / "a.h5").world.empty());
}

TEST(SessionWithBodies, KeepsWhatTheyBeginWithWhereItWasKilled) {
  const test::TempDir dir;
  const SessionInfo info = info_of({"die"});
  const std::vector<double> world(kMostWorld, 1.5);
  {
    SessionWriter writer(dir / "a.h5", info, false);
    writer.append_world(world);
    writer.append(rows_of(info, 1024));
  }
  const Session session = read_session(dir / "a.h5.part");
  EXPECT_EQ(session.size(), 1024u);
  EXPECT_TRUE(same_numbers(session.world, world));
  EXPECT_EQ(recover_session(dir / "a.h5.part", false).rows, 1024u);
  EXPECT_TRUE(same_numbers(read_session(dir / "a.h5").world, world));
}

TEST(SessionWithBodies, TakesNoMoreOfThemThanItGivesBack) {
  const test::TempDir dir;
  SessionWriter writer(dir / "a.h5", info_of({"die"}), false);
  const std::vector<double> more(kMostWorld + 1, 0.0);
  EXPECT_THAT(refusal([&] { writer.append_world(more); }), HasSubstr("100000"));
  EXPECT_THAT(refusal([&] {
                SessionWriter(dir / "b.h5", info_of(std::vector<std::string>(65, "b")), false);
              }),
              HasSubstr("65 objects that move"));
}

// Space for velocities is taken for eight seconds at a time; those of 64 bodies would be 3 kB each.
TEST(SessionWithBodies, HasNoRoomForTheVelocitiesOfThoseThatSleep) {
  const test::TempDir dir;
  const SessionInfo info = info_of(std::vector<std::string>(64, ""));
  const RowLayout layout = info.layout();
  std::vector<double> rows = rows_of(info, 4096);
  const auto size = [&](const char* name) {
    SessionWriter writer(dir / name, info, false);
    writer.append(rows);
    writer.close();
    // Size on the disk: announced but unwritten parts take none.
    const hid_t file = H5Fopen((dir / name).c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t data = H5Dopen2(file, "/objects/velocity", H5P_DEFAULT);
    const hsize_t stored = H5Dget_storage_size(data);
    H5Dclose(data);
    H5Fclose(file);
    return stored;
  };
  EXPECT_GT(size("moving.h5"), 0u);
  const auto stride = static_cast<std::size_t>(layout.stride());
  for (std::size_t k = 0; k < 4096; ++k) {
    const auto row = std::span(rows).subspan(k * stride, stride);
    std::ranges::fill(layout.in(row, Column::body_velocity), 0.0);
  }
  EXPECT_EQ(size("asleep.h5"), 0u);
}

TEST(Session, WithoutBodiesSaysNothingOfThem) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 10);
  const hid_t file = H5Fopen((dir / "a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  for (const char* path : {"/objects", "/energy/to_objects", "/energy/objects"}) {
    EXPECT_EQ(H5Lexists(file, path, H5P_DEFAULT), 0) << path;
  }
  H5Fclose(file);
  write_csv(read_session(dir / "a.h5"), dir / "a.csv", false);
  EXPECT_THAT(test::file_bytes(dir / "a.csv"), Not(HasSubstr("objects")));
}

TEST(SessionWithBodies, NamesEachNumberOfTheirsInATable) {
  const test::TempDir dir;
  write_with_bodies(dir / "a.h5", info_of({"big die", "object 2", "big die"}), 3);
  write_csv(read_session(dir / "a.h5"), dir / "a.csv", false);
  const std::string table = test::file_bytes(dir / "a.csv");
  const std::string head = table.substr(0, table.find('\n'));
  EXPECT_THAT(
      head, AllOf(HasSubstr(",objects_big_die_x_m,objects_big_die_y_m,"),
                  HasSubstr(",objects_big_die_qw,"),
                  HasSubstr(",objects_object_2_qz,objects_big_die_3_x_m,"),
                  HasSubstr(",objects_big_die_vx_m_s,"), HasSubstr(",objects_big_die_3_wz_rad_s,"),
                  HasSubstr(",energy_to_objects_J,"), HasSubstr(",objects_held,")));
  const std::string first = table.substr(head.size() + 1);
  EXPECT_EQ(std::ranges::count(head, ','),
            std::ranges::count(first.substr(0, first.find('\n')), ','));
}

// Replaces a dataset, as another program or damage might.
void replace(const fs::path& file, const char* path, hid_t type, std::vector<hsize_t> shape) {
  const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Ldelete(opened, path, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
  H5Dclose(H5Dcreate2(opened, path, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Sclose(space);
  H5Fclose(opened);
}

TEST(SessionWithBodies, OfAnotherShapeIsRefusedWithWhatIsWrong) {
  struct Case {
    const char* path;
    std::vector<hsize_t> shape;
    std::vector<std::string> said;
  };
  const Case cases[] = {
      {"/objects/pose", {50, 2, 6}, {"/objects/pose", "2 x 6", "N x bodies x 7"}},
      {"/objects/pose", {50, 65, 7}, {"/objects/pose", "65 x 7", "at most 64"}},
      {"/objects/pose", {50, 14}, {"/objects/pose", "2 dimensions"}},
      {"/objects/pose", {50, 3, 7}, {"/objects/velocity", "2 x 6", "N x 3 x 6"}},
      {"/objects/pose", {49, 2, 7}, {"/objects/pose", "49", "50"}},
      {"/objects/velocity", {50, 12}, {"/objects/velocity", "N x 2 x 6"}},
      {"/objects/velocity", {50, 2, 7}, {"/objects/velocity", "2 x 7", "N x 2 x 6"}},
      {"/energy/to_objects", {50, 2}, {"/energy/to_objects", "N x 1"}},
      {"/objects/state", {100'001}, {"/objects/state", "100001"}},
      {"/objects/state", {10, 10}, {"/objects/state"}},
  };
  for (const Case& wrong : cases) {
    const test::TempDir dir;
    write_with_bodies(dir / "a.h5", info_of({"die", "key"}), 50);
    replace(dir / "a.h5", wrong.path, H5T_IEEE_F64LE, wrong.shape);
    const std::string why = refusal([&] { read_session(dir / "a.h5"); });
    for (const std::string& said : wrong.said) EXPECT_THAT(why, HasSubstr(said));
  }
  const test::TempDir dir;
  write_with_bodies(dir / "a.h5", info_of({"die", "key"}), 50);
  replace(dir / "a.h5", "/objects/state", H5T_STD_I64LE, {10});
  EXPECT_THAT(refusal([&] { read_session(dir / "a.h5"); }), HasSubstr("float64"));
}

TEST(SessionWithBodies, OfAnotherProgramNeedNotSayMoreThanWhereTheyAre) {
  const test::TempDir dir;
  const SessionInfo info = info_of({"die", "key"});
  write_with_bodies(dir / "a.h5", info, 50);
  const hid_t file = H5Fopen((dir / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  for (const char* path :
       {"/energy/to_objects", "/energy/objects", "/energy/objects_gain", "/objects/awake",
        "/objects/sweeps", "/objects/left_out", "/objects/held", "/objects/state"}) {
    EXPECT_GE(H5Ldelete(file, path, H5P_DEFAULT), 0) << path;
  }
  const hid_t poses = H5Dopen2(file, "/objects/pose", H5P_DEFAULT);
  H5Adelete(poses, "names");
  H5Dclose(poses);
  H5Fclose(file);
  const Session session = read_session(dir / "a.h5");
  EXPECT_EQ(session.info.bodies, (std::vector<std::string>{"object 1", "object 2"}));
  EXPECT_EQ(session.at(3, Column::magnet)[0], 0);
  EXPECT_TRUE(std::isnan(session.at(3, Column::energy_to_objects)[0]));
  const std::vector<double> rows = rows_of(info, 50);
  EXPECT_TRUE(same_numbers(session.at(0, Column::body_pose),
                           info.layout().in(std::span<const double>(rows).first(
                                                static_cast<std::size_t>(info.layout().stride())),
                                            Column::body_pose)));
}

}  // namespace
}  // namespace limpid
