// The map of a sweep in the window: its words, its choices, its points.
#include "app/sweep/sweep_map.h"

#include <fmt/format.h>

#include "tests/app/desktop/shell/whole_window.h"
#include "tests/app/sweep/plans.h"
#include "tests/support/drawn_ink.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class MapOfASweep : public WholeWindow {
 protected:
  fs::path folder() const { return dir / "swept"; }
  void open(const SweepPlan& plan, std::uint64_t blocks = 1000) {
    desktop->world.open_files({test::swept(plan, folder(), blocks)});
    ASSERT_TRUE(until([&] { return drawn(); }));
    frames(3);
  }
  bool drawn() const {
    const SweepController& sweep = desktop->sweep;
    return sweep.map() != nullptr && sweep.map()->choice == sweep.choice() && sweep.on_screen;
  }
  // Middle of a cell of a map whose cells have one size, counted from the left and from below.
  ImVec2 cell(int x, int columns, int y, int rows) const {
    const ScreenRect& map = desktop->sweep.on_screen->rect;
    return {map.min.x + map.width() * (static_cast<float>(x) + 0.5f) / static_cast<float>(columns),
            map.max.y - map.height() * (static_cast<float>(y) + 0.5f) / static_cast<float>(rows)};
  }
  // Reads the tooltip: each name with its value, a text a line.
  static std::string pointed() {
    std::vector<test::DrawnText> all = test::drawn_texts();
    std::erase_if(all, [](const auto& each) { return !each.window.starts_with("##Tooltip"); });
    const auto in_line = [](const auto& a, const auto& b) {
      return std::abs(a.middle().y - b.middle().y) < 6;
    };
    std::ranges::sort(all, [&](const auto& a, const auto& b) {
      return in_line(a, b) ? a.min.x < b.min.x : a.min.y < b.min.y;
    });
    std::string said;
    for (const test::DrawnText& each : all) said += each.text + '\n';
    return said;
  }
  static std::vector<std::string> lines(std::span<const Fact> facts) {
    std::vector<std::string> all;
    for (const Fact& each : facts) all.push_back(each.name + ": " + each.value);
    return all;
  }
  std::string in_table(std::uint64_t point, std::size_t column) const {
    return fmt::format("{:.6g}", desktop->sweep.sweep()->table.at(point, column));
  }
};

TEST_F(MapOfASweep, NamesMeasureAxesAndHowFarItIs) {
  open(test::sweep_plan(dir, test::kGrips));
  EXPECT_EQ(desktop->dialog.name(), "sweep");
  const std::string shown = words();
  for (const char* text : {"Sweep: Grips", "rms hand torque", "over", "and", "Coupling", "standard",
                           "Impedance scaling \xCE\xB7 [-] over Grip stiffness [N/m]",
                           "18 of 18 points", "rms hand torque [mN m]"}) {
    EXPECT_THAT(shown, HasSubstr(text));
  }
  EXPECT_THAT(shown, HasSubstr(theory_label("pr")));
  EXPECT_THAT(shown, HasSubstr("A click runs the point again and plays it"));
}

TEST_F(MapOfASweep, NamesEachChoiceBesideIt) {
  open(test::sweep_plan(dir, test::kGrips));
  for (const auto& [label, chosen] : {std::pair("over", "Grip stiffness"),
                                      {"and", "Impedance scaling \xCE\xB7"},
                                      {"Coupling", "standard"}}) {
    const auto name = find(label, "Sweep"), choice = find(chosen, "Sweep");
    ASSERT_TRUE(name && choice) << label << " or " << chosen << " is not in:\n" << words("Sweep");
    EXPECT_LT(name->max.x, choice->min.x) << label;
    EXPECT_NEAR(name->middle().y, choice->middle().y, 6) << label << ": in one line";
  }
}

// Points are numbered with the last axis fastest: kind, stiffness (1000 first), eta.
TEST_F(MapOfASweep, SaysThePointUnderTheMouse) {
  open(test::sweep_plan(dir, test::kGrips));
  const auto point_of_cell = [](int x, int y) {
    return static_cast<std::uint64_t>((1 - x) * 3 + y);
  };
  for (const auto& [x, y] : {std::pair(0, 0), std::pair(0, 2), std::pair(1, 1)}) {
    point_at(cell(x, 2, y, 3));
    const std::uint64_t number = point_of_cell(x, y);
    EXPECT_EQ(desktop->sweep.on_screen->pointed_at, number);
    EXPECT_EQ(pointed(),
              fmt::format("point\n{}\nCoupling\nstandard\nGrip stiffness\n{} N/m\nImpedance "
                          "scaling \xCE\xB7\n{:.4g}\n"
                          "rms hand torque\n{} N m\ncomes to rest\n{}\n",
                          number, x == 0 ? "100" : "1000", 0.4 + 0.3 * y, in_table(number, 0),
                          in_table(number, 1) == "1" ? "yes" : "no"));
  }
  away();
  EXPECT_FALSE(desktop->sweep.on_screen->pointed_at);
  EXPECT_EQ(pointed(), "");
}

