#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <limits>
#include <set>
#include <utility>

#include "app/experiments/experiment.h"
#include "app/experiments/signals.h"
#include "app/run/run_key.h"
#include "tests/support/meshes.h"
#include "tests/support/rows.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using Change = std::function<void(RunPlan&)>;

// A plan with every possible content.
RunPlan rich_plan() {
  RunPlan plan = plan_of(built_in_arm().description, "table", "touch", {});
  plan.rows = 40;
  plan.seed = 5;
  plan.changes = {{10, "coupling.eta = 2.0"}};
  plan.hand_torque = {0.1, 0.2, 0.3};
  plan.force = {true, false};
  plan.start = rest_at(plan.arm, plan.hand.position.front());
  plan.beside.push_back({plan.parameters, {{20, "coupling.eta = 3.0"}}, plan.start});
  return plan;
}

const std::vector<std::pair<const char*, Change>> kChanges{
    {"a byte of the arm", [](RunPlan& p) { p.arm.urdf[p.arm.urdf.size() / 2] ^= 1; }},
    {"a byte of the scene", [](RunPlan& p) { p.document.toml.back() ^= 1; }},
    {"a parameter", [](RunPlan& p) { p.parameters.b_vc *= 1 + 1e-15; }},
    {"the coupling", [](RunPlan& p) { p.parameters.kind = CouplingKind::standard; }},
    {"the tick", [](RunPlan& p) { p.parameters.tick = 0.0011; }},
    {"the substeps", [](RunPlan& p) { ++p.parameters.substeps; }},
    {"a number that was the arm's", [](RunPlan& p) { p.parameters.friction = 0; }},
    {"a hand sample", [](RunPlan& p) { p.hand.position[7].y() += 1e-15; }},
    {"a hand sample's time", [](RunPlan& p) { p.hand.time[7] += 1e-12; }},
    {"a slope of the hand", [](RunPlan& p) { p.hand.velocity[7].z() += 1e-12; }},
    {"a grip", [](RunPlan& p) { p.hand.grip[7] = 0.5; }},
    {"a magnet", [](RunPlan& p) { p.hand.magnet.assign(p.hand.time.size(), true); }},
    {"when the magnet holds",
     [](RunPlan& p) {
       p.hand.magnet.assign(p.hand.time.size(), true);
       p.hand.magnet[7] = false;
     }},
    {"the hand's tick", [](RunPlan& p) { p.hand.tick = 0.001; }},
    {"the hand's name", [](RunPlan& p) { p.hand.source += "x"; }},
    {"a change's row", [](RunPlan& p) { ++p.changes[0].row; }},
    {"a change", [](RunPlan& p) { p.changes[0].setting = "coupling.eta = 2.1"; }},
    {"one change more", [](RunPlan& p) { p.changes.push_back(p.changes[0]); }},
    {"a torque of the hand", [](RunPlan& p) { p.hand_torque[2] = 0.31; }},
    {"when the force is armed", [](RunPlan& p) { p.force[1] = true; }},
    {"where the device starts", [](RunPlan& p) { p.start->x1[0] += 1e-15; }},
    {"how fast the proxy starts", [](RunPlan& p) { p.start->v2[2] = 1e-3; }},
    {"where bodies start",
     [](RunPlan& p) {
       p.start->world = {1.0, 2.0};
     }},
    {"whether it starts armed", [](RunPlan& p) { p.start->armed = false; }},
    {"where it starts at all", [](RunPlan& p) { p.start.reset(); }},
    {"what the ledger starts with", [](RunPlan& p) { p.start->reserve = 1e-3; }},
    {"the rows", [](RunPlan& p) { ++p.rows; }},
    {"the seed", [](RunPlan& p) { ++p.seed; }},
    {"a parameter of the twin", [](RunPlan& p) { p.beside[0].parameters.eta = 0.5; }},
    {"a change of the twin",
     [](RunPlan& p) { p.beside[0].changes[0].setting = "coupling.eta = 4"; }},
    {"where the twin starts", [](RunPlan& p) { p.beside[0].start->x2[0] += 1e-15; }},
    {"where the twin starts at all", [](RunPlan& p) { p.beside[0].start.reset(); }},
    {"one lane more", [](RunPlan& p) { p.beside.push_back(p.beside[0]); }},
    {"that there is a twin", [](RunPlan& p) { p.beside.clear(); }},
};

