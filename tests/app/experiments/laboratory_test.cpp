#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <map>

#include "app/experiments/passivity.h"
#include "app/experiments/signals.h"
#include "app/run/varied_hand.h"
#include "tests/support/rows.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using testing::ElementsAre;

namespace fs = std::filesystem;

// Numbers that a trial decides; durations of ticks are the machine's.
std::vector<double> physics(const Session& session) {
  std::vector<double> values;
  for (std::size_t k = 0; k < session.size(); ++k) {
    const auto row = session.row(k);
    values.insert(values.end(), row.begin(),
                  row.begin() + session.layout.offset(Column::wake_latency));
  }
  return values;
}

class Laboratories : public testing::Test {
 protected:
  void SetUp() override { options_.dir = temp_ / "."; }

  static Trial trial(const std::string& name, double eta) {
    Parameters p;
    p.eta = eta;
    Trial t{name, plan_of(built_in_arm().description, "table", "touch", p)};
    t.plan.rows = 300;
    return t;
  }
  static std::vector<Trial> three() { return {trial("a", 0.6), trial("b", 1), trial("c", 5)}; }

  fs::path file(const std::string& name) const { return options_.dir / "test" / (name + ".h5"); }

  test::TempDir temp_;
  TrialRunner::Options options_;
};

TEST_F(Laboratories, GiveResultsInTheOrderOfTheTrialsWhateverTheThreads) {
  std::vector<std::vector<double>> first;
  for (const unsigned threads : {1u, 2u, 5u}) {
    options_.threads = threads;
    fs::remove_all(options_.dir / "test");
    const std::vector<TrialResult> results = TrialRunner("test", options_).run(three());
    ASSERT_EQ(results.size(), 3u);
    std::vector<std::vector<double>> rows;
    for (const TrialResult& result : results) rows.push_back(physics(result.session));
    EXPECT_EQ(results[2].session.at(0, Column::eta)[0], 5);
    if (first.empty()) first = rows;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      EXPECT_TRUE(test::same_numbers(rows[i], first[i])) << threads << " threads";
    }
  }
}

TEST_F(Laboratories, ReadWhatIsThereInsteadOfRunningIt) {
  const std::vector<TrialResult> ran = TrialRunner("test", options_).run(three());
  std::map<std::string, fs::file_time_type> written;
  for (const char* name : {"a", "b", "c"}) written[name] = fs::last_write_time(file(name));
  const std::vector<TrialResult> read = TrialRunner("test", options_).run(three());
  for (std::size_t i = 0; i < 3; ++i) {
    // The timing, too, as it is the same run.
    EXPECT_TRUE(test::same_numbers(read[i].session.rows, ran[i].session.rows));
    EXPECT_EQ(read[i].end.rows, 300u);
    EXPECT_FALSE(read[i].end.diverged);
  }
  for (const auto& [name, time] : written) EXPECT_EQ(fs::last_write_time(file(name)), time);
}

// A trial far below its least eta in a stiff grip, with motors without limits.
Trial runaway(const std::string& name) {
  Parameters p;
  p.eta = 0.05;
  p.hand_stiffness = 3000;
  p.hand_damping = 0;
  p.torque_limit = 1000;
  return {name, plan_of(built_in_arm().description, "free", "free", p), false};
}

TEST_F(Laboratories, CountWhatDivergedUnlessItMay) {
  TrialRunner lab("test", options_);
  Trial asked = runaway("asked");
  asked.may_diverge = true;
  const auto results = lab.run({trial("a", 1), asked});
  ASSERT_TRUE(results[1].end.diverged);
  EXPECT_EQ(lab.diverged(), 0u);
  lab.run({runaway("b"), runaway("c")});
  EXPECT_EQ(lab.diverged(), 2u);
}

TEST_F(Laboratories, RememberUnderWhichConditionsTheyRan) {
  TrialRunner lab("test", options_);
  EXPECT_EQ(lab.conditions().text(), "");
  lab.run(three());
  EXPECT_NE(lab.conditions().text().find("limit of every motor: the arm's own"), std::string::npos);
}

TEST_F(Laboratories, RunAgainWhatAnotherPlanLeft) {
  TrialRunner("test", options_).run({trial("a", 1)});
  const auto result = TrialRunner("test", options_).run({trial("a", 2)});
  EXPECT_EQ(result[0].session.at(0, Column::eta)[0], 2);
  EXPECT_EQ(read_session(file("a")).at(0, Column::eta)[0], 2);
}

TEST_F(Laboratories, RunAgainWhereTheHandGoesElsewhereUnderTheSameName) {
  TrialRunner("test", options_).run({trial("a", 1)});
  Trial moved = trial("a", 1);
  for (Vec3& p : moved.plan.hand.position) p.z() += 0.001;
  const auto result = TrialRunner("test", options_).run({moved});
  EXPECT_EQ(result[0].session.at(0, Column::hand_target)[2], moved.plan.hand.sample(0, 0.001).z());
}

TEST_F(Laboratories, ReplaceAFileThatIsNoSession) {
  fs::create_directories(file("a").parent_path());
  std::ofstream(file("a")) << "not a session";
  EXPECT_EQ(TrialRunner("test", options_).run({trial("a", 1)})[0].session.size(), 300u);
  EXPECT_EQ(read_session(file("a")).size(), 300u);
}

