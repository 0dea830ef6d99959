#include "devices/files/session/session.h"

#include <hdf5.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "devices/files/session/hand_file.h"
#include "devices/files/session/session_csv.h"
#include "devices/files/session/session_source.h"
#include "devices/files/session/session_stream.h"
#include "tests/devices/files/session/sample_session.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using test::refusal;
using test::same_numbers;
using test::sample_info;
using test::sample_rows;
using testing::AllOf;
using testing::HasSubstr;

class SessionOfJoints : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Arms, SessionOfJoints, testing::Values(1, 2, 3, 7, 32));

TEST_P(SessionOfJoints, ComesBackBitForBit) {
  const test::TempDir dir;
  const int dof = GetParam();
  const RowLayout layout(dof);
  auto rows = sample_rows(layout, 0, 1234);
  for (double& x : layout.in(std::span(rows).first(static_cast<std::size_t>(layout.stride())),
                             Column::hand_torque)) {
    x = std::nan("");  // a real device's hand torque
  }
  {
    SessionWriter writer(dir / "a.h5", sample_info(dof), false);
    const auto stride = static_cast<std::size_t>(layout.stride());
    std::size_t at = 0;
    for (const std::size_t piece :
         {std::size_t{1}, std::size_t{600}, std::size_t{0}, std::size_t{633}}) {
      writer.append(std::span(rows).subspan(at * stride, piece * stride));
      at += piece;
    }
    writer.append(SettingChange{0, "coupling.eta = 2.0"});
    writer.append(SettingChange{1234, std::string(120, 's')});
    EXPECT_EQ(writer.rows_written(), 1234u);
    EXPECT_TRUE(fs::exists(dir / "a.h5.part"));
    EXPECT_FALSE(fs::exists(dir / "a.h5"));
    writer.close();
  }
  EXPECT_FALSE(fs::exists(dir / "a.h5.part"));
  const Session session = read_session(dir / "a.h5");
  EXPECT_TRUE(same_numbers(session.rows, rows));
  const SessionInfo info = sample_info(dof);
  EXPECT_EQ(session.info.tick, info.tick);
  EXPECT_EQ(session.info.dof, dof);
  EXPECT_EQ(session.info.created, info.created);
  EXPECT_EQ(session.info.app_version, info.app_version);
  EXPECT_EQ(session.info.seed, info.seed);
  EXPECT_EQ(session.info.source, info.source);
  EXPECT_EQ(session.info.config, info.config);
  EXPECT_EQ(session.info.safety, info.safety);
  EXPECT_EQ(session.info.device_urdf, info.device_urdf);
  EXPECT_EQ(session.info.scene, info.scene);
  ASSERT_EQ(session.info.models.size(), info.models.size());
  for (const auto& [name, bytes] : info.models) EXPECT_EQ(*session.info.models.at(name), *bytes);
  ASSERT_EQ(session.changes.size(), 2u);
  EXPECT_EQ(session.changes[0].setting, "coupling.eta = 2.0");
  EXPECT_EQ(session.changes[1].row, 1234u);
  EXPECT_EQ(session.changes[1].setting, std::string(120, 's'));
}

TEST(Session, MayBeEmpty) {
  const test::TempDir dir;
  SessionWriter(dir / "a.h5", sample_info(), false).close();
  EXPECT_EQ(read_session(dir / "a.h5").size(), 0u);
}

