#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <set>

#include "app/study/sweep_figure.h"
#include "app/study/sweep_map.h"
#include "app/study/sweep_table.h"
#include "app/study/sweep_work.h"
#include "devices/files/text_file.h"
#include "tests/app/study/plans.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string kField = R"(scene = "free.toml"
measure = ["stable", "energy"]
block = 7
axis = [ { key = "coupling.kind", values = ["standard", "predictive"] },
         { key = "hand.stiffness", from = 100, to = 1100, count = 11 },
         { key = "coupling.eta", from = 0.1, to = 1.1, count = 11 } ]
[refine]
depth = 3
)";

class Refining : public testing::Test {
 protected:
  // Value of a point by kind, stiffness and eta; the latter two are 0 to 1 over the map.
  using Field = std::function<double(std::size_t kind, double x, double y)>;

  static double value_of(const SweepPlan& plan, std::uint64_t number, const Field& field) {
    const SweepPoint point = point_of(plan, number);
    return field(point.place[0], (point.values[1] - 100) / 1000, (point.values[2] - 0.1) / 1);
  }
  // Fills a table as a sweep would.
  static SweepTable refined(const SweepPlan& plan, const Field& field) {
    SweepTable table(plan);
    std::uint64_t from = 0;
    do {
      for (std::uint64_t i = from; i < table.points(); ++i) {
        const double value = value_of(plan, table.rows.point(i), field);
        table.take(i, {value, value});
      }
      from = table.points();
    } while (table.grow());
    return table;
  }

  test::TempDir dir_;
};

TEST_F(Refining, FindsTheSameMapAsAllPointsOfTheFineGridWithATenthOfThem) {
  const SweepPlan plan = test::sweep_plan(dir_, kField);
  ASSERT_EQ(plan.points(), 2u * 81 * 81);
  // A disc, and a line across the map.
  const Field field = [](std::size_t kind, double x, double y) {
    const bool in = kind == 0 ? std::hypot(x - 0.47, y - 0.53) < 0.31 : y > 0.2 + 0.6 * x * x;
    return in ? 1.0 : 0.0;
  };
  const SweepTable table = refined(plan, field);
  EXPECT_TRUE(table.complete());
  EXPECT_LT(static_cast<double>(table.points()), 0.13 * static_cast<double>(plan.points()));
  std::set<std::uint64_t> numbers;
  for (std::uint64_t i = 0; i < table.points(); ++i) {
    numbers.insert(table.rows.point(i));
    EXPECT_EQ(table.rows.row_of(table.rows.point(i)), i);
  }
  EXPECT_EQ(numbers.size(), table.points());
  std::uint64_t wrong = 0;
  for (std::uint64_t n = 0; n < plan.points(); ++n) {
    const auto value = table.inferred(point_of(plan, n).place, 0, 0);
    ASSERT_TRUE(value) << n;
    wrong += *value != value_of(plan, n, field);
  }
  EXPECT_EQ(wrong, 0u);
}

// An undivided cell may have a neighbour's points on its edge: the tongue enters the cells below
// where none of their own corners lies in it.
TEST_F(Refining, FollowsWhatANeighbourFound) {
  const SweepPlan plan = test::sweep_plan(dir_, kField);
  const Field field = [](std::size_t, double x, double y) {
    return y > 0.75 || (std::abs(x - 0.5625) < 0.02 && y > 0.2) ? 1.0 : 0.0;
  };
  const SweepTable table = refined(plan, field);
  std::uint64_t wrong = 0;
  for (std::uint64_t n = 0; n < plan.points(); ++n) {
    wrong += *table.inferred(point_of(plan, n).place, 0, 0) != value_of(plan, n, field);
  }
  EXPECT_EQ(wrong, 0u);
}

TEST_F(Refining, OfNumbersKeepsToItsTolerance) {
  std::string text = kField;
  text += "measure = \"energy\"\ntolerance = 0.02\n";
  const SweepPlan plan = test::sweep_plan(dir_, text);
  const Field field = [](std::size_t, double x, double y) {
    return std::exp(-std::pow((x - y) / 0.1, 2));
  };
  const SweepTable table = refined(plan, field);
  EXPECT_LT(table.points(), plan.points() / 2);
  double worst = 0;
  for (std::uint64_t n = 0; n < plan.points(); ++n) {
    const auto place = point_of(plan, n).place;
    worst = std::max(worst, std::abs(*table.inferred(place, 0, 1) - value_of(plan, n, field)));
  }
  // Between two points of the finest grid the ridge falls by 0.11; elsewhere by no more than 0.02.
  EXPECT_LT(worst, 0.02);
  // No cell is divided away from the ridge.
  EXPECT_FALSE(table.rows.row_of(number_of(plan, {0, 4, 76}, 0, 0)));
}

