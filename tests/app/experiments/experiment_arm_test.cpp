// Experiments on arms other than the built-in one: which they take, and that their numbers follow
// the arm.
#include "app/experiments/experiment_arm.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/base/folders.h"
#include "app/experiments/experiment.h"
#include "app/experiments/link_theory.h"
#include "app/experiments/signals.h"
#include "app/experiments/tap_bench.h"
#include "app/run/fitted_gains.h"
#include "devices/files/config_file.h"
#include "devices/files/urdf_file.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

ArmDescription shipped(const std::string& file) {
  return read_urdf(default_device().parent_path() / file);
}

ExperimentArm touch_with_readings() {
  ExperimentArm on{shipped("touch.urdf"), {}, "touch with its readings", true};
  on.settings = with_readings_of(on.description, fitted(on.description, {}, 0.001));
  return on;
}

const Experiment& experiment(const std::string& name) {
  return *std::ranges::find(experiments(), name, &Experiment::name);
}

Outcome on_arm(const std::string& name, const ExperimentArm& on, const fs::path& dir) {
  TrialRunner::Options options;
  options.dir = dir;
  options.arm = on;
  return carry_out(experiment(name), options);
}

TEST(ExperimentArm, IsTheBuiltInArmWithThePapersSettingsUnlessChosen) {
  const ExperimentArm on = built_in_arm();
  EXPECT_TRUE(on.built_in());
  EXPECT_EQ(config_text(on.settings), config_text(Parameters{}));
  EXPECT_EQ(on.heading(), "Built-in arm");
  EXPECT_EQ(on.gains(), "paper's gains");
}

// By (3) with a delay t_d: k_vc = (b_d - 2 b_vc) / (T + 3/2 t_d) = 4 N m/rad at 1 ms.
TEST(ExperimentArm, BringsGainsThatSuitItsDelay) {
  EXPECT_THAT(touch_with_readings().gains(), HasSubstr("k_vc 4 N m/rad"));
  EXPECT_EQ(touch_with_readings().heading(), "Arm touch with its readings");
}

TEST(ExperimentArm, MovesAsTheBuiltInOneIfItsJointsDo) {
  const ArmDescription touch = shipped("touch.urdf");
  EXPECT_TRUE(moves_as_built_in(touch)) << "heavier, but of the same lengths";
  for (const char* other : {"omega.urdf", "inverse3.urdf", "planar2.urdf", "paddle.urdf"}) {
    EXPECT_FALSE(moves_as_built_in(shipped(other))) << other;
  }
  ArmDescription named = touch, longer = touch, turned = touch;
  named.joints[1].name = "hip";
  longer.tip.translation().x() += 1e-3;
  turned.joints[0].axis = Vec3::UnitX();
  for (const ArmDescription& arm : {named, longer, turned}) EXPECT_FALSE(moves_as_built_in(arm));
}

TEST(WhyNot, NamesTheExperimentAndTheReason) {
  const ExperimentArm touch = touch_with_readings();
  EXPECT_EQ(why_not(experiment("coordination"), touch), "");
  EXPECT_THAT(why_not(experiment("robust"), touch),
              HasSubstr("robust: accepts no other arm or settings, because it has arms of its own: "
                        "an ideal arm and a Touch"));
  EXPECT_THAT(why_not(experiment("zwidth"), touch), HasSubstr("zwidth: takes no readings"));
  ExperimentArm exact = touch;
  exact.readings = false;
  EXPECT_EQ(why_not(experiment("zwidth"), exact), "");
  const ExperimentArm planar{shipped("planar2.urdf"), {}, "planar2"};
  EXPECT_THAT(why_not(experiment("passivity"), planar),
              HasSubstr("needs an arm of 3 joints; planar2 has 2"));
  const ExperimentArm omega{shipped("omega.urdf"), {}, "omega"};
  EXPECT_THAT(why_not(experiment("coordination"), omega), HasSubstr("omega differs"));
  EXPECT_EQ(why_not(experiment("passivity"), omega), "");
  for (const Experiment& e : experiments()) EXPECT_EQ(why_not(e, built_in_arm()), "") << e.name;
}

