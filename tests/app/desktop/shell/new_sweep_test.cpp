// The dialog of a new sweep: what it offers, refuses and starts.
#include <fmt/format.h>
#include <imgui_internal.h>

#include "app/sweep/measures.h"
#include "tests/app/desktop/shell/whole_window.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class ANewSweep : public WholeWindow {
 protected:
  static constexpr const char* kDialog = "New sweep";

  void SetUp() override {
    WholeWindow::SetUp();
    if (!desktop) return;
    run("sweep.begin");
    frames(4);
  }
  // Clicks a place that a program may click, in whatever window it is.
  void click_at(const std::string& label) {
    for (const NotedPlace& each : noted_places()) {
      if (each.label != label) continue;
      const ImVec2 at = each.at;
      return click(at);
    }
    ADD_FAILURE() << label << " is not there";
  }
  void turn_wheel(float steps) {
    ImGui::GetIO().MouseWheel = steps;
    frames(3);
  }
  // Chooses what an axis is about, in a list that shows some of its rows.
  void choose(const std::string& axis, const std::string& key) {
    click_at(axis);
    frames(3);
    for (int i = 0; i < 60; ++i) {
      const auto& all = noted_places();
      const auto found = std::ranges::find(all, key, &NotedPlace::label);
      ASSERT_NE(found, all.end()) << key;
      const ImVec2 at = found->at;
      const ImRect list = ImGui::FindWindowByID(found->id)->InnerClipRect;
      if (list.Contains(at)) return click(at);
      point_at(list.GetCenter());
      turn_wheel(at.y > list.Max.y ? -1 : 1);
    }
    FAIL() << key << " cannot be scrolled to";
  }
  void type(const std::string& label, const std::string& number) {
    click_at(label);
    write_over(number);
    press(GLFW_KEY_TAB);
    frames(2);
  }
  std::string says() { return sentences(kDialog); }
  fs::path sweeps() const { return dir / "data/limpid/sweeps"; }
};

TEST_F(ANewSweep, NamesTheLawAndSaysWhereEtaDoesNothing) {
  const auto with = [&](CouplingKind kind) {
    desktop->settings.parameters().kind = kind;
    frames(3);
    return says();
  };
  for (std::uint8_t i = 0; i < kLaws; ++i) {
    const LawInfo& law = info(CouplingKind{i});
    const std::string said = with(CouplingKind{i});
    EXPECT_THAT(said, HasSubstr(fmt::format("Law: {}.", law.label)));
    EXPECT_EQ(said.find("It does not use \xCE\xB7") == std::string::npos, law.takes_eta) << law.key;
  }
  choose("##first", "coupling.kind");
  frames(3);
  EXPECT_THAT(says(), Not(HasSubstr("Law: ")));
}

TEST_F(ANewSweep, ProposesEtaOverItsRangeAndMeasuresTheEnergy) {
  const std::string said = says();
  EXPECT_THAT(said, HasSubstr("8 runs, kept in " + sweeps().string()));
  EXPECT_THAT(said, HasSubstr("nothing else"));
  EXPECT_TRUE(find(find_parameter("coupling.eta")->caption, kDialog));
  for (const char* label : {"Vary", "and", "Measure", "Hand", "Length"}) {
    EXPECT_NE(hint(label, kDialog), "") << label;
  }
  const auto measures = measure_table();
  const auto energy =
      std::ranges::find(measures, std::string_view("energy_highest"), &MeasureInfo::name);
  EXPECT_TRUE(find(energy->words, kDialog));
  EXPECT_THAT(hint(energy->words, kDialog), HasSubstr(std::string(energy->what).substr(0, 20)));
}

TEST_F(ANewSweep, CountsTheRunsOfBothSettings) {
  type("first count", "5");
  EXPECT_THAT(says(), HasSubstr("5 runs, "));
  choose("##second", "hand.stiffness");
  EXPECT_THAT(says(), HasSubstr("40 runs, "));
  EXPECT_TRUE(find(find_parameter("hand.stiffness")->caption, kDialog));
  EXPECT_THAT(says(), HasSubstr("N/m")) << "its unit";
  type("second count", "3");
  EXPECT_THAT(says(), HasSubstr("15 runs, "));
  type("second count", "1");
  EXPECT_THAT(says(), HasSubstr("10 runs, ")) << "at least two values";
  click_at("##second");
  frames(3);
  point_at(ImGui::GetCurrentContext()->OpenPopupStack.back().Window->Rect().GetCenter());
  turn_wheel(30);
  click("nothing else", "##Combo");
  frames(3);
  EXPECT_THAT(says(), HasSubstr("5 runs, "));
}