TEST_F(Laboratories, LeaveNoFileOfATrialThatIsNotKept) {
  Trial t = trial("a", 1);
  t.keep = false;
  EXPECT_EQ(TrialRunner("test", options_).run({t})[0].session.size(), 300u);
  EXPECT_FALSE(fs::exists(file("a")));
}

TEST_F(Laboratories, ShareTrialsThroughAFolder) {
  Trial t = trial("a", 1);
  t.folder = "common";
  TrialRunner("test", options_).run({t});
  EXPECT_TRUE(fs::exists(options_.dir / "common" / "a.h5"));
}

TEST_F(Laboratories, StopWhenToldAndGoOnLater) {
  std::atomic<bool> stop{false};
  options_.stop = &stop;
  options_.threads = 1;
  options_.progress = [&](double) { stop = true; };  // after the first trial
  EXPECT_THROW(TrialRunner("test", options_).run(three()), Cancelled);
  EXPECT_TRUE(fs::exists(file("a")));
  EXPECT_FALSE(fs::exists(file("b")));

  stop = false;
  std::vector<double> parts;
  options_.progress = [&](double part) { parts.push_back(part); };
  const auto written = fs::last_write_time(file("a"));
  EXPECT_EQ(TrialRunner("test", options_).run(three()).size(), 3u);
  EXPECT_EQ(fs::last_write_time(file("a")), written);
  EXPECT_THAT(parts, ElementsAre(1.0 / 3, 2.0 / 3, 1.0));
}

TEST_F(Laboratories, PassOnWhatWentWrong) {
  Trial unreachable = trial("a", 1);
  for (Vec3& p : unreachable.plan.hand.position) p = Vec3(5, 0, 0);
  options_.threads = 1;
  EXPECT_THROW(TrialRunner("test", options_).run({unreachable, trial("b", 1), trial("c", 1)}),
               std::invalid_argument);
  EXPECT_FALSE(fs::exists(file("b")));
  EXPECT_FALSE(fs::exists(file("c")));
}

HandPath circle() { return plan_of(built_in_arm().description, "table", "circle", {}).hand; }

TEST(HandVariation, IsTheSameForTheSameSeedsAndAnotherForOthers) {
  const HandPath path = circle(), one = varied(path, 3, 1);
  EXPECT_EQ(one.position, varied(path, 3, 1).position);
  EXPECT_NE(one.position, varied(path, 3, 2).position);
  EXPECT_NE(one.position, varied(path, 4, 1).position);
  EXPECT_NE(one.source, varied(path, 3, 2).source);
}

TEST(HandVariation, StartsAndEndsWhereThePathDoesAndStaysNearIt) {
  const HandPath path = circle();
  Vec3 low = path.position[0], high = low;
  for (const Vec3& p : path.position) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Vec3 margin = 0.15 * (high - low) + Vec3::Constant(2e-4);
  for (std::uint64_t i = 1; i < 30; ++i) {
    const HandPath one = varied(path, 0, i);
    EXPECT_LT((one.position.front() - path.position.front()).norm(), 1e-12);
    EXPECT_LT((one.position.back() - path.position.back()).norm(), 1e-4);
    EXPECT_NEAR(one.duration() / path.duration(), 1, 0.16);
    for (const Vec3& p : one.position) {
      EXPECT_TRUE((p.array() >= (low - margin).array()).all());
      EXPECT_TRUE((p.array() <= (high + margin).array()).all());
    }
  }
}

// The hand follows its path at 0.8 to 1.2 of a steady pace. So half of the way is never farther
// from half of the time than the pace's integral, 0.2 / (2 pi).
TEST(HandVariation, IsOnItsWayWhenThePathIs) {
  HandPath straight = circle();
  const Vec3 way(0.1, 0.02, 0);
  for (std::size_t i = 0; i < straight.time.size(); ++i) {
    straight.position[i] = straight.time[i] / straight.time.back() * way;
    straight.velocity[i] = way / straight.time.back();
  }
  for (std::uint64_t i = 1; i < 30; ++i) {
    const HandPath one = varied(straight, 0, i);
    const double larger = one.position.back().dot(way) / way.squaredNorm();
    for (std::size_t k = 0; k < one.time.size(); k += 50) {
      const double gone = one.position[k].dot(way) / way.squaredNorm() / larger;
      EXPECT_NEAR(gone, one.time[k] / one.time.back(), 0.2 / (2 * M_PI) + 0.01) << i << " " << k;
    }
  }
}

TEST(PassivityTrials, FollowTheSameHandsWithEveryCoupling) {
  const auto some = passivity_trials(built_in_arm(), passivity_cases()[0], 7);
  const auto others = passivity_trials(built_in_arm(), passivity_cases()[4], 7);
  ASSERT_EQ(some.size(), kTrialsOfACase);
  for (std::size_t i = 0; i < some.size(); ++i) {
    EXPECT_EQ(some[i].plan.hand.position, others[i].plan.hand.position);
    EXPECT_NE(some[i].name, others[i].name);
    EXPECT_EQ(some[i].plan.seed, 7u) << "and the same noise";
  }
  EXPECT_EQ(some[0].plan.hand.position, circle().position);
}

}  // namespace
}  // namespace limpid
