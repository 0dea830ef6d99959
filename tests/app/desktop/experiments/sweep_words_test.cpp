// The lines around a sweep's map, and the questions of a new one: what stands where, and what each
// says and does.
#include <fmt/format.h>

#include <cmath>

#include "app/desktop/widgets/modal.h"
#include "app/sweep/measures.h"
#include "tests/app/desktop/shell/whole_window.h"
#include "tests/app/sweep/plans.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class LinesOfASweep : public WholeWindow {
 protected:
  void open(const std::string& plan, const fs::path& folder, std::uint64_t blocks = 1000) {
    desktop->world.open_files({test::swept(test::sweep_plan(dir, plan), folder, blocks)});
    ASSERT_TRUE(until([&] { return drawn(); }));
    frames(3);
  }
  bool drawn() const {
    const SweepController& sweep = desktop->sweep;
    return sweep.map() != nullptr && sweep.map()->choice == sweep.choice() && sweep.on_screen;
  }
  // Expects these texts of the dialog to stand side by side in their order.
  static void expect_line(const std::vector<std::string>& texts) {
    std::optional<test::DrawnText> before;
    for (const std::string& text : texts) {
      const auto at = find(text, "Sweep");
      ASSERT_TRUE(at) << text << " is not in:\n" << words("Sweep");
      if (before) {
        EXPECT_NEAR(at->middle().y, before->middle().y, 5) << text;
        EXPECT_GT(at->min.x, before->max.x) << text;
      }
      before = at;
    }
  }
  static std::string tooltip_now() {
    std::string said;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.window.starts_with("##Tooltip")) said += each.text + '\n';
    }
    return said;
  }
};

TEST_F(LinesOfASweep, StandBesideEachOther) {
  const fs::path folder = sweeps_dir() / "mine";
  open(test::kGrips, folder, 4);
  expect_line({"rms hand torque", "over", "Grip stiffness", "and", "Impedance scaling \xCE\xB7"});
  expect_line({"Coupling", "standard"});
  expect_line({"4 of 18 points, filling", desktop->sweep.map()->lines.at(0).label});
  expect_line({"Go on", "New sweep...", folder.string()});
  const auto count = find("4 of 18 points, filling", "Sweep"), go_on = find("Go on", "Sweep"),
             close = find("Close (Esc)", "Sweep");
  ASSERT_TRUE(count && go_on && close);
  EXPECT_LT(count->max.y, go_on->min.y);
  EXPECT_LT(go_on->max.y, close->min.y);
  EXPECT_GT(close->min.x, desktop->sweep.on_screen->rect.max.x - 100) << "at the right";
  const auto says = find(
      "Dots mark computed points. A click runs the point again and plays it; F6 returns to the "
      "map.",
      "Sweep");
  ASSERT_TRUE(says) << words("Sweep");
  EXPECT_NEAR(says->middle().y, close->middle().y, 5);
  EXPECT_LT(says->max.x, close->min.x);
  EXPECT_LT(says->min.x, desktop->sweep.on_screen->rect.min.x) << "at the left";
}

TEST_F(LinesOfASweep, SayWhatTheirChoicesAre) {
  open(test::kGrips, dir / "swept");
  const SweepTable& table = desktop->sweep.sweep()->table;
  EXPECT_THAT(hint("rms hand torque", "Sweep"), HasSubstr(table.columns[0].what.substr(0, 25)));
  EXPECT_THAT(hint("Grip stiffness", "Sweep"),
              HasSubstr("The setting on the map's horizontal axis"));
  EXPECT_THAT(hint("Impedance scaling \xCE\xB7", "Sweep"),
              HasSubstr("The setting on the map's vertical axis"));
  EXPECT_THAT(hint("standard", "Sweep"), HasSubstr("standard")) << "a long name may be cut off";
  EXPECT_FALSE(find("Go on", "Sweep")) << "all is computed";
  click("New sweep...", "Sweep");
  EXPECT_EQ(desktop->dialog.name(), "new sweep");
}

