// Files of tables that were filled by hand: every cell and every word of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "app/base/version.h"
#include "app/sweep/sweep_table.h"
#include "app/sweep/sweep_work.h"
#include "devices/files/session/hdf5_reading.h"
#include "tests/app/sweep/plans.h"

namespace limpid {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Both axes are called like measures; the names of the cases are hard on a table of text.
const std::string kWords = R"(title = "Words and numbers"
scene = "free.toml"
seconds = 0.02
repeats = 2
measure = ["energy", "stable", "chatter"]
axis = [
  { name = "stable", cases = [ { name = "a, b", set = ["hand.damping = 3"] },
                               { name = "say \"c\"" } ] },
  { key = "hand.stiffness", name = "energy", values = [100.5, 250.5] },
]
)";

class TableFiles : public testing::Test {
 protected:
  // Points 0, 1, 2 and 5 are done.
  static SweepTable partly_filled(const SweepPlan& plan) {
    SweepTable table(plan);
    table.take(0, {0.25, 0.5, kNaN, 1e-5, 0.5, 0.75, 0.1 + 0.2, kNaN, -2.5});
    table.take(5, {-0.125, 0.5, 1e300});
    return table;
  }
  // Changes the text of an attribute of the root; empty: removes it.
  static void set_text(const std::filesystem::path& file, const char* name,
                       const std::string& text) {
    const hid_t h5 = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    H5Adelete(h5, name);
    if (!text.empty()) hdf5::write_text(h5, name, text, file);
    H5Fclose(h5);
  }
  static void set_count(const std::filesystem::path& file, const char* name, std::uint64_t count) {
    const hid_t h5 = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t attribute = H5Aopen(h5, name, H5P_DEFAULT);
    EXPECT_GE(H5Awrite(attribute, H5T_NATIVE_UINT64, &count), 0);
    H5Aclose(attribute);
    H5Fclose(h5);
  }
  static std::string why_not_opened(const std::filesystem::path& file) {
    try {
      open_table(file);
    } catch (const FileError& e) {
      return e.what();
    }
    return "opened";
  }
  const test::TempDir dir_;
};

TEST_F(TableFiles, AsTextHaveARowForEachPointThatIsDone) {
  const SweepPlan plan = test::sweep_plan(dir_, kWords);
  ASSERT_EQ(plan.points(), 8u);
  write_table_csv(plan, partly_filled(plan), dir_ / "a.csv");
  EXPECT_EQ(test::bytes_of(dir_ / "a.csv"),
            "point,axis stable,hand.stiffness [N/m],repeat,energy [J],stable [yes/no],chatter "
            "[m/s]\n"
            "0,\"a, b\",100.5,0,0.25,0.5,\n"
            "1,\"a, b\",100.5,1,1e-05,0.5,0.75\n"
            "2,\"a, b\",250.5,0,0.30000000000000004,,-2.5\n"
            "5,\"say \"\"c\"\"\",100.5,1,-0.125,0.5,1e+300\n");
}

TEST_F(TableFiles, AsTextAreWrittenOnlyWhereTheyAreWanted) {
  const SweepPlan plan = test::sweep_plan(dir_, test::kShort);
  for (const bool csv : {false, true}) {
    const SweepFolder folder(plan, dir_ / (csv ? "with" : "without"));
    SweepBook book(plan, folder, csv);
    book.take(5, {1.5, 2.5, 1});
    EXPECT_TRUE(book.has(5) && !book.has(0) && !book.complete());
    book.write();
    EXPECT_TRUE(std::filesystem::exists(folder.table()));
    const std::string text = test::bytes_of(folder.path() / "table.csv");
    EXPECT_EQ(text, csv ? "point,kind,eta,repeat,human_rms [N m],energy [J],stable [yes/no]\n"
                          "20,predictive,1,0,1.5,2.5,1\n"
                        : "");
  }
}

