// Scripts with all that one may say, the limits of what is allowed, and what becomes of a run.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "app/story/run_story.h"
#include "app/story/story.h"
#include "devices/files/text_file.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using Changes = std::vector<std::pair<std::uint64_t, std::string>>;

Changes changes_of(const std::vector<SettingChange>& all) {
  Changes rows;
  for (const SettingChange& change : all) rows.emplace_back(change.row, change.setting);
  return rows;
}

const std::string kThreeSteps = R"(title = "Three couplings"
seconds = 6
[[step]]
time = 0
caption = "One."
set = ["coupling.eta = 0.8", "loop.tick = 0.002"]
first = ["coupling.kind = standard"]
twin = ["coupling.kind = predictive"]
lane3 = ["coupling.kind = proposed"]
hand = [[0.5, 0.19, 0.01, 0]]
camera = "top"
[[step]]
time = 2
caption = "Two."
mark = "pressed"
names = ["left", "middle", "right"]
beside = false
anew = true
lane3 = ["coupling.eta = 0.5"]
camera = { view = "side", target = [0.17, 0, -0.02], size = 0.15 }
[[step]]
time = 4
caption = "Three."
first = ["coupling.eta = 0.4"]
hand = "mine.csv"
)";

class WholeScripts : public testing::Test {
 protected:
  WholeScripts() {
    std::ofstream(dir_ / "mine.csv") << "time_s,x_m,y_m,z_m\n0,0.19,0.01,0\n1,0.19,0,0.01\n"
                                        "5,0.19,0.02,0\n";
  }
  Story parse(const std::string& text) const { return parse_story(text, "s.toml", dir_ / "."); }
  // The script with a piece of it replaced.
  std::string changed(const std::string& piece, const std::string& other) const {
    std::string text = kThreeSteps;
    const auto at = text.find(piece);
    EXPECT_NE(at, std::string::npos) << piece;
    return text.replace(at, piece.size(), other);
  }
  void refuses(const std::string& piece, const std::string& other, const std::string& why) const {
    try {
      parse(changed(piece, other));
      FAIL() << "taken: " << other;
    } catch (const FileError& error) {
      EXPECT_THAT(error.what(), HasSubstr(why));
      EXPECT_THAT(error.what(), HasSubstr("s.toml:"));
    }
  }
  const test::TempDir dir_;
};

TEST_F(WholeScripts, HaveThreeRunsWithTheirSettings) {
  const Story story = parse(kThreeSteps);
  EXPECT_EQ(story.title, "Three couplings");
  EXPECT_EQ(story.seconds(), 6);
  const RunPlan& plan = story.plan;
  EXPECT_EQ(plan.rows, 3000u) << "in the tick that it sets";
  ASSERT_EQ(plan.beside.size(), 2u);
  EXPECT_EQ(plan.parameters.kind, CouplingKind::standard);
  EXPECT_EQ(plan.beside[0].parameters.kind, CouplingKind::predictive);
  EXPECT_EQ(plan.beside[1].parameters.kind, CouplingKind::proposed);
  for (const Parameters& p :
       {plan.parameters, plan.beside[0].parameters, plan.beside[1].parameters}) {
    EXPECT_EQ(p.eta, 0.8);
    EXPECT_EQ(p.tick, 0.002);
  }
  EXPECT_EQ(changes_of(plan.changes), (Changes{{2000, "coupling.eta = 0.4"}}));
  EXPECT_TRUE(plan.beside[0].changes.empty());
  EXPECT_EQ(changes_of(plan.beside[1].changes), (Changes{{1000, "coupling.eta = 0.5"}}));
}

