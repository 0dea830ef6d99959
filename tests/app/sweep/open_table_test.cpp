#include <gmock/gmock.h>
#include <hdf5.h>

#include <cmath>
#include <fstream>

#include "app/sweep/record_point.h"
#include "app/sweep/sweep_map.h"
#include "app/sweep/sweep_table.h"
#include "app/sweep/sweep_work.h"
#include "devices/files/session/session.h"
#include "devices/files/text_file.h"
#include "tests/app/sweep/plans.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string kMaps = R"(scene = "free.toml"
hand = { at = [0.19, 0, 0], jump = [1e-4, 0, 0] }
seconds = 0.02
measure = ["human_rms", "stable"]
axis = [
  { key = "coupling.kind", values = ["standard", "proposed", "predictive"] },
  { key = "hand.stiffness", values = [1000, 100], scale = "log" },
  { key = "coupling.eta", from = 0.4, to = 1, count = 3 },
]
[figure]
x = "stiffness"
theory = ["pr"]
)";

class Tables : public testing::Test {
 protected:
  // The sweep's file with its first `blocks` blocks.
  fs::path written(const SweepPlan& plan, std::uint64_t blocks = 1000) {
    return test::swept(plan, dir_ / "out", blocks);
  }
  static std::string refusal(const fs::path& file) {
    try {
      open_table(file);
    } catch (const FileError& e) {
      return e.what();
    }
    return "nothing";
  }

  test::TempDir dir_;
};

TEST_F(Tables, OpenWithTheirPlanAndAllThatIsDone) {
  const SweepPlan plan = test::sweep_plan(dir_, kMaps);
  const fs::path file = written(plan, 7);
  EXPECT_EQ(sweep_table_at(dir_ / "out"), file);
  EXPECT_EQ(sweep_table_at(file), file);
  EXPECT_FALSE(sweep_table_at(dir_ / ""));
  EXPECT_FALSE(sweep_table_at(dir_ / "plan.toml"));
  const auto opened = open_table(file);
  EXPECT_EQ(opened->plan->key, plan.key);
  EXPECT_EQ(opened->build, hex(build_digest()));
  EXPECT_EQ(opened->why_no_run, "");
  EXPECT_EQ(opened->table.count(), 7u);
  EXPECT_GT(opened->table.at(6, 0), 0);
  // The same plan is not read again.
  EXPECT_EQ(open_table(file, opened.get())->plan, opened->plan);
}

TEST_F(Tables, SayWhatTheyLack) {
  const fs::path file = written(test::sweep_plan(dir_, kMaps));
  EXPECT_THAT(refusal(dir_ / "plan.toml"), HasSubstr("not the table of a sweep"));
  const hid_t h5 = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Adelete(h5, "key");
  H5Fclose(h5);
  EXPECT_EQ(refusal(file), "nothing");  // from an older program
  const hid_t again = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Ldelete(again, "/measure/stable", H5P_DEFAULT);
  H5Fclose(again);
  EXPECT_THAT(refusal(file), HasSubstr("damaged: /measure/stable"));
  fs::resize_file(file, fs::file_size(file) / 2);
  EXPECT_THAT(refusal(file), HasSubstr("damaged"));
}