// A table says what its plan was, who made it, and what each column means.
TEST_F(TableFiles, HaveAllThatIsKnownOfThem) {
  const std::string text = R"(title = "All of it"
scene = "free.toml"
seconds = 0.02
samples = 3
repeats = 2
measure = ["human_rms", "stable"]
axis = [ { key = "coupling.kind", values = ["standard", "tank"] },
         { key = "hand.stiffness", from = 10, to = 1000, scale = "log", sample = "latin" } ]
)";
  const SweepPlan plan = test::sweep_plan(dir_, text);
  SweepTable table(plan);
  table.take(4, {0.5, 1, kNaN, 0});
  write_table(plan, table, dir_ / "a.h5");
  const auto path = dir_ / "a.h5";
  const hdf5::File file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  const auto said = [&](const char* name) { return hdf5::read_text(file.get(), name, path); };
  EXPECT_EQ(said("format"), "limpid-sweep");
  EXPECT_EQ(hdf5::read_count(file.get(), "version", path), 1u);
  EXPECT_EQ(said("title"), "All of it");
  EXPECT_EQ(said("plan"), text);
  EXPECT_EQ(said("key"), hex(plan.key));
  EXPECT_EQ(said("app_version"), program_version());
  EXPECT_EQ(said("build"), hex(build_digest()));
  EXPECT_EQ(hdf5::read_count(file.get(), "points", path), 12u);
  EXPECT_EQ(hdf5::read_count(file.get(), "done", path), 2u);
  const auto of = [&](const char* dataset, const char* name) {
    const hdf5::Dataset at(H5Dopen2(file.get(), dataset, H5P_DEFAULT));
    return hdf5::read_text(at.get(), name, path);
  };
  EXPECT_EQ(of("/axis/kind", "unit"), "-");
  EXPECT_EQ(of("/axis/kind", "key"), "coupling.kind");
  EXPECT_EQ(of("/axis/kind", "spread"), "grid");
  EXPECT_EQ(of("/axis/kind", "scale"), "linear");
  EXPECT_THAT(of("/axis/kind", "words"), HasSubstr("standard\nproposed\npredictive"));
  EXPECT_EQ(of("/axis/stiffness", "unit"), "N/m");
  EXPECT_EQ(of("/axis/stiffness", "key"), "hand.stiffness");
  EXPECT_EQ(of("/axis/stiffness", "spread"), "latin");
  EXPECT_EQ(of("/axis/stiffness", "scale"), "log");
  for (const char* name : {"human_rms", "stable"}) {
    const std::string dataset = std::string("/measure/") + name;
    EXPECT_EQ(of(dataset.c_str(), "unit"), find_measure(name)->unit);
    EXPECT_EQ(of(dataset.c_str(), "what"), find_measure(name)->what);
  }
  const auto column = [&](const char* dataset) {
    std::vector<double> values(12);
    const hdf5::Dataset at(H5Dopen2(file.get(), dataset, H5P_DEFAULT));
    EXPECT_GE(H5Dread(at.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
              0);
    return values;
  };
  const auto kind = column("/axis/kind"), grip = column("/axis/stiffness"),
             repeat = column("/repeat"), done = column("/done"), rms = column("/measure/human_rms"),
             stable = column("/measure/stable");
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(kind[i], plan.axes[0].values[i / 6]) << i;
    EXPECT_EQ(grip[i], plan.axes[1].values[i / 2 % 3]) << i;
    EXPECT_EQ(repeat[i], static_cast<double>(i % 2)) << i;
    EXPECT_EQ(done[i], i == 4 || i == 5 ? 1 : 0) << i;
    EXPECT_EQ(std::isnan(rms[i]), i != 4) << i;
    EXPECT_EQ(std::isnan(stable[i]), i != 4 && i != 5) << i;
  }
  EXPECT_EQ(rms[4], 0.5);
  EXPECT_EQ(stable[4], 1);
  EXPECT_EQ(stable[5], 0);
}

