// Scripts as people write them, right and wrong, and the plans made of them.
#include "app/story/story.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/run/fitted_gains.h"
#include "app/story/run_story.h"
#include "devices/files/text_file.h"

namespace limpid {
namespace {

using testing::HasSubstr;

const std::string kTop = "title = \"Two steps\"\nseconds = 5\n";
const std::string kFirst =
    "[[step]]\n"
    "time = 0\n"
    "caption = \"One.\"\n"
    "first = [\"coupling.kind = standard\"]\n"
    "hand = [[0, 0.19, 0, 0], [1, 0.19, 0.02, 0]]\n";
const std::string kSecond =
    "[[step]]\n"
    "time = 2.5\n"
    "caption = \"Two.\"\n"
    "set = [\"hand.stiffness = 700\"]\n"
    "twin = [\"coupling.eta = 0.4\"]\n"
    "hand = [[1, 0.19, 0, -0.01]]\n";
const std::string kWhole = kTop + kFirst + kSecond;

Story parse(const std::string& text) { return parse_story(text, "s.toml", "/nowhere"); }

// kWhole with a piece of it replaced.
std::string with(const std::string& piece, const std::string& other) {
  std::string text = kWhole;
  const auto at = text.find(piece);
  EXPECT_NE(at, std::string::npos) << piece;
  return text.replace(at, piece.size(), other);
}

void expect_refused(const std::string& text, const std::string& why) {
  try {
    parse(text);
    FAIL() << "taken: " << text;
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr(why));
  }
}

std::vector<std::pair<std::uint64_t, std::string>> listed(const std::vector<SettingChange>& all) {
  std::vector<std::pair<std::uint64_t, std::string>> rows;
  for (const SettingChange& change : all) rows.emplace_back(change.row, change.setting);
  return rows;
}

TEST(StoryScripts, BecomeAPlanWithTheSettingsOfEachRunAtTheRowOfTheirStep) {
  const Story story = parse(kWhole);
  const RunPlan& plan = story.plan;
  EXPECT_EQ(plan.rows, 5000u);
  EXPECT_EQ(plan.parameters.kind, CouplingKind::standard);
  ASSERT_EQ(plan.lanes(), 2u);
  EXPECT_EQ(plan.beside[0].parameters.kind, Parameters{}.kind);
  using Rows = std::vector<std::pair<std::uint64_t, std::string>>;
  EXPECT_EQ(listed(plan.changes), (Rows{{2500, "hand.stiffness = 700.0"}}));
  EXPECT_EQ(listed(plan.beside[0].changes),
            (Rows{{2500, "coupling.eta = 0.4"}, {2500, "hand.stiffness = 700.0"}}));
}

TEST(StoryScripts, CountRowsInTheTickThatTheySet) {
  const Story story = parse(with("first = [", "set = [\"loop.tick = 0.002\"]\nfirst = ["));
  EXPECT_EQ(story.plan.rows, 2500u);
  EXPECT_EQ(story.plan.changes.at(0).row, 1250u);
}

TEST(StoryScripts, LeaveTheHandWhereItIsUntilTheNextStepBegins) {
  const HandPath hand = parse(kWhole).plan.hand;
  const Vec3 left(0.19, 0.02, 0);
  for (const double t : {1.0, 1.7, 2.5}) EXPECT_LT((hand.at(t) - left).norm(), 1e-12) << t;
  EXPECT_LT((hand.at(3.5) - Vec3(0.19, 0, -0.01)).norm(), 1e-12);
  EXPECT_LT((hand.at(5) - Vec3(0.19, 0, -0.01)).norm(), 1e-12);
}

TEST(StoryScripts, CallTheRunsByWhatTheyDifferInUnlessNamesAreGiven) {
  EXPECT_EQ(parse(kWhole).steps[0].names[0], "standard");
  const Story named =
      parse(with("caption = \"Two.\"", "caption = \"Two.\"\nnames = [\"a\", \"b\"]"));
  EXPECT_EQ(named.steps[1].names[1], "b");
}

TEST(StoryScripts, KnowTheStepOfEveryMoment) {
  const Story story = parse(kWhole);
  EXPECT_EQ(step_at(story.steps, 0).caption, "One.");
  EXPECT_EQ(step_at(story.steps, 2.499).caption, "One.");
  EXPECT_EQ(step_at(story.steps, 2.5).caption, "Two.");
  EXPECT_EQ(step_at(story.steps, 100).caption, "Two.");
}

TEST(StoryScripts, RefuseKeysAndWordsThatDoNotExistAndSayWhere) {
  expect_refused(with("caption = \"Two.\"", "captoin = \"Two.\""), "s.toml:10: step.captoin");
  expect_refused(with("title", "titel"), "s.toml:1: titel: no such key");
  expect_refused("scene = \"nope.toml\"\n" + kWhole, "s.toml:1: scene: ");
  expect_refused("device = \"nope.urdf\"\n" + kWhole,
                 "a file in the folder of the script, or one of ");
  expect_refused(with("hand = [[1, 0.19, 0, -0.01]]", "hand = \"nope.csv\""), "step.hand: ");
  expect_refused(with("kind = standard", "kind = magic"), "standard, proposed, predictive");
  expect_refused(with("coupling.eta", "coupling.etta"), "s.toml:12: step.twin: coupling.etta");
  expect_refused(with("coupling.eta = 0.4", "coupling.eta = -1"), "coupling.eta: -1");
  expect_refused(with("caption = \"One.\"", "caption = \"One.\"\ncamera = \"back\""),
                 "front, top, side, iso");
  expect_refused(with("caption = \"One.\"", "caption = \"One.\"\ncamera = { view = \"side\" }"),
                 "target: missing");
  expect_refused(with("caption = \"One.\"", "caption = 1"), "text in quotes");
  expect_refused(with("caption = \"One.\"", "caption = \"One.\"\nanew = 1"), "true, false");
  expect_refused(kTop, "step: missing");
}

TEST(StoryScripts, RefuseTimesThatAreNotInOrder) {
  expect_refused(with("time = 0", "time = 1"), "step.time: 1 is not allowed; allowed: 0");
  expect_refused(with("time = 2.5", "time = 0"), "s.toml:4: step.time");
  expect_refused(with("seconds = 5", "seconds = 2"), "s.toml:9: step.time");
  expect_refused(with("[1, 0.19, 0.02, 0]", "[2.5, 0.19, 0.02, 0]"), "before the step ends");
  expect_refused(with("[1, 0.19, 0.02, 0]", "[0, 0.19, 0.02, 0]"), "times that increase");
}

TEST(StoryScripts, RefuseAHandThatTheArmCannotFollow) {
  expect_refused(with("[1, 0.19, 0.02, 0]", "[1, 0.9, 0, 0]"), "out of reach");
  expect_refused(with("[1, 0.19, 0.02, 0]", "[0.01, 0.19, 0.08, 0]"), "up to 3 m/s");
  expect_refused(with("[1, 0.19, 0.02, 0]", "[1, 0.19, 0.02]"), "[seconds after");
  expect_refused(with("[[0, 0.19, 0, 0], [1, 0.19, 0.02, 0]]", "\"nothing.csv\""), "nothing.csv");
}

TEST(StoryScripts, RefuseSettingsThatCannotHoldForOneRunOrFromThere) {
  expect_refused(with("twin = [\"coupling.eta = 0.4\"]", "twin = [\"hand.stiffness = 9\"]"),
                 "write this setting under set");
  expect_refused(with("set = [\"hand.stiffness = 700\"]", "set = [\"loop.tick = 0.002\"]"),
                 "only in the first step");
  for (const char* spaced : {"  loop.tick = 0.002", "\\tloop.tick=0.002"}) {
    expect_refused(with("set = [\"hand.stiffness = 700\"]", fmt::format("set = [\"{}\"]", spaced)),
                   "only in the first step");
  }
}

TEST(StoryScripts, FitGainsToTheirArm) {
  const Story story = parse("device = \"omega.urdf\"\n" + kWhole);
  const Parameters fit = fitted(story.plan.arm);
  EXPECT_NE(fit.k_vc, Parameters{}.k_vc);
  EXPECT_EQ(story.plan.parameters.k_vc, fit.k_vc);
  EXPECT_EQ(story.plan.beside[0].parameters.b_v, fit.b_v);
  EXPECT_EQ(parse(kWhole).plan.parameters.k_vc, Parameters{}.k_vc);
}

// The error is 0.3 rad amid the first step and 0.4 rad in the second one's first row. E_c climbs
// from -2 J by 1 J, and falls.
TEST(StoryNumbers, AreOfOneStepEach) {
  Story story = parse(kWhole);
  Session session;
  session.info.tick = 0.001;
  session.rows.assign(5000 * static_cast<std::size_t>(session.layout.stride()), 0.0);
  const auto put = [&](std::size_t k, Column column, double value) {
    const auto stride = static_cast<std::size_t>(session.layout.stride());
    session.layout.in(std::span(session.rows).subspan(k * stride, stride), column)[0] = value;
  };
  for (std::size_t k = 0; k < 5000; ++k) {
    put(k, Column::device_position, k == 1200 ? 0.3 : k < 2500 ? 0 : k == 2500 ? 0.4 : 0.1);
    put(k, Column::hand_torque, k < 2500 ? 0 : k % 2 == 0 ? 3 : -4);
    put(k, Column::energy_total, k < 2500 ? 0 : k == 3000 ? -1 : -2);
  }
  session.beside = {Session(session)};
  const auto all = measure(story.steps, session);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_DOUBLE_EQ(all[0][0].largest_error, 0.3);
  EXPECT_DOUBLE_EQ(all[1][1].largest_error, 0.4);
  EXPECT_DOUBLE_EQ(all[0][0].rms_human, 0);
  EXPECT_NEAR(all[1][0].rms_human, std::sqrt(12.5), 1e-12);
  EXPECT_DOUBLE_EQ(all[0][0].energy_given, 0);
  EXPECT_DOUBLE_EQ(all[1][0].energy_given, 1);
}

}  // namespace
}  // namespace limpid