// A point is marked where its values are on the axes: in the middle of its cell.
TEST_F(MapOfASweep, MarksItsPointsWhereTheirValuesAre) {
  open(test::sweep_plan(dir, test::kGrips));
  const auto marked = [](ImVec2 at) {
    return test::inked(at, [](ImU32 ink) { return ink == IM_COL32(0, 0, 0, 255); });
  };
  for (int x = 0; x < 2; ++x) {
    for (int y = 0; y < 3; ++y) {
      const ImVec2 middle = cell(x, 2, y, 3);
      EXPECT_TRUE(marked(middle)) << x << ", " << y;
      EXPECT_FALSE(marked({middle.x + 8, middle.y})) << x << ", " << y;
      EXPECT_FALSE(marked({middle.x, middle.y + 8})) << x << ", " << y;
    }
  }
}

TEST_F(MapOfASweep, PlaysThePointThatIsClicked) {
  open(test::sweep_plan(dir, test::kGrips));
  click(cell(1, 2, 1, 3));
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  EXPECT_TRUE(
      said("Point 1: kind standard, stiffness 1000 N/m, eta 0.7. The result is exactly the "
           "same as in the table."));
  EXPECT_EQ(desktop->dialog.name(), "");
  EXPECT_TRUE(fs::exists(folder() / "points/1.h5"));
  frames(4);
  EXPECT_THAT(sentences(),
              HasSubstr("kind standard, stiffness 1000 N/m, eta 0.7: rms hand torque "));
  click("Back to map (F6)");
  EXPECT_EQ(desktop->dialog.name(), "sweep");
}

TEST_F(MapOfASweep, TellsWhatThePointIsThatIsPlayed) {
  open(test::sweep_plan(dir, test::kGrips));
  click(cell(1, 2, 1, 3));
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  const PlayedSession& played = *desktop->playback.shown();
  EXPECT_THAT(lines(played.facts()), ElementsAre("Point of the sweep: 1", "kind: standard",
                                                 "stiffness: 1000 N/m", "eta: 0.7"));
  const SweepTable& table = desktop->sweep.sweep()->table;
  const std::vector<std::string> verdict = lines(played.verdict());
  ASSERT_GE(verdict.size(), 2u);
  EXPECT_EQ(verdict[0], fmt::format("rms hand torque: {:.4g} N m", table.at(1, 0)));
  EXPECT_EQ(verdict[1], table.at(1, 1) == 1 ? "comes to rest: yes" : "comes to rest: no");
}

TEST_F(MapOfASweep, SaysThatAPointDiffersFromItsTable) {
  const SweepPlan plan = test::sweep_plan(dir, test::kGrips);
  const SweepFolder swept(plan, folder());
  SweepBook book(plan, swept, false);
  const std::atomic<bool> stop{false};
  for (std::uint64_t b = 0; b < blocks_of(plan); ++b) {
    std::vector<double> values = *measure_point(plan, block_of(plan, b).first, stop);
    values[0] += 0.5;
    book.take(b, values);
  }
  book.write();
  desktop->world.open_files({swept.table()});
  ASSERT_TRUE(until([&] { return drawn(); }));
  frames(3);
  const double wrong = desktop->sweep.sweep()->table.at(1, 0);
  click(cell(1, 2, 1, 3));
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  EXPECT_TRUE(
      said(fmt::format("The result differs from the table: human_rms is {:.6g}, but the "
                       "table says {:.6g}.",
                       wrong - 0.5, wrong)));
  EXPECT_TRUE(desktop->notices.all().back().bad);
}

TEST_F(MapOfASweep, PlaysAPointThatItsTableLacks) {
  open(test::sweep_plan(dir, test::kGrips), 4);
  click(cell(0, 2, 2, 3));
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  EXPECT_TRUE(
      said("Point 5: kind standard, stiffness 100 N/m, eta 1. The table does not have this "
           "point yet."));
}