// Another program computed these sums; recordings of other editions have them.
TEST(Session, KeepsTheSumsOfItsColumns) {
  const RowLayout layout(1);
  const auto stride = static_cast<std::size_t>(layout.stride());
  std::vector<double> rows(3 * stride, 0.0);
  for (std::size_t k = 0; k < 3; ++k) {
    layout.in(std::span(rows).subspan(k * stride, stride), Column::time)[0] =
        0.001 * static_cast<double>(k);
  }
  const auto sums = column_sums(columns_of(layout, rows), 0, 3);
  EXPECT_EQ(sums[static_cast<std::size_t>(Column::time)], 0x9f0d'5535'0614'3067u);
}

// Rows of 16 seconds of three joints, pushed at one point for 11 ticks from `from` on.
std::vector<double> touched_briefly(std::size_t from) {
  const RowLayout layout(3);
  const auto stride = static_cast<std::size_t>(layout.stride());
  std::vector<double> rows = sample_rows(layout, 0, 16000);
  for (std::size_t k = 0; k < 16000; ++k) {
    const auto row = std::span(rows).subspan(k * stride, stride);
    for (const Column c : {Column::contact_point, Column::contact_force}) {
      const auto values = layout.in(row, c);
      std::ranges::fill(values, 0.0);
      if (k >= from && k < from + 11) std::ranges::fill(values.first(3), 0.25);
    }
  }
  return rows;
}

std::uintmax_t size_recorded(const fs::path& out, const std::vector<double>& rows) {
  SessionWriter writer(out, sample_info(), false);
  writer.append(rows);
  writer.close();
  EXPECT_TRUE(same_numbers(read_session(out).rows, rows));
  return fs::file_size(out);
}

// A row without contacts takes at most 63 numbers, its contacts 24, for eight seconds at a time.
// The rows are preceded by 400 kB, with HDF5 1.14 by half a megabyte.
TEST(Session, HasRoomForContactsOnlyAboutWhenSomethingTouches) {
  const test::TempDir dir;
  const auto never = size_recorded(dir / "never.h5", touched_briefly(16000));
  EXPECT_LT(never, 16000u * 63 * 8 + 550'000);
  const auto late = size_recorded(dir / "late.h5", touched_briefly(15000));
  EXPECT_LT(late, never + 8000 * 24 * 8 + 100'000);
}

TEST(Session, NamesEachNumberOfItsContactsInATable) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 10);
  write_csv(read_session(dir / "a.h5"), dir / "a.csv", false);
  const std::string table = test::file_bytes(dir / "a.csv");
  EXPECT_THAT(table.substr(0, table.find('\n')),
              HasSubstr(",contact_point_4_y_m,contact_point_4_z_m,contact_force_1_x_N,"));
}

// The last block is full and written already; a change comes after it.
TEST(Session, KeepsAChangeAfterItsLastBlock) {
  const test::TempDir dir;
  const SessionInfo info = sample_info();
  const auto block = static_cast<std::size_t>(std::lround(0.5 / info.tick));
  SessionWriter writer(dir / "a.h5", info, false);
  writer.append(sample_rows(RowLayout(info.dof), 0, block));
  writer.append(SettingChange{block - 1, "coupling.eta = 1.5"});
  writer.close();
  const Session session = read_session(dir / "a.h5");
  EXPECT_EQ(session.size(), block);
  ASSERT_EQ(session.changes.size(), 1u);
  EXPECT_EQ(session.changes[0].setting, "coupling.eta = 1.5");
}

TEST(Session, OfTheFirstEditionHasNoSafetyLimits) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 10);
  const hid_t file = H5Fopen((dir / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(H5Adelete(file, "safety_limits"), 0);
  H5Fclose(file);
  const Session session = read_session(dir / "a.h5");
  EXPECT_EQ(session.info.safety, "");
  EXPECT_EQ(session.size(), 10u);
}

TEST(Session, SaysWhenItWasMade) {
  const test::TempDir dir;
  SessionInfo info = sample_info();
  info.created.clear();
  SessionWriter(dir / "a.h5", info, false).close();
  EXPECT_THAT(read_session(dir / "a.h5").info.created,
              testing::MatchesRegex("20..-..-..T..:..:..Z"));
}

TEST(Session, IsReadableWhileItIsWritten) {
  const test::TempDir dir;
  SessionWriter writer(dir / "a.h5", sample_info(), false);
  const RowLayout layout(3);
  writer.append(sample_rows(layout, 0, 1700));
  const Session session = read_session(writer.part());
  EXPECT_GE(session.size(), 1200u) << "at most half a second is missing";
  EXPECT_TRUE(same_numbers(session.rows, sample_rows(layout, 0, session.size())));
}

TEST(Session, IsHdf5AsPythonExpectsItAlsoWhileItIsWritten) {
  if (std::system("/usr/bin/python3 -c 'import h5py' 2>/dev/null") != 0) {
    GTEST_SKIP() << "no h5py on this computer";
  }
  const test::TempDir dir;
  test::write_file(dir / "check.py", R"(
import sys, h5py
f = h5py.File(sys.argv[1], "r", **({"swmr": True} if sys.argv[1].endswith(".part") else {}))
a = f.attrs
assert a["format"] == "limpid-session" and a["version"] == 2 and a["dof"] == 3
assert a["tick"] == 0.001 and int(a["seed"]) == 2**64 - 1
assert isinstance(a["device_urdf"], str) and len(a["device_urdf"]) == 200003
assert a["source"] == "a hand, \u03b7" and a["created"].startswith("2024-02-29")
n = int(sys.argv[2])
shapes = {"/time": (n,), "/device/position": (n, 3), "/hand/target": (n, 3), "/coupling/eta": (n,)}
for path, shape in shapes.items():
    assert f[path].shape == shape and f[path].dtype == "float64", path
assert f["/coupling/kind"].dtype == "uint8" and f["/device/position"].attrs["unit"] == "rad"
assert f["/time"][7] == 0.007 and list(f["/coupling/kind"][:3]) == [0, 1, 0]
if len(sys.argv) > 3:
    assert f["/events/row"][0] == 3 and f["/events/setting"][0] == b"coupling.k_vc = 8"
    # An object's name may have any letter.
    assert h5py.check_string_dtype(f["/events/setting"].dtype).encoding == "utf-8"
)");
  const auto python = [&](const fs::path& file, const std::string& rest) {
    return std::system(
        ("/usr/bin/python3 " + (dir / "check.py").string() + " " + file.string() + " " + rest)
            .c_str());
  };
  test::write_sample(dir / "a.h5", 1234);
  EXPECT_EQ(python(dir / "a.h5", "1234 events"), 0);
  SessionWriter live(dir / "b.h5", sample_info(), false);
  live.append(sample_rows(RowLayout(3), 0, 1024));
  EXPECT_EQ(python(live.part(), "1024"), 0);
}

TEST(Session, RefusesAPlaceThatIsTakenOrMissing) {
  const test::TempDir dir;
  const auto open = [&](const char* name) {
    return refusal([&] { SessionWriter(dir / name, sample_info(), false); });
  };
  test::write_file(dir / "there.h5", "precious");
  EXPECT_THAT(open("there.h5"), AllOf(HasSubstr("there.h5"), HasSubstr("--force")));
  EXPECT_EQ(test::file_bytes(dir / "there.h5"), "precious");
  test::write_file(dir / "killed.h5.part", "precious");
  EXPECT_THAT(open("killed.h5"), AllOf(HasSubstr("killed.h5.part"), HasSubstr("limpid recover")));
  EXPECT_EQ(test::file_bytes(dir / "killed.h5.part"), "precious");
  EXPECT_THAT(open("no/where.h5"), HasSubstr("no such directory"));
  fs::create_directory(dir / "folder.h5");
  EXPECT_THAT(open("folder.h5"), HasSubstr("directory"));
  for (const char* name : {"table.csv", "plain", ".h5", "a.h5.part"}) {
    EXPECT_THAT(open(name), AllOf(HasSubstr(name), HasSubstr("a name that ends in .h5")));
    EXPECT_FALSE(fs::exists(dir / (std::string(name) + ".part").c_str())) << name;
  }
  EXPECT_NE(refusal([] { SessionWriter("", sample_info(), false); }), "");
  EXPECT_THAT(refusal([] { SessionWriter("/proc/self/a.h5", sample_info(), false); }),
              HasSubstr("/proc/self/a.h5"));
}

// Another user runs these tests, as nothing is forbidden to root.
class AsAnybody {
 public:
  AsAnybody() {
    if (root_ && seteuid(65534) != 0) throw std::runtime_error("seteuid");
  }
  ~AsAnybody() {
    if (root_ && seteuid(0) != 0) std::abort();
  }
  AsAnybody(const AsAnybody&) = delete;
  AsAnybody& operator=(const AsAnybody&) = delete;

 private:
  const bool root_ = geteuid() == 0;
};

TEST(Session, TellsAFolderThatIsClosedFromOneThatIsNotThere) {
  const test::TempDir dir;
  fs::create_directories(dir / "closed/folder");
  test::write_sample(dir / "closed/folder/there.h5", 10);
  fs::permissions(dir / "", fs::perms::all);
  fs::permissions(dir / "closed", fs::perms::none);
  {
    const AsAnybody nobody;
    EXPECT_THAT(refusal([&] { SessionWriter(dir / "closed/folder/a.h5", sample_info(), false); }),
                HasSubstr("Permission denied"));
    EXPECT_THAT(refusal([&] { read_session(dir / "closed/folder/there.h5"); }),
                HasSubstr("Permission denied"));
    EXPECT_THAT(refusal([&] { recover_session(dir / "closed/folder/b.h5.part", false); }),
                HasSubstr("Permission denied"));
  }
  fs::permissions(dir / "closed", fs::perms::owner_all);
  EXPECT_THAT(refusal([&] { SessionWriter(dir / "closed/none/a.h5", sample_info(), false); }),
              HasSubstr("no such directory"));
}

TEST(Session, RefusesAFolderThatIsReadOnly) {
  const test::TempDir dir;
  fs::create_directory(dir / "folder");
  fs::permissions(dir / "", fs::perms::all);
  fs::permissions(dir / "folder", fs::perms::owner_read | fs::perms::owner_exec |
                                      fs::perms::others_read | fs::perms::others_exec);
  const AsAnybody nobody;
  EXPECT_THAT(refusal([&] { SessionWriter(dir / "folder/a.h5", sample_info(), false); }),
              HasSubstr("Permission denied"));
}

TEST(Session, OverwritesWhenForced) {
  const test::TempDir dir;
  test::write_file(dir / "a.h5", "old");
  test::write_file(dir / "a.h5.part", "older");
  SessionWriter writer(dir / "a.h5", sample_info(), true);
  EXPECT_EQ(test::file_bytes(dir / "a.h5"), "old") << "until the new one is complete";
  writer.append(sample_rows(RowLayout(3), 0, 10));
  writer.close();
  EXPECT_EQ(read_session(dir / "a.h5").size(), 10u);
}

TEST(Session, IsWrittenByOneAtATime) {
  const test::TempDir dir;
  SessionWriter writer(dir / "a.h5", sample_info(), false);
  EXPECT_THAT(refusal([&] { SessionWriter(dir / "a.h5", sample_info(), true); }),
              HasSubstr("still being recorded"));
  EXPECT_THAT(refusal([&] { recover_session(writer.part(), false); }),
              HasSubstr("still being recorded"));
  writer.append(sample_rows(RowLayout(3), 0, 10));
  writer.close();
  EXPECT_EQ(read_session(dir / "a.h5").size(), 10u);
}

TEST(Session, LeavesAloneWhatAppearedWhileRecording) {
  const test::TempDir dir;
  SessionWriter writer(dir / "a.h5", sample_info(), false);
  test::write_file(dir / "a.h5", "somebody else's");
  EXPECT_NE(refusal([&] { writer.close(); }), "");
  EXPECT_EQ(test::file_bytes(dir / "a.h5"), "somebody else's");
  EXPECT_TRUE(fs::exists(dir / "a.h5.part"));
}

TEST(Session, RefusesSettingsThatAreTooLongAndPartsOfRows) {
  const test::TempDir dir;
  SessionWriter writer(dir / "a.h5", sample_info(), false);
  EXPECT_THAT(refusal([&] {
                writer.append(SettingChange{0, std::string(121, 's')});
              }),
              HasSubstr("120"));
  const std::vector<double> half(7);
  EXPECT_THROW(writer.append(half), std::invalid_argument);
}

TEST(Session, RefusesATickOrANumberOfJointsThatCannotBe) {
  const test::TempDir dir;
  for (const double tick : {0.0, -1.0, 0.11, std::nan(""), HUGE_VAL}) {
    SessionInfo info = sample_info();
    info.tick = tick;
    EXPECT_THAT(refusal([&] { SessionWriter(dir / "a.h5", info, false); }), HasSubstr("tick"));
  }
  for (const int dof : {0, -1, 33}) {
    SessionInfo info = sample_info();
    info.dof = dof;
    EXPECT_THAT(refusal([&] { SessionWriter(dir / "a.h5", info, false); }), HasSubstr("dof"));
  }
  EXPECT_FALSE(fs::exists(dir / "a.h5.part"));
}

TEST(Session, IsAHandThatHoldsUntilTheSampleAtWhichItLetsGo) {
  const test::TempDir dir;
  const RowLayout layout(3);
  std::vector<double> rows = sample_rows(layout, 0, 4);
  for (std::size_t k = 0; k < 4; ++k) {
    layout.in(std::span(rows).subspan(k * static_cast<std::size_t>(layout.stride()),
                                      static_cast<std::size_t>(layout.stride())),
              Column::hand_grip)[0] = k == 2 ? 0 : 1;
  }
  SessionWriter writer(dir / "a.h5", sample_info(), false);
  writer.append(rows);
  writer.close();
  const HandPath path = read_hand(dir / "a.h5");
  for (const double t : {-1.0, 0.0, 0.0005, 0.001, 0.0019}) EXPECT_EQ(path.grip_at(t), 1) << t;
  for (const double t : {0.002, 0.0025, 0.0029}) EXPECT_EQ(path.grip_at(t), 0) << t;
  for (const double t : {0.003, 0.0035, 9.0}) EXPECT_EQ(path.grip_at(t), 1) << t;
  // A loop of half the tick reads between the samples.
  constexpr std::array<double, 8> wanted{1, 1, 1, 1, 0, 0, 1, 1};
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    EXPECT_EQ(path.grip_sample(k, 0.0005), wanted[k]) << k;
  }
}