TEST_F(ANewSweep, TakesTheWordsOfAChoiceThatAreTicked) {
  choose("##second", "coupling.kind");
  const std::size_t laws = find_parameter("coupling.kind")->words.size();
  EXPECT_THAT(says(), HasSubstr(fmt::format("{} runs, ", 8 * laws)));
  const std::string first = find_parameter("coupling.kind")->words[0];
  click(first, kDialog);
  EXPECT_THAT(says(), HasSubstr(fmt::format("{} runs, ", 8 * (laws - 1))));
  for (std::size_t i = 1; i < laws; ++i) {
    click(find_parameter("coupling.kind")->words[i], kDialog);
  }
  EXPECT_THAT(says(), HasSubstr("Choose at least one entry of each list."));
  click("Start (Enter)", kDialog);
  EXPECT_FALSE(desktop->sweep.runner().busy());
  EXPECT_EQ(desktop->dialog.name(), "new sweep");
  click(first, kDialog);
  EXPECT_THAT(says(), HasSubstr("8 runs, "));
  EXPECT_THAT(says(), Not(HasSubstr("Choose at least")));
}

TEST_F(ANewSweep, RefusesMoreRunsThanAWindowCanDo) {
  choose("##second", "hand.stiffness");
  type("first count", "200");
  type("second count", "100");
  EXPECT_THAT(says(), Not(HasSubstr("too many"))) << "as many as it can do";
  type("second count", "101");
  EXPECT_THAT(says(), HasSubstr("20200 runs are too many: the window can do at most 20000."));
  type("second count", "5000");
  EXPECT_THAT(says(), HasSubstr("200000 runs are too many")) << "no more than a thousand values";
}

TEST_F(ANewSweep, SaysWhatIsWrongWithItsNumbers) {
  EXPECT_TRUE(find("spaced evenly in ratio", kDialog));
  type("first to", "0.01");
  frames(2);
  const std::string said = says();
  EXPECT_THAT(said, Not(HasSubstr("plan:"))) << "no file's line";
  click("Start (Enter)", kDialog);
  EXPECT_FALSE(desktop->sweep.runner().busy());
  EXPECT_TRUE(!fs::exists(sweeps()) || fs::is_empty(sweeps()));
  type("first from", "0");
  EXPECT_FALSE(find("spaced evenly in ratio", kDialog)) << "zero has no ratio";
}

// Two runs of a tap, and their table in the window.
TEST_F(ANewSweep, IsStartedAndShown) {
  type("first count", "2");
  type("first from", "0.5");
  click_at("hand");
  frames(3);
  for (const char* hand : {"circle", "cup", "dominoes"}) {
    EXPECT_THAT(words("##Combo"), HasSubstr(std::string("recorded hand: ") + hand));
  }
  point_at(find("recorded hand: cup", "##Combo")->middle());
  turn_wheel(-30);
  click("a tap with 4 N on a wall of its own, without the scene", "##Combo");
  frames(3);
  click_at("measure");
  frames(3);
  for (const MeasureInfo& each : measure_table().first(3)) {
    EXPECT_THAT(words("##Combo"), HasSubstr(each.words));
    EXPECT_THAT(words("##Combo"), HasSubstr(each.name));
  }
  const MeasureInfo& chosen = measure_table()[1];
  click(chosen.words, "##Combo");
  frames(3);
  EXPECT_TRUE(find(chosen.words, kDialog));
  click("Start (Enter)", kDialog);
  const auto complete = [&] {
    return desktop->sweep.sweep() != nullptr && desktop->sweep.sweep()->table.complete();
  };
  for (int i = 0; i < 4 && !complete(); ++i) until(complete);  // a busy computer takes its time
  const auto state = [&] {
    std::string text =
        fmt::format("dialog '{}', {}{}, {}", desktop->dialog.name(),
                    desktop->sweep.why_not_started(), desktop->sweep.runner().under_way(),
                    desktop->sweep.sweep() == nullptr ? "no table" : "a table");
    for (const auto& each : fs::recursive_directory_iterator(sweeps_dir())) {
      text += "\n" + each.path().string();
    }
    return text;
  };
  ASSERT_TRUE(complete()) << state();
  EXPECT_EQ(desktop->dialog.name(), "sweep");
  const OpenedSweep& sweep = *desktop->sweep.sweep();
  EXPECT_EQ(sweep.table.points(), 2u);
  ASSERT_EQ(sweep.plan->axes.size(), 1u);
  EXPECT_EQ(sweep.plan->axes[0].key, "coupling.eta");
  EXPECT_EQ(sweep.plan->axes[0].values, (std::vector<double>{0.5, 1}));
  EXPECT_EQ(sweep.plan->title,
            fmt::format("{} over {}", chosen.words, find_parameter("coupling.eta")->caption));
  std::vector<std::string> measured;
  for (const SweepColumn& column : sweep.table.columns) measured.push_back(column.name);
  EXPECT_THAT(measured, testing::Contains(chosen.name));
  EXPECT_THAT(measured, testing::Contains("diverged")) << "always noted";
}

TEST_F(ANewSweep, IsLeftByItsButtonAndKeepsWhatWasChosen) {
  type("first count", "5");
  click("Cancel (Esc)", kDialog);
  EXPECT_EQ(desktop->dialog.name(), "");
  run("sweep.begin");
  frames(4);
  EXPECT_THAT(says(), HasSubstr("5 runs, "));
}

}  // namespace
}  // namespace limpid