TEST_F(WholeScripts, SayWhatEachStepShows) {
  const Story story = parse(kThreeSteps);
  ASSERT_EQ(story.steps.size(), 3u);
  const StoryStep &one = story.steps[0], &two = story.steps[1], &three = story.steps[2];
  EXPECT_EQ(one.begins, 0);
  EXPECT_EQ(one.ends, 2);
  EXPECT_EQ(two.begins, 2);
  EXPECT_EQ(two.ends, 4);
  EXPECT_EQ(three.begins, 4);
  EXPECT_EQ(three.ends, 6);
  EXPECT_EQ(one.caption, "One.");
  EXPECT_EQ(three.caption, "Three.");
  EXPECT_EQ(one.mark, "");
  EXPECT_EQ(two.mark, "pressed");
  EXPECT_THAT(one.names, ElementsAre("standard", "predictive", "proposed"));
  EXPECT_THAT(two.names, ElementsAre("left", "middle", "right"));
  EXPECT_TRUE(one.beside && three.beside && two.anew);
  EXPECT_FALSE(two.beside || one.anew || three.anew);
  ASSERT_TRUE(one.camera && two.camera);
  EXPECT_FALSE(three.camera);
  EXPECT_EQ(one.camera->view, Camera::View::top);
  EXPECT_FALSE(one.camera->of);
  EXPECT_EQ(two.camera->view, Camera::View::side);
  EXPECT_NEAR((two.camera->of->min() - Vec3(0.095, -0.075, -0.095)).norm(), 0, 1e-12);
  EXPECT_NEAR((two.camera->of->max() - Vec3(0.245, 0.075, 0.055)).norm(), 0, 1e-12);
  EXPECT_EQ(camera_in(story.steps, one).view, Camera::View::top);
  EXPECT_EQ(camera_in(story.steps, three).view, Camera::View::side) << "as in the step before";
  std::vector<StoryStep> bare = story.steps;
  bare[0].camera.reset();
  EXPECT_EQ(camera_in(bare, bare[0]).view, Camera::View::iso);
  EXPECT_FALSE(camera_in(bare, bare[0]).of) << "not yet";
  EXPECT_EQ(&step_at(story.steps, -1), &one);
  EXPECT_EQ(&step_at(story.steps, 3.999), &two);
  EXPECT_EQ(&step_at(story.steps, 4), &three);
  for (const auto& [view, word] : {std::pair(Camera::View::front, "front"),
                                   {Camera::View::top, "top"},
                                   {Camera::View::side, "side"},
                                   {Camera::View::iso, "iso"}}) {
    EXPECT_STREQ(view_word(view), word);
  }
}

TEST_F(WholeScripts, LeadTheHandThroughPointsAndFiles) {
  const HandPath hand = parse(kThreeSteps).plan.hand;
  const Vec3 left(0.19, 0.01, 0), right(0.19, 0, 0.01);
  for (const double t : {0.0, 0.2, 0.5, 2.0, 3.9, 4.0}) {
    EXPECT_NEAR((hand.at(t) - left).norm(), 0, 1e-12) << t << ": it waits there";
  }
  EXPECT_NEAR((hand.at(5) - right).norm(), 0, 1e-12);
  EXPECT_NEAR((hand.at(6) - right).norm(), 0, 1e-12) << "what is behind the end does not count";
  EXPECT_EQ(hand.time.back(), 5);
}

TEST_F(WholeScripts, RefuseWhatIsTooLongOrTooShort) {
  const auto words = [](std::size_t letters) {
    std::string text;
    for (std::size_t i = 0; i < letters; ++i) text += "\u03b7";  // two bytes
    return fmt::format("\"{}\"", text);
  };
  EXPECT_NO_THROW(parse(changed("\"One.\"", words(140))));
  refuses("\"One.\"", words(141), "caption");
  refuses("\"pressed\"", words(141), "at most 140 letters");
  refuses("\"Three couplings\"", words(141), "title");
  refuses("time = 4", "time = 5.95", "at least 0.1 s before the next event, which is at 6 s");
  EXPECT_NO_THROW(parse(changed("time = 4", "time = 5.8")));
  refuses("seconds = 6", "seconds = 3601", "seconds");
  refuses("seconds = 6", "seconds = 0", "seconds");
  refuses("time = 2\n", "time = -1\n", "time");
}