TEST_F(Refining, KeepsTheValuesOfTheCoarseGridAndPutsOthersInTheMiddle) {
  const SweepPlan plan = test::sweep_plan(dir_, R"(scene = "free.toml"
measure = ["stable"]
repeats = 2
axis = [ { key = "hand.stiffness", values = [100, 400, 500], scale = "log" } ]
[refine]
depth = 1
)");
  EXPECT_THAT(plan.axes[0].values,
              testing::ElementsAre(100, 200, 400, std::sqrt(400.0 * 500), 500));
  SweepTable table(plan);
  ASSERT_EQ(table.points(), 6u);
  // The second repeat alone differs, between the first two stiffnesses.
  table.take(0, {1, 0, 1, 1, 1, 1});
  ASSERT_TRUE(table.grow());
  ASSERT_EQ(table.points(), 8u);
  EXPECT_EQ(table.rows.point(6), 2u);  // 200 N/m
  EXPECT_EQ(table.rows.point(7), 3u);
  EXPECT_EQ(table.rows.round(5), 0u);
  EXPECT_EQ(table.rows.round(6), 1u);
  table.take(6, {1, 1});
  EXPECT_FALSE(table.grow());
  EXPECT_TRUE(table.complete());
}

TEST_F(Refining, RefusesWhatHasNoCells) {
  const auto refusal = [&](const std::string& from, const std::string& to) {
    std::string text = kField;
    text.replace(text.find(from), from.size(), to);
    try {
      test::sweep_plan(dir_, text);
    } catch (const FileError& e) {
      return std::string(e.what());
    }
    return std::string("nothing");
  };
  EXPECT_THAT(refusal("depth = 3", ""), HasSubstr("refine.depth"));
  EXPECT_THAT(refusal("depth = 3", "depth = 11"), HasSubstr("refine.depth"));
  EXPECT_THAT(refusal("depth = 3", "depth = 3\naxes = [\"kind\"]"), HasSubstr("in between"));
  EXPECT_THAT(refusal("depth = 3", "depth = 3\naxes = [\"etta\"]"), HasSubstr("refine.axes"));
  EXPECT_THAT(refusal("depth = 3", "depth = 3\nmeasure = \"energy\""), HasSubstr("tolerance"));
  EXPECT_THAT(refusal("depth = 3", "depth = 3\nmeasure = \"chatter\""), HasSubstr("is measured"));
}

// Refinement of real runs, which only the work itself can show.
class RefinedWork : public testing::Test {
 protected:
  static constexpr const char* kPlan = R"(title = "Refined"
scene = "free.toml"
hand = { at = [0.19, 0, 0], jump = [1e-4, 0, 0] }
seconds = 0.02
measure = ["human_rms", "energy"]
block = 3
axis = [
  { key = "coupling.kind", values = ["standard", "proposed"] },
  { key = "hand.stiffness", from = 100, to = 3000, count = 4, scale = "log" },
  { key = "coupling.eta", from = 0.4, to = 1, count = 4 },
]
[refine]
depth = 2
tolerance = 0.002
[figure]
x = "stiffness"
)";

  // Works in rounds until no points are left; returns the number of calls.
  int work(const fs::path& out, const SweepShare& share, int most = 100) {
    const SweepFolder folder(plan_, out);
    SweepBook book(plan_, folder, false);
    int calls = 0;
    while (calls < most) {
      book.gather();
      if (book.complete()) break;
      std::atomic<std::uint64_t> done{0};
      EXPECT_TRUE(work_off(plan_, book.table().rows, folder, share, stop_, done, {}));
      ++calls;
    }
    return calls;
  }
  std::string gathered(const fs::path& out) { return test::gathered(plan_, out, complete_); }

  test::TempDir dir_;
  SweepPlan plan_ = test::sweep_plan(dir_, kPlan);
  std::atomic<bool> stop_{false};
  bool complete_ = false;
};