TEST(WhyNot, LeavesNoExperimentWithoutAWordOnItsOwnArms) {
  for (const Experiment& e : experiments()) {
    EXPECT_EQ(e.takes == Experiment::Takes::none, *e.own_arms != '\0') << e.name;
  }
}

TEST(AnExperimentOnAnotherArm, TapsWithItsGainsAndItsReadingsUnlessTheseAreVaried) {
  const ExperimentArm touch = touch_with_readings();
  const Parameters own = TapBench(touch, {}, 600, 300, 1).parameters();
  EXPECT_EQ(own.k_vc, 4);
  EXPECT_EQ(own.encoder_step, 4.19e-4);
  EXPECT_EQ(own.device_delay, 1);
  EXPECT_EQ(own.delay, 1);
  const TapSetting varied{.encoder_step = 1e-4, .delay = 3, .knows_delay = false};
  const Parameters chosen = TapBench(touch, varied, 600, 300, 1).parameters();
  EXPECT_EQ(chosen.encoder_step, 1e-4);
  EXPECT_EQ(chosen.device_delay, 3);
  EXPECT_EQ(chosen.delay, 0);
}

// A tap comes to rest on an arm with more damping where it does not on the built-in arm.
TEST(AnExperimentOnAnotherArm, ComesToRestThroughALinkAsItsDampingSays) {
  constexpr int kDelay = 10;
  constexpr double kGrip[] = {300};
  const test::TempDir temp;
  TrialRunner::Options options;
  options.dir = temp / ".";
  options.arm = built_in_arm();
  for (Joint& joint : options.arm->description.joints) joint.damping = 0.15;
  TrialRunner lab("walls", options);
  const auto rests = [](const Touch& touch, bool) {
    return touch.energy <= 5e-3 && touch.moving <= 5e-3;
  };
  const TapSetting late{.kind = CouplingKind::standard, .link = kDelay, .hold = 6};
  const double found = stiffest_walls(lab, std::array{late}, {kGrip, rests}).front();
  EXPECT_GT(found, kSoftest);
  EXPECT_GT(LinkTheory(lab.arm(), kGrip[0]).standard(kDelay), kSoftest);
  EXPECT_EQ(LinkTheory(built_in_arm(), kGrip[0]).standard(kDelay), kSoftest);
}

// Stopped at once, an experiment has said with what its first trials would be run.
TEST(AnExperimentOnAnotherArm, RunsItsTrialsOnThatArmWithItsReadings) {
  static const std::atomic<bool> kStopped{true};
  const test::TempDir temp;
  TrialRunner::Options options;
  options.dir = temp / ".";
  options.stop = &kStopped;
  options.arm = built_in_arm();
  options.arm->name = options.arm->description.name = "mine";
  options.arm->settings.encoder_step = 1.5e-6;
  for (const Experiment& e : experiments()) {
    if (e.takes == Experiment::Takes::none) continue;
    TrialRunner lab(e.name, options);
    EXPECT_THROW(e.run(lab), Cancelled) << e.name;
    EXPECT_THAT(lab.conditions().text(), HasSubstr("arm mine of 3 joints")) << e.name;
    if (*e.own_readings != '\0') continue;
    EXPECT_THAT(lab.conditions().text(), HasSubstr("1.5e-06 rad per encoder step")) << e.name;
  }
}