TEST_F(WholeScripts, RefuseSettingsThatAreNoneOrComeTooLate) {
  refuses("lane3 = [\"coupling.kind = proposed\"]\n", "", "starts the third run");
  refuses("set = [\"coupling.eta = 0.8\", \"loop.tick = 0.002\"]", "set = \"coupling.eta = 0.8\"",
          "a list of settings");
  refuses("set = [\"coupling.eta = 0.8\", \"loop.tick = 0.002\"]", "set = [1]",
          "a list of settings");
  std::string early = changed("time = 2\n", "time = 0.7\n");
  early.replace(early.find("lane3 = [\"coupling.eta = 0.5\"]"), 30,
                "set = [\"loop.tick = 0.001\"]");
  EXPECT_THROW(parse(early), FileError) << "soon is too late as well";
  refuses("\"left\", \"middle\", \"right\"", "\"left\", \"right\"", "3 names, one for each run");
  refuses("\"left\", \"middle\", \"right\"", "\"left\"", "a word for each run");
  refuses("\"left\", \"middle\", \"right\"", "\"left\", 2, \"right\"", "a word for each run");
}

TEST_F(WholeScripts, RefuseCamerasAndHandsThatAreNone) {
  refuses("camera = \"top\"", "camera = 1", "a view, or {");
  refuses("size = 0.15", "size = 0.001", "size");
  refuses("size = 0.15", "size = 11", "size");
  refuses("target = [0.17, 0, -0.02]", "target = [0.17, 0, -11]", "target");
  refuses("size = 0.15", "size = 0.15, zoom = 2", "zoom");
  refuses("view = \"side\"", "view = \"left\"", "front, top, side, iso");
  refuses("[[0.5, 0.19, 0.01, 0]]", "[]", "a file, or points");
  refuses("[[0.5, 0.19, 0.01, 0]]", "1", "a file, or points");
  refuses("[[0.5, 0.19, 0.01, 0]]", "[[0.5, 0.19, 0.01, 11]]", "points from -10 to 10 m");
  refuses("[[0.5, 0.19, 0.01, 0]]", "[[-0.5, 0.19, 0.01, 0]]", "times from 0 to 3600 s");
  refuses("[[0.5, 0.19, 0.01, 0]]", "[[0.5, 0.19, 0.01, \"0\"]]", "a file, or points");
  refuses("hand = [[0.5, 0.19, 0.01, 0]]\n", "", "hand: missing");
  refuses("[[0.5, 0.19, 0.01, 0]]", "[[0.5, 0.19, 0.01, 0], [0.51, 0.19, -0.03, 0]]",
          "is 0.040 m from the point 0.010 s before; allowed: up to 3 m/s");
  EXPECT_NO_THROW(
      parse(changed("[[0.5, 0.19, 0.01, 0]]", "[[0.5, 0.19, 0.01, 0], [0.51, 0.19, -0.018, 0]]")));
}