TEST(Session, IsAHandToFollowBitForBit) {
  const test::TempDir dir;
  test::write_sample(dir / "a.h5", 1234);
  const Session session = read_session(dir / "a.h5");
  const HandPath path = read_hand(dir / "a.h5");
  EXPECT_EQ(path.tick, 0.001);
  EXPECT_EQ(std::lround(path.duration() / 0.001), 1234);
  for (std::size_t k = 0; k < session.size(); ++k) {
    const auto target = session.at(k, Column::hand_target);
    const Vec3 recorded(target[0], target[1], target[2]);
    ASSERT_EQ(path.sample(k, 0.001), recorded);
    ASSERT_EQ(path.at(session.at(k, Column::time)[0]), recorded);
    ASSERT_EQ(path.grip_sample(k, 0.001), session.at(k, Column::hand_grip)[0]);
  }
  EXPECT_EQ(path.sample(99999, 0.001), path.position.back());
  const Vec3 between = path.sample(1, 0.0005);
  for (int axis = 0; axis < 3; ++axis) {
    const double a = path.position[0][axis];
    const double b = path.position[1][axis];
    EXPECT_GE(between[axis], std::min(a, b));
    EXPECT_LE(between[axis], std::max(a, b));
  }
}

// A column that is mostly zeros is left out where it is all zeros. Not-a-number and a zero with a
// sign do not count as zero.
TEST(Session, KeepsABlockWithoutASingleNumber) {
  const RowLayout layout(2);
  const auto stride = static_cast<std::size_t>(layout.stride());
  constexpr std::size_t kRows = 5000;
  for (const double nothing : {std::nan(""), -0.0}) {
    const test::TempDir dir;
    std::vector<double> rows = sample_rows(layout, 0, kRows);
    for (std::size_t k = 0; k < kRows; ++k) {
      for (const Column c :
           {Column::contact_force, Column::compensation_torque, Column::energy_compensation,
            Column::contact_point, Column::tool_orientation, Column::motor_warmth}) {
        std::ranges::fill(layout.in(std::span(rows).subspan(k * stride, stride), c), nothing);
      }
    }
    SessionWriter writer(dir / "a.h5", sample_info(2), false);
    writer.append(rows);
    writer.close();
    EXPECT_TRUE(same_numbers(read_session(dir / "a.h5").rows, rows)) << nothing;
  }
}