TEST_F(TableFiles, AreReadAsTheyWereWrittenWithTheEndsOfEachColumn) {
  const SweepPlan plan = test::sweep_plan(dir_, kWords);
  SweepTable table(plan);
  constexpr double kBeyond = std::numeric_limits<double>::infinity();
  table.take(1, {0.25, 0.5, kNaN, -3, 0.75, kBeyond, 2, 0.5, kNaN});
  write_table(plan, table, dir_ / "a.h5");
  const auto opened = open_table(dir_ / "a.h5");
  EXPECT_EQ(opened->file, dir_ / "a.h5");
  EXPECT_THAT(opened->table.done, ElementsAre(0, 1, 1, 1, 0, 0, 0, 0));
  EXPECT_EQ(opened->table.count(), 3u);
  EXPECT_FALSE(opened->table.complete());
  for (std::uint64_t point = 1; point < 4; ++point) {
    EXPECT_EQ(opened->table.at(point, 0), table.at(point, 0));
    EXPECT_EQ(opened->table.at(point, 1), table.at(point, 1));
  }
  ASSERT_EQ(opened->ranges.size(), 3u);
  EXPECT_EQ(opened->ranges[0], std::pair(-3.0, 2.0));
  EXPECT_EQ(opened->ranges[1], std::pair(0.5, 0.75));
  EXPECT_EQ(opened->ranges[2], std::pair(0.0, 1.0)) << "nothing finite";
}

TEST_F(TableFiles, OfOlderProgramsHaveRadiansOfAllArms) {
  const SweepPlan plan = test::sweep_plan(dir_, R"(device = "omega.urdf"
hand = { tap = 2 }
measure = ["human_rms", "error_largest", "wall"]
axis = [ { key = "coupling.eta", values = [0.5, 1] } ]
)");
  write_table(plan, SweepTable(plan), dir_ / "a.h5");
  const auto units = [&] {
    std::vector<std::string> all;
    for (const SweepColumn& each : open_table(dir_ / "a.h5")->table.columns) {
      all.push_back(each.unit);
    }
    return all;
  };
  EXPECT_THAT(units(), ElementsAre("N", "m", "N/m"));
  set_text(dir_ / "a.h5", "measures_in", "");
  EXPECT_THAT(units(), ElementsAre("N m", "rad", "N/m"));
}

TEST_F(TableFiles, ThatCannotBeTablesAreRefusedWithTheReason) {
  const SweepPlan plan = test::sweep_plan(dir_, kWords);
  const auto file = dir_ / "a.h5";
  const auto fresh = [&] { write_table(plan, partly_filled(plan), file); };
  fresh();
  EXPECT_EQ(why_not_opened(file), "opened");
  EXPECT_EQ(sweep_table_at(file), file);
  set_text(file, "format", "limpid-soup");
  EXPECT_EQ(why_not_opened(file),
            file.string() + ": format \"limpid-soup\"; needed: \"limpid-sweep\"");
  EXPECT_FALSE(sweep_table_at(file)) << "another program's";
  fresh();
  set_count(file, "version", 2);
  EXPECT_EQ(why_not_opened(file), file.string() + ": version 2; this program reads 1");
  fresh();
  set_count(file, "points", 7);
  EXPECT_EQ(why_not_opened(file),
            file.string() + ": damaged: it has 7 points; its sweep plan has 8");
  fresh();
  set_text(file, "plan", "");
  EXPECT_THAT(why_not_opened(file), HasSubstr("the table contains no plan"));
  fresh();
  set_text(file, "plan", plan.text + "\n[refine]\ndepth = 3\n");
  EXPECT_THAT(why_not_opened(file), HasSubstr("an older version of limpid refined this map"));
  fresh();
  const hid_t h5 = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Ldelete(h5, "/done", H5P_DEFAULT);
  H5Fclose(h5);
  EXPECT_THAT(why_not_opened(file), HasSubstr("damaged: /done"));
}

}  // namespace
}  // namespace limpid