// Norms over all joints, each of its own step and run.
TEST(NumbersOfAStory, AreNormsOverJointsAndRows) {
  Session session;
  session.info.tick = 0.001;
  const auto stride = static_cast<std::size_t>(session.layout.stride());
  session.rows.assign(3000 * stride, 0.0);
  const auto at = [&](std::size_t k, Column column) {
    return session.layout.in(std::span(session.rows).subspan(k * stride, stride), column);
  };
  for (std::size_t k = 0; k < 3000; ++k) {
    at(k, Column::hand_torque)[0] = k < 1000 ? 3 : 1;
    at(k, Column::hand_torque)[1] = k < 1000 ? 4 : 1;
    at(k, Column::energy_total)[0] = k < 1000 ? -1e-3 * static_cast<double>(k) : 7;
  }
  at(500, Column::device_position)[0] = 0.5;
  at(500, Column::proxy_position)[0] = 0.2;
  at(500, Column::proxy_position)[2] = -0.4;
  at(600, Column::contact_torque)[0] = -2;
  at(600, Column::contact_torque)[1] = 1;
  at(600, Column::contact_torque)[2] = 2;
  session.beside = {Session(session)};
  session.beside[0].layout.in(std::span(session.beside[0].rows).subspan(1500 * stride, stride),
                              Column::contact_torque)[0] = 9;
  const auto step = [](double begins, double ends) {
    StoryStep made;
    made.begins = begins;
    made.ends = ends;
    return made;
  };
  const auto all = measure({step(0, 1), step(1, 2), step(2, 10), step(3, 11)}, session);
  ASSERT_EQ(all.size(), 3u) << "the last one was never told";
  ASSERT_EQ(all[0].size(), 2u);
  EXPECT_NEAR(all[0][0].largest_error, 0.5, 1e-12) << "of 0.3 and 0.4";
  EXPECT_NEAR(all[0][0].largest_contact, 3, 1e-12);
  EXPECT_NEAR(all[0][0].rms_human, 5, 1e-12);
  EXPECT_NEAR(all[0][0].energy_given, 0, 1e-12) << "it fell";
  EXPECT_NEAR(all[1][0].largest_error, 0, 1e-12);
  EXPECT_NEAR(all[1][0].largest_contact, 0, 1e-12);
  EXPECT_NEAR(all[1][1].largest_contact, 9, 1e-12) << "of the other run";
  EXPECT_NEAR(all[1][0].rms_human, std::sqrt(2), 1e-12);
  EXPECT_NEAR(all[2][0].rms_human, std::sqrt(2), 1e-12) << "as far as it was told";
}

TEST_F(WholeScripts, AreRunWithAllOfTheirRunsAndChanges) {
  const std::string text =
      "title = \"Short\"\nseconds = 0.4\n[[step]]\ntime = 0\ncaption = \"One.\"\n"
      "first = [\"coupling.kind = standard\"]\nhand = [[0, 0.19, 0, 0]]\n"
      "[[step]]\ntime = 0.2\ncaption = \"Two.\"\ntwin = [\"coupling.eta = 0.5\"]\n";
  const Story story = parse(text);
  std::vector<double> times;
  const StoryRun run =
      run_story(story, std::atomic<bool>{false}, [&](double t) { times.push_back(t); });
  EXPECT_FALSE(run.end.diverged);
  ASSERT_EQ(run.session.lanes(), 2u);
  ASSERT_EQ(run.session.size(), 400u);
  ASSERT_EQ(run.session.lane(1).size(), 400u);
  EXPECT_TRUE(run.session.changes.empty());
  EXPECT_EQ(changes_of(run.session.lane(1).changes), (Changes{{200, "coupling.eta = 0.5"}}));
  for (const std::size_t lane : {0u, 1u}) {
    const Session& one = run.session.lane(lane);
    for (const std::size_t k : {0u, 1u, 199u, 200u, 399u}) {
      EXPECT_NEAR(one.at(k, Column::time)[0], 1e-3 * static_cast<double>(k), 1e-12);
      EXPECT_EQ(one.at(k, Column::kind)[0],
                static_cast<double>(lane == 0 ? CouplingKind::standard : Parameters{}.kind));
      EXPECT_EQ(one.at(k, Column::eta)[0], lane == 1 && k >= 200 ? 0.5 : Parameters{}.eta) << k;
    }
  }
  ASSERT_FALSE(times.empty());
  EXPECT_TRUE(std::ranges::is_sorted(times));
  EXPECT_NEAR(times.back(), 0.4, 1e-9);
  const StoryRun none = run_story(story, std::atomic<bool>{true}, [](double) {});
  EXPECT_LT(none.session.size(), 400u) << "stopped";
}

}  // namespace
}  // namespace limpid