TEST_F(RefinedWork, ComesToTheSameTableWhoeverDoesItAndWhateverIsLost) {
  EXPECT_GT(work(dir_ / "threads", {.threads = 3}), 1);
  const std::string table = gathered(dir_ / "threads");
  ASSERT_TRUE(complete_);
  // Shards run one after the other: each stops where a round needs the others.
  for (int call = 0; call < 10; ++call) {
    for (const std::uint64_t shard : {2u, 0u, 1u}) {
      work(dir_ / "shards", {.shard = shard, .shards = 3, .threads = 1}, 1);
    }
  }
  EXPECT_EQ(gathered(dir_ / "shards"), table);
  EXPECT_TRUE(complete_);
  // Deleted blocks of all rounds are made again, together with those that depend on them.
  std::vector<fs::path> blocks;
  for (const auto& entry : fs::directory_iterator(dir_ / "shards/blocks")) {
    blocks.push_back(entry.path());
  }
  std::ranges::sort(blocks);
  ASSERT_GT(blocks.size(), 20u);
  for (std::size_t i = 0; i < blocks.size(); i += 4) fs::remove(blocks[i]);
  EXPECT_NE(gathered(dir_ / "shards"), table);
  EXPECT_FALSE(complete_);
  work(dir_ / "shards", {.shard = 1, .shards = 2, .helps = true, .threads = 1});
  EXPECT_EQ(gathered(dir_ / "shards"), table);
}

TEST_F(RefinedWork, ItsTableOpensAsItWasWrittenAndEveryPointIsThatOfTheFullGrid) {
  work(dir_ / "out", {});
  gathered(dir_ / "out");
  const auto opened = open_table(dir_ / "out/table.h5");
  EXPECT_TRUE(opened->table.complete());
  EXPECT_TRUE(opened->why_no_run.empty());
  EXPECT_LT(opened->table.points(), plan_.points());
  for (std::uint64_t i = 0; i < opened->table.points(); i += 17) {
    const auto again = measure_point(plan_, opened->table.rows.point(i), stop_);
    EXPECT_EQ(again->front(), opened->table.at(i, 0)) << i;
  }
  // The map has no gaps: points that were not run are inferred.
  const SweepMap map = make_map(*opened, first_choice(*opened->plan, opened->table));
  ASSERT_EQ(map.spots.size(), 13u * 13);
  std::size_t inferred = 0;
  for (const MapSpot& spot : map.spots) {
    EXPECT_TRUE(spot.there());
    inferred += spot.inferred;
  }
  EXPECT_GT(inferred, 0u);
  EXPECT_EQ(sweep_figure(plan_, opened->table).panels[0].series[0].cells.size(), 13u * 13);
}

// A run that diverges gives no number. The border of such runs is searched, even between numbers
// that are all alike.
TEST_F(Refining, FindsTheBorderToWhereThereIsNoNumber) {
  std::string text = kField;
  text += "measure = \"energy\"\ntolerance = 0.02\n";
  const SweepPlan plan = test::sweep_plan(dir_, text);
  const Field field = [](std::size_t, double x, double y) {
    return x + y > 1.13 ? std::nan("") : 0.3;
  };
  const SweepTable table = refined(plan, field);
  EXPECT_LT(table.points(), plan.points() / 2);
  // Beside the border all points of the finest grid exist.
  std::uint64_t beside = 0;
  for (std::uint64_t n = 0; n < plan.points(); ++n) {
    const auto place = point_of(plan, n).place;
    if (place[1] + 1 > 80 || place[2] + 1 > 80) continue;
    const auto value = [&](std::size_t dx, std::size_t dy) {
      return value_of(plan, number_of(plan, {place[0], place[1] + dx, place[2] + dy}, 0, 0), field);
    };
    if (std::isnan(value(0, 0)) == std::isnan(value(1, 1))) continue;
    ++beside;
    EXPECT_TRUE(table.rows.row_of(n)) << place[1] << ", " << place[2];
  }
  EXPECT_GT(beside, 100u);
  // Far from the border, on either side, no point is run.
  EXPECT_FALSE(table.rows.row_of(number_of(plan, {0, 3, 3}, 0, 0)));
  EXPECT_FALSE(table.rows.row_of(number_of(plan, {0, 77, 77}, 0, 0)));
}

}  // namespace
}  // namespace limpid