TEST_F(Tables, HaveNothingOfOtherFiles) {
  const fs::path file = written(test::sweep_plan(dir_, kMaps));
  const auto put = [&](hid_t creation) {
    const hid_t h5 = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    H5Ldelete(h5, "/measure/stable", H5P_DEFAULT);
    const hsize_t size = 18;
    const hid_t space = H5Screate_simple(1, &size, nullptr);
    H5Dclose(H5Dcreate2(h5, "/measure/stable", H5T_IEEE_F64LE, space, H5P_DEFAULT, creation,
                        H5P_DEFAULT));
    H5Sclose(space);
    H5Fclose(h5);
  };
  const hid_t elsewhere = H5Pcreate(H5P_DATASET_CREATE);
  ASSERT_GE(H5Pset_external(elsewhere, (dir_ / "plan.toml").c_str(), 0, 18 * 8), 0);
  put(elsewhere);
  H5Pclose(elsewhere);
  EXPECT_THAT(refusal(file), HasSubstr("/measure/stable: is stored in other files"));
  const hid_t h5 = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Ldelete(h5, "/measure/stable", H5P_DEFAULT);
  H5Lcreate_external("other.h5", "/a", h5, "/measure/stable", H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(h5);
  EXPECT_THAT(refusal(file), HasSubstr("/measure/stable: is a link to another file"));
}

TEST_F(Tables, AreLookedAtWithoutTheFilesOfTheirPlanButNotRun) {
  std::string text = kMaps;
  text.replace(text.find("free.toml"), 9, "mine.toml");
  fs::copy_file(fs::path(LIMPID_ASSETS_DIR) / "scenes/free.toml", dir_ / "mine.toml");
  const fs::path file = written(test::sweep_plan(dir_, text));
  EXPECT_EQ(open_table(file)->why_no_run, "");
  std::ofstream(dir_ / "mine.toml", std::ios::app) << "# another\n";
  EXPECT_THAT(open_table(file)->why_no_run, HasSubstr("have changed since"));
  fs::remove(dir_ / "mine.toml");
  const auto opened = open_table(file);
  EXPECT_THAT(opened->why_no_run, HasSubstr("not found: "));
  EXPECT_EQ(make_map(*opened, first_choice(*opened->plan, opened->table)).spots.size(), 6u);
}

TEST_F(Tables, AreMapsOverAnyTwoAxes) {
  const auto opened = open_table(written(test::sweep_plan(dir_, kMaps)));
  MapChoice choice = first_choice(*opened->plan, opened->table);
  EXPECT_EQ(choice.x, 1u);
  EXPECT_EQ(choice.y, 2u);
  choice.place = {2, 0, 0};
  const SweepMap map = make_map(*opened, choice);
  EXPECT_EQ(map.kind, SweepMap::Kind::cells);
  EXPECT_EQ(map.rows, 3u);
  ASSERT_EQ(map.spots.size(), 6u);
  // Spots run from the softest grip on, in any order of the plan; eta upwards.
  EXPECT_EQ(map.spots[0].x, 100);
  EXPECT_EQ(map.spots[0].point, 2u * 6 + 3);
  EXPECT_EQ(map.spots[4].point, 2u * 6 + 1);
  EXPECT_EQ(map.spots[4].cell.value, opened->table.at(13, 0));
  ASSERT_EQ(map.lines.size(), 1u);
  EXPECT_EQ(map.lines[0].label, "PR (25)");
  // Words have the places 0, 1, 2.
  choice.y = 0;
  const SweepMap kinds = make_map(*opened, choice);
  EXPECT_EQ(kinds.spots[2].y, 2);
  EXPECT_EQ(kinds.y_range, std::pair(-0.5, 2.5));
  choice.y.reset();
  EXPECT_EQ(make_map(*opened, choice).kind, SweepMap::Kind::curve);
}

TEST_F(Tables, HaveALineWhereYesTurnsToNo) {
  const SweepPlan plan = test::sweep_plan(dir_, R"(scene = "free.toml"
measure = ["stable"]
axis = [ { key = "hand.stiffness", values = [100, 200, 300] },
         { key = "coupling.eta", values = [0.4, 0.6] } ]
)");
  OpenedSweep sweep{"", std::make_shared<SweepPlan>(plan), SweepTable(plan), "", "", {{0, 1}}};
  sweep.table.take(0, {1, 1, 1, 0, 1, 0});
  const SweepMap map = make_map(sweep, first_choice(plan, sweep.table));
  ASSERT_EQ(map.lines.size(), 1u);
  std::vector<FigurePoint> ends;
  for (const FigurePoint& p : map.lines[0].points) {
    if (std::isfinite(p.x)) ends.push_back(p);
  }
  // The line goes up between 100 and 200 N/m at eta 0.6, then to the right between 0.4 and 0.6.
  ASSERT_EQ(ends.size(), 2u * 3);
  EXPECT_EQ(std::pair(ends[0].x, ends[0].y), std::pair(150.0, 0.5));
  EXPECT_EQ(std::pair(ends[1].x, ends[1].y), std::pair(150.0, 0.7));
  EXPECT_EQ(std::pair(ends[4].x, ends[4].y), std::pair(250.0, 0.5));
  EXPECT_EQ(std::pair(ends[5].x, ends[5].y), std::pair(350.0, 0.5));
}

TEST_F(Tables, HavePointsThatCanBeRecordedAgainToTheLastBit) {
  std::string text = kMaps;
  text += "[[stop]]\nmeasure = \"energy_highest\"\nabove = -1\nafter = 0.01\n";
  const SweepPlan plan = test::sweep_plan(dir_, text);
  const auto opened = open_table(written(plan));
  const std::atomic<bool> stop{false};
  const fs::path out = point_file(dir_ / "out", 7, {});
  const auto recorded = record_point(plan, 7, {}, out, stop);
  ASSERT_TRUE(recorded);
  const auto row = std::span(opened->table.values).subspan(14, 2);
  EXPECT_EQ(differences(plan, recorded->values, row), "");
  const std::vector<double> other{row[0] + 1e-9, row[1]};
  EXPECT_THAT(differences(plan, other, row), HasSubstr("human_rms is"));
  // The rule that ended the run ends the recording.
  EXPECT_EQ(read_session(out).size(), 10u);
  const std::atomic<bool> stopped{true};
  EXPECT_FALSE(record_point(plan, 8, {}, point_file(dir_ / "out", 8, {}), stopped));
  EXPECT_FALSE(fs::exists(point_file(dir_ / "out", 8, {})));
  EXPECT_FALSE(fs::exists(dir_ / "out/points/8.h5.part"));
}

}  // namespace
}  // namespace limpid