TEST_F(LinesOfASweep, AreLeftByTheirButton) {
  open(test::kGrips, dir / "swept");
  click("Close (Esc)", "Sweep");
  EXPECT_EQ(desktop->dialog.name(), "");
}

// Axes are exchanged rather than being the same twice.
TEST_F(LinesOfASweep, KeepTwoAxesApart) {
  open(test::kGrips, dir / "swept");
  const std::string eta = "Impedance scaling \xCE\xB7";
  const auto axes = [&] {
    const MapChoice& choice = desktop->sweep.choice();
    return std::pair(choice.x, choice.y);
  };
  ASSERT_EQ(axes(), std::pair(std::size_t{1}, std::optional<std::size_t>(2)));
  click("Grip stiffness", "Sweep");
  click(eta, "##Combo");
  ASSERT_TRUE(until([&] { return drawn(); }));
  EXPECT_EQ(axes(), std::pair(std::size_t{2}, std::optional<std::size_t>(1)))
      << "by the first list";
  frames(3);
  click("Grip stiffness", "Sweep");  // now the second list
  click(eta, "##Combo");
  ASSERT_TRUE(until([&] { return drawn(); }));
  EXPECT_EQ(axes(), std::pair(std::size_t{1}, std::optional<std::size_t>(2))) << "by the second";
}

// The questions of a new sweep.
class SweepQuestions : public WholeWindow {
 protected:
  static constexpr const char* kQuestions = "New sweep";
  void SetUp() override {
    WholeWindow::SetUp();
    if (!desktop) return;
    run("sweep.begin");
    frames(4);
  }
  std::optional<ImVec2> place(const std::string& label) {
    for (const NotedPlace& each : noted_places()) {
      if (each.label == label) return each.at;
    }
    ADD_FAILURE() << label << " is not there";
    return std::nullopt;
  }
};

TEST_F(SweepQuestions, SayWhatIsAskedFor) {
  for (const auto& [label, help] : {std::pair("Vary", "The setting on the map's horizontal axis"),
                                    {"and", "if there is a second setting"},
                                    {"Measure", "notes for each run whether it diverged"},
                                    {"Hand", "the same in each run"},
                                    {"Length", "0: as long as the hand's path."},
                                    {"spaced evenly in ratio", "Off: values like 1, 50, 100"}}) {
    EXPECT_THAT(hint(label, kQuestions), HasSubstr(help)) << label;
  }
  float below = 0;
  for (const char* label : {"Vary", "and", "Measure", "Hand", "Length"}) {
    const auto at = find(label, kQuestions);
    ASSERT_TRUE(at) << label;
    EXPECT_GT(at->min.y, below) << label;
    below = at->max.y;
  }
}

TEST_F(SweepQuestions, HaveTheNumbersOfAnAxisInALine) {
  const auto from = place("first from"), to = place("first to"), count = place("first count");
  ASSERT_TRUE(from && to && count);
  EXPECT_NEAR(from->y, to->y, 2);
  EXPECT_NEAR(to->y, count->y, 2);
  EXPECT_LT(from->x, to->x);
  EXPECT_LT(to->x, count->x);
  for (const auto& [word, after] : {std::pair("from", from->x), {"to", to->x}, {"in", count->x}}) {
    const auto at = find(word, kQuestions);
    ASSERT_TRUE(at) << word;
    EXPECT_NEAR(at->middle().y, from->y, 5) << word;
    EXPECT_LT(at->max.x, after) << word << " stands before its number";
  }
  const auto start = find("Start (Enter)", kQuestions), cancel = find("Cancel (Esc)", kQuestions);
  ASSERT_TRUE(start && cancel);
  EXPECT_NEAR(start->middle().y, cancel->middle().y, 2);
  EXPECT_LT(start->max.x, cancel->min.x);
}

}  // namespace
}  // namespace limpid
