// The shipped story: its rows agree with its sentences.
#include <gtest/gtest.h>

#include "app/base/folders.h"
#include "app/story/run_story.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

constexpr std::size_t kFirst = 0, kTwin = 1;
constexpr double kPassive = 1e-6;  // bound of the round-off [J]

class TheFirstStory : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    story_ = new Story(read_story(default_story()));
    run_ = new StoryRun(run_story(*story_, false, [](double) {}));
  }
  static void TearDownTestSuite() {
    delete run_;
    delete story_;
  }
  // Numbers of the step whose sentence has these words.
  static std::array<StepNumbers, 2> step(const std::string& words) {
    const auto all = measure(story_->steps, run_->session);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (story_->steps[i].caption.find(words) != std::string::npos)
        return {all[i].at(0), all[i].at(1)};
    }
    ADD_FAILURE() << "no step says: " << words;
    return {};
  }

  static inline const Story* story_;
  static inline const StoryRun* run_;
};

TEST_F(TheFirstStory, IsToldToItsEndWithinAMinute) {
  EXPECT_FALSE(run_->end.diverged);
  EXPECT_LT(story_->seconds(), 60);
  EXPECT_EQ(run_->session.size(), story_->plan.rows);
  EXPECT_EQ(run_->session.lane(kTwinLane).size(), story_->plan.rows);
}

TEST_F(TheFirstStory, ShowsDeviceAndProxyDriftApartUnderTheStandardCouplingAlone) {
  const auto [standard, predictive] = step("drift apart");
  EXPECT_GT(standard.largest_error, 0.02);
  EXPECT_GT(standard.largest_error, 10 * predictive.largest_error);
  // Nothing else limits the runs: the drift is the coupling's, contact torque over k_vc.
  EXPECT_NEAR(standard.largest_error, standard.largest_contact / Parameters{}.k_vc,
              0.01 * standard.largest_error);
}

TEST_F(TheFirstStory, ShowsTorqueInProportionToEta) {
  const auto [one, small] = step("0.3 of the torque");
  EXPECT_GT(one.rms_human, 0.02);
  EXPECT_NEAR(small.rms_human / one.rms_human, 0.3, 0.02);
}

TEST_F(TheFirstStory, ShowsAProxyDraggedIntoTheTableByLimitedMotors) {
  const auto [proposed, predictive] = step("harder than the motors");
  EXPECT_GT(proposed.largest_contact, 10 * predictive.largest_contact);
  EXPECT_GT(proposed.energy_given, 0.1);
  EXPECT_LT(predictive.energy_given, kPassive);
}

TEST_F(TheFirstStory, ShowsEnergyThatClimbsInAStiffGripAndThePredictiveLawThatKeepsItDown) {
  const auto [proposed, predictive] = step("energy rises");
  EXPECT_GT(proposed.energy_given, 1);
  EXPECT_LT(predictive.energy_given, kPassive);
  const auto [now, all_the_while] = step("stays passive");
  EXPECT_LT(now.energy_given, kPassive);
  EXPECT_LT(all_the_while.energy_given, kPassive);
}

TEST_F(TheFirstStory, EndsAtRest) {
  for (const std::size_t i : {kMainLane, kTwinLane}) {
    const Session& run = run_->session.lane(i);
    for (const double v : run.at(run.size() - 1, Column::device_velocity)) {
      EXPECT_LT(std::abs(v), 1e-3);
    }
  }
}

TEST_F(TheFirstStory, IsTheSameEachTimeToTheLastBit) {
  const StoryRun again = run_story(*story_, false, [](double) {});
  const Session& session = run_->session;
  EXPECT_EQ(test::first_difference(test::rows_of(session), test::rows_of(again.session)), -1);
  EXPECT_EQ(test::first_difference(test::rows_of(session.lane(kTwinLane)),
                                   test::rows_of(again.session.lane(kTwinLane))),
            -1);
}

}  // namespace
}  // namespace limpid