TEST(TrialKey, IsAnotherOneForWhateverIsOtherwise) {
  std::set<std::uint64_t> keys{trial_key(rich_plan(), 1)};
  for (const auto& [what, change] : kChanges) {
    RunPlan plan = rich_plan();
    change(plan);
    EXPECT_TRUE(keys.insert(trial_key(plan, 1)).second) << what;
  }
  EXPECT_TRUE(keys.insert(trial_key(rich_plan(), 2)).second) << "the program";
}

TEST(TrialKey, KnowsTheModelsOfTheScene) {
  RunPlan plan = rich_plan();
  Object mesh = test::obstacle(test::sheet(1, 1));
  test::mesh_of(mesh).model = "a.glb";
  using Bytes = std::vector<unsigned char>;
  plan.document.models["a.glb"].bytes = std::make_shared<const Bytes>(Bytes{1, 2, 3});
  const std::size_t place = plan.document.scene.add(mesh);
  std::set<std::uint64_t> keys{trial_key(rich_plan(), 1), trial_key(plan, 1)};
  plan.document.models["a.glb"].bytes = std::make_shared<const Bytes>(Bytes{1, 2, 4});
  keys.insert(trial_key(plan, 1));
  plan.document.models["b.glb"] = plan.document.models["a.glb"];
  test::mesh_of(plan.document.scene.objects[place]).model = "b.glb";
  keys.insert(trial_key(plan, 1));
  EXPECT_EQ(keys.size(), 4u);
}

TEST(TrialKey, IsTheSameForTheSame) {
  EXPECT_EQ(trial_key(rich_plan(), 1), trial_key(rich_plan(), 1));
  EXPECT_NE(program_digest(), 0u);
  EXPECT_EQ(program_digest(), program_digest());
}

// A trial in a folder of its own, and whether a second call runs it again.
class StoredTrial : public testing::Test {
 protected:
  void SetUp() override { options_.dir = temp_ / "."; }

  Trial trial() const {
    Trial t{"a-0.6",
            plan_of(built_in_arm().description, "table", "touch", {})};  // a name with a dot in it
    t.plan.rows = 60;
    t.plan.changes = {{30, "coupling.eta = 2.0"}};
    return t;
  }
  // Torques and positions have the same bits every time; durations of ticks differ.
  TrialResult run(const Trial& t) { return TrialRunner("test", options_).run({t}).front(); }
  bool reused(const Trial& t) {
    const TrialResult before = run(trial());
    std::optional<Session> stored = read_session(file());
    EXPECT_TRUE(test::same_numbers(stored->rows, before.session.rows));
    return test::same_numbers(run(t).session.rows, stored->rows);
  }
  fs::path file() const { return options_.dir / "test/a-0.6.h5"; }

  test::TempDir temp_;
  TrialRunner::Options options_;
};

TEST_F(StoredTrial, IsTakenAgainByTheSameProgramAndPlan) {
  EXPECT_TRUE(reused(trial()));
  const Session session = read_session(file());
  ASSERT_EQ(session.changes.size(), 1u);
  EXPECT_EQ(session.changes[0].row, 30u);
}

TEST_F(StoredTrial, IsRunAgainByAnotherBuildOfTheProgram) {
  options_.program = 77;
  const TrialResult before = run(trial());
  EXPECT_TRUE(test::same_numbers(run(trial()).session.rows, before.session.rows));
  options_.program = 78;
  EXPECT_FALSE(test::same_numbers(run(trial()).session.rows, before.session.rows));
}

TEST_F(StoredTrial, IsRunAgainForAnotherParameterArmOrHand) {
  const std::pair<const char*, Change> changes[] = {
      {"a parameter", [](RunPlan& p) { p.parameters.b_vc = 0.0011; }},
      {"a byte of the arm", [](RunPlan& p) { p.arm.urdf += " "; }},
      {"a sample after the last row", [](RunPlan& p) { p.hand.position.back().x() += 1e-9; }},
      {"the changes", [](RunPlan& p) { p.changes.clear(); }},
  };
  for (const auto& [what, change] : changes) {
    Trial other = trial();
    change(other.plan);
    EXPECT_FALSE(reused(other)) << what;
  }
}