// Reading takes all runs side by side, a few thousand rows at a time, at any length.
TEST(Session, OfAsManyRunsAsThereCanBeIsReadInPieces) {
  const test::TempDir dir;
  SessionInfo info = sample_info();
  std::vector<std::vector<double>> rows{sample_rows(RowLayout(3), 0, 20'000)};
  for (std::size_t lane = 1; lane < kMostLanes; ++lane) {
    info.beside.push_back("coupling.eta = 0." + std::to_string(lane) + "\n");
    rows.push_back(rows[0]);
    for (std::size_t i = 1; i < rows[lane].size(); i += RowLayout(3).stride()) {
      rows[lane][i] = static_cast<double>(lane);
    }
  }
  SessionWriter writer(dir / "a.h5", info, false);
  for (std::size_t lane = 0; lane < kMostLanes; ++lane) writer.append(rows[lane], lane);
  writer.append(SettingChange{12'345, "coupling.k_vc = 8"});
  writer.append(SettingChange{54, "coupling.k_vc = 9"}, kMostLanes - 1);
  writer.append(Mark{19'999, "last"});
  writer.close();

  std::vector<std::vector<double>> got(kMostLanes);
  std::size_t largest = 0;
  std::string config;
  std::vector<SettingChange> changes;
  const Session rest = read_session(
      dir / "a.h5",
      [&](const Session& about) {
        config = about.info.config;
        changes = about.changes;
      },
      [&](LaneRows some) {
        ASSERT_EQ(some.size(), kMostLanes);
        largest = std::max(largest, some[0].size());
        for (std::size_t lane = 0; lane < kMostLanes; ++lane) {
          got[lane].insert(got[lane].end(), some[lane].begin(), some[lane].end());
        }
      });
  EXPECT_LE(largest, 4096 * static_cast<std::size_t>(RowLayout(3).stride()));
  EXPECT_EQ(config, info.config);
  ASSERT_EQ(changes.size(), 1u) << "who takes rows in turn has to know what changes at them";
  EXPECT_EQ(changes[0].row, 12'345u);
  EXPECT_EQ(rest.size(), 0u);
  EXPECT_EQ(rest.changes.at(0).row, 12'345u);
  EXPECT_EQ(rest.marks.at(0).tick, 19'999u);
  EXPECT_EQ(rest.lane(kMostLanes - 1).changes.at(0).row, 54u);
  const Session whole = read_session(dir / "a.h5");
  ASSERT_EQ(whole.lanes(), kMostLanes);
  EXPECT_EQ(whole.info.beside, info.beside);
  for (std::size_t lane = 0; lane < kMostLanes; ++lane) {
    EXPECT_TRUE(same_numbers(got[lane], rows[lane])) << lane;
    EXPECT_TRUE(same_numbers(whole.lane(lane).rows, rows[lane])) << lane;
  }
  for (std::size_t lane = 1; lane < kMostLanes; ++lane) {
    EXPECT_EQ(whole.lane(lane).info.config, info.beside[lane - 1]);
  }
}

TEST(Session, OfMoreRunsThanThereCanBeIsNotWritten) {
  const test::TempDir dir;
  SessionInfo info = sample_info();
  info.beside.resize(kMostLanes);
  EXPECT_THAT(test::refusal([&] { SessionWriter(dir / "a.h5", info, false); }),
              HasSubstr("a.h5: 4 runs; allowed: 1 to 3"));
  EXPECT_TRUE(fs::is_empty(dir / "."));
}

}  // namespace
}  // namespace limpid
