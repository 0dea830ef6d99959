// Drafts of sweeps: their text, read as any plan is, asks for what was drafted.
#include "app/sweep/sweep_draft.h"

#include <gmock/gmock.h>

#include <set>
#include <string>

#include "app/sweep/read_axes.h"
#include "tests/app/sweep/plans.h"

namespace limpid {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class Drafts : public testing::Test {
 protected:
  Drafts() {
    draft_.title = "A \"quoted\" title";
    draft_.hand = "touch.csv";
    draft_.seconds = 0.5;
    draft_.axes = {{.key = "coupling.eta", .from = 0.1, .to = 10, .count = 3, .logarithmic = true}};
    draft_.measures = {"energy_highest", "diverged"};
  }
  SweepPlan read() { return test::sweep_plan(dir_, plan_text(draft_)); }

  SweepDraft draft_;
  test::TempDir dir_;
};

TEST_F(Drafts, AskForTheRunsOfTheirAxes) {
  draft_.axes.push_back({.key = "coupling.kind", .words = {"standard", "predictive"}});
  const SweepPlan plan = read();
  EXPECT_EQ(plan.title, "A \"quoted\" title");
  EXPECT_EQ(plan.seconds, 0.5);
  ASSERT_EQ(plan.points(), 6u);
  // The geometric mean of the ends is between them on a log scale.
  EXPECT_THAT(plan.axes[0].values, ElementsAre(0.1, DoubleNear(1, 1e-12), 10));
  EXPECT_EQ(run_of(plan, 0).parameters.kind, CouplingKind::standard);
  EXPECT_EQ(run_of(plan, 5).parameters.kind, CouplingKind::predictive);
  EXPECT_EQ(run_of(plan, 5).parameters.eta, 10);
  ASSERT_EQ(plan.measures.size(), 2u);
  EXPECT_STREQ(plan.measures[0]->name, "energy_highest");
}

TEST_F(Drafts, KeepTheSettingsOfTheWindowButThoseThatAreVaried) {
  draft_.parameters.kind = CouplingKind::tank;
  draft_.parameters.hand_stiffness = 321.5;
  draft_.parameters.eta = 0.25;
  const SweepPlan plan = read();
  EXPECT_EQ(plan.parameters.kind, CouplingKind::tank);
  EXPECT_EQ(plan.parameters.hand_stiffness, 321.5);
  EXPECT_THAT(plan_text(draft_), Not(HasSubstr("coupling.eta =")));
  EXPECT_EQ(run_of(plan, 2).parameters.hand_stiffness, 321.5);
  EXPECT_EQ(run_of(plan, 2).parameters.eta, 10);
}

TEST_F(Drafts, OfATapHaveNoScene) {
  draft_.hand.clear();
  draft_.scene = "free.toml";
  draft_.tap = 3;
  draft_.axes = {{.key = kStiffnessKey, .from = 500, .to = 1500, .count = 3}};
  const SweepPlan plan = read();
  EXPECT_EQ(plan.tap, 3);
  EXPECT_EQ(plan.world.scene, "");
  EXPECT_THAT(plan.axes[0].values, ElementsAre(500, 1000, 1500));
}

TEST_F(Drafts, AreReadInPlainWords) {
  const SweepPlan plan = read();
  EXPECT_EQ(words_of_axis(plan.axes[0]), std::string(find_parameter("coupling.eta")->caption));
  SweepAxis own = plan.axes[0];
  own.name = "scaling";
  EXPECT_EQ(words_of_axis(own), "scaling") << "the plan's own name";
  EXPECT_EQ(words_of_measure("boundary_last"), "boundary last");
  std::set<std::string> all;
  for (const MeasureInfo& measure : measure_table()) {
    EXPECT_EQ(words_of_measure(measure.name), measure.words);
    EXPECT_THAT(measure.words, Not(HasSubstr("_"))) << measure.name;
    EXPECT_TRUE(all.insert(measure.words).second) << measure.words;
  }
}

TEST_F(Drafts, CountThePointsThatDiverged) {
  const SweepPlan plan = read();
  SweepTable table(plan);
  EXPECT_EQ(diverged_points(table), 0u);
  table.take(1, {0.2, 1, 0.3, 0});  // of the last two points: energy, diverged
  EXPECT_EQ(diverged_points(table), 1u);
}

TEST_F(Drafts, ShowTheLimitOfTheoryOverEtaForTheLawThatHasOne) {
  EXPECT_THAT(read().figure.theory, ElementsAre("pr"));
  draft_.axes.push_back({.key = "coupling.kind", .words = {"standard", "predictive"}});
  EXPECT_TRUE(read().figure.theory.empty()) << "curves of other laws are among them";
  draft_.axes.pop_back();
  draft_.parameters.kind = CouplingKind::standard;
  EXPECT_TRUE(read().figure.theory.empty());
  draft_.parameters.kind = CouplingKind::proposed;
  draft_.axes = {{.key = "hand.stiffness", .from = 10, .to = 20, .count = 2}};
  EXPECT_TRUE(read().figure.theory.empty());
}

TEST_F(Drafts, AreCalledByWhatTheyMeasureAndVary) {
  EXPECT_EQ(short_name(draft_), "energy_highest over eta");
  draft_.axes.push_back({.key = "hand.stiffness", .from = 10, .to = 20, .count = 2});
  draft_.axes.push_back({.key = "scene.body.die.mass", .from = 1, .to = 2, .count = 2});
  EXPECT_EQ(short_name(draft_), "energy_highest over eta and stiffness and mass");
  EXPECT_EQ(short_name({}), "sweep");
}

// Gains that happen to be the paper's are not fitted to another arm behind a person's back.
TEST_F(Drafts, SayTheGainsOfAnotherArm) {
  draft_.device = "omega.urdf";
  draft_.hand.clear();
  draft_.parameters.b_v = 0.5;
  const SweepPlan plan = read();
  EXPECT_EQ(plan.world.device, "omega.urdf");
  EXPECT_EQ(plan.tap, 4) << "as usual";
  const Parameters run = run_of(plan, 0).parameters;
  EXPECT_EQ(run.k_vc, Parameters{}.k_vc);
  EXPECT_EQ(run.b_v, 0.5);
  EXPECT_EQ(run.alpha, Parameters{}.alpha);
  draft_.device.clear();
  EXPECT_THAT(plan_text(draft_), Not(HasSubstr("coupling.k_vc")));
  EXPECT_THAT(plan_text(draft_), HasSubstr("coupling.b_v"));
}

TEST_F(Drafts, LeaveOutWhatIsAsUsual) {
  draft_ = {.title = "Plain", .hand = "touch.csv", .measures = {"energy"}};
  const SweepPlan plan = read();
  EXPECT_TRUE(plan.settings.empty());
  EXPECT_EQ(plan.seconds, 0) << "as long as the hand";
  EXPECT_EQ(plan.points(), 1u);
  const std::string text = plan_text(draft_);
  for (const char* key : {"set", "seconds", "device", "scene", "figure"}) {
    EXPECT_THAT(text, Not(HasSubstr(std::string(key) + " ="))) << text;
  }
  draft_.axes = {{.key = "hand.stiffness", .from = 10, .to = 30, .count = 5}};
  EXPECT_THAT(read().axes.at(0).values, ElementsAre(10, 15, 20, 25, 30));
  EXPECT_FALSE(read().axes.at(0).logarithmic);
}

}  // namespace
}  // namespace limpid