TEST_F(MapOfASweep, NamesTheRepeatOfAPoint) {
  std::ofstream(dir / "hand.csv") << "time_s,x_m,y_m,z_m\n0,0.19,0,0\n0.05,0.191,0,0\n";
  open(test::sweep_plan(dir, R"(title = "Twice"
scene = "free.toml"
hand = "hand.csv"
measure = ["human_rms"]
repeats = 2
axis = [ { key = "coupling.eta", values = [0.5, 1] },
         { key = "hand.stiffness", values = [100, 200] } ]
)"));
  click(cell(1, 2, 1, 2));
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  const std::vector<std::string> facts = lines(desktop->playback.shown()->facts());
  ASSERT_FALSE(facts.empty());
  EXPECT_EQ(facts.back(), "repeat: 0");
}

TEST_F(MapOfASweep, ShowsWhatIsChosen) {
  open(test::sweep_plan(dir, test::kGrips));
  const auto choose = [&](const char* shown, const char* wanted) {
    click(shown, "Sweep");
    click(wanted, "##Combo");
    ASSERT_TRUE(until([&] { return drawn(); }));
    frames(3);
  };
  choose("standard", "predictive");
  point_at(cell(0, 2, 0, 3));
  EXPECT_THAT(pointed(), HasSubstr("point\n15\nCoupling\npredictive\nGrip stiffness\n100 "
                                   "N/m\nImpedance scaling \xCE\xB7\n0.4\n"));
  choose("Grip stiffness", "Impedance scaling \xCE\xB7");
  EXPECT_THAT(words(), HasSubstr("Grip stiffness [N/m] over Impedance scaling \xCE\xB7 [-]"));
  point_at(cell(2, 3, 1, 2));
  EXPECT_THAT(pointed(), HasSubstr("point\n14\nCoupling\npredictive\nGrip stiffness\n1000 "
                                   "N/m\nImpedance scaling \xCE\xB7\n1\n"));
  choose("rms hand torque", "comes to rest");
  EXPECT_THAT(words(), HasSubstr("comes to rest: yes"));
  EXPECT_THAT(words(), Not(HasSubstr("rms hand torque [mN m]"))) << "a yes or no has no scale";
  choose("Grip stiffness", "Coupling");
  EXPECT_THAT(words(), HasSubstr("Coupling over Impedance scaling \xCE\xB7 [-]"));
  EXPECT_EQ(desktop->sweep.choice().y, 0u);
}

TEST_F(MapOfASweep, FollowsATableThatFills) {
  const SweepPlan plan = test::sweep_plan(dir, test::kGrips);
  open(plan, 4);
  EXPECT_THAT(words(), HasSubstr("4 of 18 points, filling"));
  point_at(cell(0, 2, 2, 3));
  EXPECT_THAT(pointed(), HasSubstr("point\n5\n"));
  EXPECT_THAT(pointed(), HasSubstr("not computed yet"));
  EXPECT_THAT(pointed(), Not(HasSubstr("rms hand torque\n")));
  test::swept(plan, folder());
  EXPECT_TRUE(until([&] { return find("18 of 18 points").has_value(); }));
  const std::string measured = "rms hand torque\n" + in_table(5, 0);
  EXPECT_TRUE(until([&] { return pointed().find(measured) != std::string::npos; })) << pointed();
}

// Points of a curve are found at any height.
TEST_F(MapOfASweep, IsACurveOverOneAxis) {
  open(test::sweep_plan(dir, R"(title = "Etas"
scene = "free.toml"
hand = { at = [0.19, 0, 0], jump = [1e-4, 0, 0] }
seconds = 0.02
measure = ["human_rms"]
axis = [{ key = "coupling.eta", from = 0.4, to = 1, count = 3 }]
)"));
  EXPECT_EQ(desktop->sweep.map()->kind, SweepMap::Kind::curve);
  EXPECT_THAT(words(), testing::ContainsRegex(
                           "rms hand torque .mN m.[^\n]* over Impedance scaling .* .-.\n"));
  const ScreenRect map = desktop->sweep.on_screen->rect;
  point_at({map.max.x - 5, map.min.y + 5});
  EXPECT_EQ(pointed(), "point\n2\nImpedance scaling \xCE\xB7\n1\nrms hand torque\n" +
                           in_table(2, 0) + " N m\n");
  point_at({map.min.x + 5, map.max.y - 5});
  EXPECT_THAT(pointed(), HasSubstr("point\n0\nImpedance scaling \xCE\xB7\n0.4\n"));
}

// A boundary's point is played where the mouse is on its axis.
TEST_F(MapOfASweep, PlaysABoundaryWhereItIsClicked) {
  open(test::sweep_plan(dir, R"(title = "Limit"
scene = "free.toml"
hand = { at = [0.19, 0, 0], jump = [2e-5, 2e-5, 2e-5] }
seconds = 0.3
set = ["hand.damping = 0"]
axis = [{ key = "hand.stiffness", values = [300, 3000] }]
[boundary]
measure = "stable"
tolerance = 0.1
axis = { key = "coupling.eta", from = 0.2, to = 1, count = 3 }
)"));
  const ScreenRect map = desktop->sweep.on_screen->rect;
  const auto [low, high] = desktop->sweep.map()->y_range;
  const double at = 0.25 * low + 0.75 * high;
  click(ImVec2{map.min.x + 5, std::round(map.max.y - 0.75f * map.height())});
  EXPECT_THAT(pointed(), HasSubstr("point\n0\nGrip stiffness\n300 N/m\n"));
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  ASSERT_TRUE(said("Point 0: stiffness 300 N/m, eta "));
  const auto facts = desktop->playback.shown()->facts();
  EXPECT_EQ(facts.back().name, "eta");
  EXPECT_NEAR(std::stod(facts.back().value), at, 0.02 * (high - low));
}

TEST_F(MapOfASweep, OfAPlanWithoutAxesIsRefused) {
  const SweepPlan plan = test::sweep_plan(dir, R"(title = "One"
scene = "free.toml"
hand = { at = [0.19, 0, 0], jump = [1e-4, 0, 0] }
seconds = 0.02
measure = ["human_rms"]
)");
  desktop->world.open_files({test::swept(plan, folder())});
  EXPECT_TRUE(until([&] { return said("the sweep's plan has no axis"); }));
  EXPECT_EQ(desktop->sweep.sweep(), nullptr);
}

}  // namespace
}  // namespace limpid