TEST_F(StoredTrial, IsRunAgainWhereItsFileWasTouched) {
  const TrialResult before = run(trial());
  // A number of one row is changed in an otherwise sound session.
  Session changed = read_session(file());
  const auto number = static_cast<std::size_t>(20 * changed.layout.stride() +
                                               changed.layout.offset(Column::device_position));
  const double wanted = changed.rows[number];
  changed.rows[number] += 1e-9;
  SessionWriter writer(file(), changed.info, true);
  writer.append(changed.rows);
  for (const SettingChange& change : changed.changes) writer.append(change);
  writer.close();
  ASSERT_TRUE(test::same_numbers(read_session(file()).rows, changed.rows));
  EXPECT_EQ(run(trial()).session.rows[number], wanted);
  EXPECT_EQ(read_session(file()).rows[number], wanted);
}

TEST_F(StoredTrial, IsRunAgainWhereItsFileOrItsStampIsCutShortOrGone) {
  const fs::path key = options_.dir / "test/a-0.6.key";
  for (const fs::path& damaged : {file(), key}) {
    for (const bool gone : {false, true}) {
      const TrialResult before = run(trial());
      ASSERT_TRUE(fs::exists(damaged));
      if (gone) {
        fs::remove(damaged);
      } else {
        fs::resize_file(damaged, fs::file_size(damaged) - 1);
      }
      const TrialResult again = run(trial());
      // The timing differs.
      EXPECT_FALSE(test::same_numbers(again.session.rows, before.session.rows)) << damaged << gone;
      EXPECT_EQ(again.session.size(), 60u);
      EXPECT_TRUE(test::same_numbers(read_session(file()).rows, again.session.rows));
    }
  }
}

TEST_F(StoredTrial, OfALoopThatBecameUnstableSaysSoAgain) {
  Trial t = trial();
  t.plan.changes.clear();
  t.plan.parameters.k_vc = 1e4;
  t.plan.parameters.tick = 0.01;
  t.plan.parameters.torque_limit = 1e4;
  t.plan.rows = 20000;
  const RunEnd ran = run(t).end, read = run(t).end;
  ASSERT_TRUE(ran.diverged);
  EXPECT_TRUE(read.diverged);
  EXPECT_EQ(read.rows, ran.rows);
  EXPECT_EQ(read.diverged_at, ran.diverged_at);
  EXPECT_EQ(read.why, ran.why);
}

TEST(Checks, PassOnTheirBoundAndFailBeyondIt) {
  const auto up = [](double x) { return std::nextafter(x, HUGE_VAL); };
  const auto down = [](double x) { return std::nextafter(x, -HUGE_VAL); };
  EXPECT_TRUE(at_most("", 3, 3).passed);
  EXPECT_TRUE(at_most("", -4, 3).passed);
  EXPECT_FALSE(at_most("", up(3), 3).passed);
  EXPECT_TRUE(at_least("", 3, 3).passed);
  EXPECT_TRUE(at_least("", 4, 3).passed);
  EXPECT_FALSE(at_least("", down(3), 3).passed);
  EXPECT_FALSE(at_least("", -4, 3).passed);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(at_most("", nan, 3).passed);
  EXPECT_FALSE(at_least("", nan, 3).passed);
  EXPECT_FALSE(at_most("", HUGE_VAL, 3).passed);
  EXPECT_FALSE(at_least("", -HUGE_VAL, 3).passed);
  const Check check = at_least("so much", 2, 3);
  EXPECT_EQ(check.what, "so much");
  EXPECT_EQ(check.value, 2);
  EXPECT_EQ(check.bound, 3);
}

TEST(Outcomes, PassOnlyIfEveryCheckDoes) {
  const Check good = at_most("", 1, 2), bad = at_least("", 1, 2);
  const auto passed = [](std::vector<Check> checks) {
    Outcome outcome;
    outcome.checks = std::move(checks);
    return outcome.passed();
  };
  EXPECT_TRUE(passed({good}));
  EXPECT_TRUE(passed({good, good}));
  EXPECT_FALSE(passed({bad, good, good}));
  EXPECT_FALSE(passed({good, bad, good}));
  EXPECT_FALSE(passed({good, good, bad}));
  EXPECT_FALSE(passed({}));
}

}  // namespace
}  // namespace limpid