// By (1) the standard coupling's error is the contact's torque over k_vc.
TEST(AnExperimentOnAnotherArm, MeasuresWithItsGainsAndSaysOnWhichArm) {
  const test::TempDir temp;
  const Outcome outcome = on_arm("coordination", touch_with_readings(), temp / ".");
  const FigurePanel& scatter = outcome.figure.panels.at(8);
  ASSERT_THAT(scatter.title, HasSubstr("error against contact torque"));
  const FigurePoint& end = scatter.series.at(1).points.at(1);
  EXPECT_NEAR(end.y / end.x, 1e3 / 4, 0.02 * 1e3 / 4);
  EXPECT_THAT(outcome.figure.title, HasSubstr(", on touch with its readings"));
  EXPECT_THAT(outcome.figure.caption, HasSubstr("gains coupling.k_vc 4 N m/rad"));
  EXPECT_THAT(outcome.figure.caption, HasSubstr("arm touch of 3 joints"));
  EXPECT_THAT(outcome.figure.caption, HasSubstr("0.000419 rad per encoder step; 1 ms of"));
  for (const Check& c : outcome.checks) {
    if (c.what.find("diverged") != std::string::npos) {
      EXPECT_TRUE(c.unjudged.empty()) << "a trial that diverged is a failure on any arm";
    } else {
      EXPECT_THAT(c.unjudged, HasSubstr("Promised only for the built-in arm: at ")) << c.what;
    }
  }
  const auto verdict = nlohmann::json::parse(std::ifstream(temp / "coordination.json"));
  EXPECT_EQ(verdict.at("arm"), "touch with its readings");
  write_report(temp / ".");
  std::stringstream page;
  page << std::ifstream(temp / "report.html").rdbuf();
  EXPECT_THAT(page.str(),
              HasSubstr("Without a verdict, because no bound is promised for the arm: 1."));
  EXPECT_THAT(page.str(), testing::Not(HasSubstr("experiments passed")));
}

TEST(AnExperimentOnAnotherArm, DoesNotPassForLackOfWhatItMissed) {
  const test::TempDir temp;
  const Outcome outcome = on_arm("inertia", touch_with_readings(), temp / ".");
  EXPECT_TRUE(outcome.passed()) << "nothing is promised";
  // Friction of 0.26 N at the tip is not scaled by eta.
  EXPECT_GT(outcome.checks.front().value, outcome.checks.front().bound);
  EXPECT_THAT(outcome.checks.front().unjudged, HasSubstr("does not keep this bound"));
}

double hardest(const fs::path& file) {
  const Session s = read_session(file);
  double most = 0;
  for (std::size_t k = 0; k < s.size(); ++k) {
    most = std::max(most, vector_at(s, k, Column::motor_torque).cwiseAbs().maxCoeff());
  }
  return most;
}

TEST(AnExperimentOnAnotherArm, KeepsToItsMotors) {
  const test::TempDir temp;
  ExperimentArm weak = built_in_arm();
  weak.name = "weak";
  for (Joint& joint : weak.description.joints) joint.effort = 0.05;
  on_arm("switching", weak, temp / "weak");
  on_arm("switching", built_in_arm(), temp / "strong");
  EXPECT_DOUBLE_EQ(hardest(temp / "weak/switching/switching.h5"), 0.05);
  EXPECT_GT(hardest(temp / "strong/switching/switching.h5"), 0.05);
}

// (b_d + b_v + k_vc T/2 + b_h r^2) over (T/2 + b_v/k_vc), r the lever of the tip.
TEST(AnExperimentOnAnotherArm, FindsWallsThatFollowItsDamping) {
  const test::TempDir temp;
  TrialRunner::Options options;
  options.dir = temp / ".";
  options.arm = built_in_arm();
  for (Joint& joint : options.arm->description.joints) joint.damping = 0.036;
  TrialRunner lab("walls", options);
  const TipAlong tip = tip_at_table(lab.arm());
  const double b = (0.036 + 0.012 + 10 * 0.001 / 2) / tip.lever2 + TapBench::kGripDamping;
  const double theory = b / (0.001 / 2 + 0.012 / 10);
  EXPECT_NEAR(LinkTheory(lab.arm(), 300).proposed(0), theory, 1e-6 * theory);
  const TapSetting paper{.kind = CouplingKind::proposed};
  const double found = stiffest_walls(lab, std::array{paper}).front();
  EXPECT_GT(found, 0.5 * theory);
  EXPECT_LT(found, 1.5 * theory);
}

TEST(AnExperimentOnAnotherArm, EndsWithAReasonWhereItsHandIsOutOfReach) {
  const test::TempDir temp;
  ExperimentArm shorter = built_in_arm();
  shorter.name = "short";
  shorter.description.tip.translation() *= 0.2;
  try {
    on_arm("passivity", shorter, temp / ".");
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), HasSubstr("passivity: "));
    EXPECT_THAT(e.what(), HasSubstr("reach"));
  }
}

}  // namespace
}  // namespace limpid
