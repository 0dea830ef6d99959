// Runs on one hand: each as if it ran alone, in one file, and all again from it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

#include "app/run/lane_settings.h"
#include "app/run/recorder.h"
#include "app/run/replay.h"
#include "devices/files/session/session_csv.h"
#include "tests/app/run/recorded.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

using test::first_difference;
using test::recorded;
using test::Rows;
using test::rows_of;

struct Both {
  Rows first, twin;
};

Both run_both(const RunPlan& plan) {
  const RowLayout layout(plan.arm.dof());
  const auto stride = static_cast<std::size_t>(layout.stride());
  Both both{Rows(layout), Rows(layout)};
  simulate(plan, {}, [&](std::span<const double> rows, const auto&) {
    both.first.add(rows.first(stride));
    both.twin.add(rows.subspan(stride));
    return true;
  });
  return both;
}

// A plan of the proposed law beside the standard one, both with a change during the run.
RunPlan pair() {
  RunPlan plan = test::plan("obstacles.toml", "touch.csv", 2);
  plan.parameters.eta = 0.7;
  plan.changes = {{600, "coupling.eta = 0.9"}};
  Lane& twin = plan.beside.emplace_back();
  twin.parameters = plan.parameters;
  twin.parameters.kind = CouplingKind::standard;
  twin.changes = {{800, "coupling.k_vc = 8.0"}};
  return plan;
}

RunPlan alone(const RunPlan& plan) {
  RunPlan one = plan;
  one.parameters = plan.beside[0].parameters;
  one.changes = plan.beside[0].changes;
  one.beside.clear();
  return one;
}

TEST(Twin, HasTheCouplingsSettingsOfItsOwnAndNoOthers) {
  constexpr std::array<std::string_view, 11> kOwn{"coupling.", "observer.", "predictor.", "ledger.",
                                                  "tank.",     "model.",    "eba.",       "popc.",
                                                  "wave.",     "tdpn.",     "sfa."};
  std::array<Parameters, 2> lanes;
  auto& [first, twin] = lanes;
  for (const ParameterInfo& info : parameter_table()) {
    set_parameter_number(first, info, info.minimum);
    set_parameter_number(twin, info, info.maximum);
  }
  share_world(lanes);
  for (const ParameterInfo& info : parameter_table()) {
    const bool own = std::ranges::any_of(kOwn, [&info](std::string_view group) {
      return std::string_view(info.key).starts_with(group);
    });
    EXPECT_EQ(of_controller(info), own) << info.key;
    EXPECT_EQ(parameter_number(twin, info), own ? info.maximum : info.minimum) << info.key;
  }
}

TEST(Twin, GivesEachRunWhatItGivesAlone) {
  const RunPlan plan = pair();
  RunPlan first = plan;
  first.beside.clear();
  const Both both = run_both(plan);
  EXPECT_EQ(first_difference(both.first, rows_of(first)), -1);
  EXPECT_EQ(first_difference(both.twin, rows_of(alone(plan))), -1);
}

RunPlan three() {
  RunPlan plan = pair();
  Lane& third = plan.beside.emplace_back(plan.lane(0));
  third.parameters.kind = CouplingKind::predictive;
  third.changes = {{300, "coupling.eta = 0.3"}, {900, "coupling.kind = standard"}};
  return plan;
}

TEST(Lanes, AreAsManyAsThePlanHasAndEachIsAsIfItRanAlone) {
  const RunPlan plan = three();
  const auto stride = static_cast<std::size_t>(RowLayout(plan.arm.dof()).stride());
  std::vector<Rows> lanes(plan.lanes(), Rows(RowLayout(plan.arm.dof())));
  std::vector<int> changes(plan.lanes());
  simulate(plan, {}, [&](std::span<const double> rows, LaneChanges changed) {
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      lanes[i].add(rows.subspan(i * stride, stride));
      changes[i] += changed[i] != nullptr;
    }
    return true;
  });
  EXPECT_EQ(changes, (std::vector<int>{1, 1, 2}));
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    RunPlan one = plan;
    static_cast<Lane&>(one) = plan.lane(i);
    one.beside.clear();
    EXPECT_EQ(first_difference(lanes[i], rows_of(one)), -1) << i;
  }
}

TEST(Lanes, AreOneFileFromWhichAllComeAgain) {
  const test::TempDir dir;
  const RunPlan plan = three();
  const Session session = recorded(plan, dir / "a.h5");
  ASSERT_EQ(session.lanes(), 3u);
  const RunPlan again = replay(session, "a.h5", session_parameters(session, "a.h5"));
  ASSERT_EQ(again.lanes(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    RunPlan one = again;
    static_cast<Lane&>(one) = again.lane(i);
    one.beside.clear();
    EXPECT_EQ(first_difference(rows_of(session.lane(i)), rows_of(one)), -1) << i;
    EXPECT_EQ(session.lane(i).changes.size(), plan.lane(i).changes.size());
  }
  write_csv(session, dir / "a.csv", false);
  std::ifstream file(dir / "a.csv");
  std::string header;
  std::getline(file, header);
  EXPECT_NE(header.find(",lane3_time_s,"), std::string::npos);
}

TEST(Lanes, AreNamedByTheirLawsOrByWhatTheyDifferIn) {
  using enum CouplingKind;
  const auto of = [](CouplingKind kind, double eta) {
    Parameters p;
    p.kind = kind;
    p.eta = eta;
    return p;
  };
  using Names = std::vector<std::string>;
  const auto names = [](std::vector<Parameters> lanes) { return lane_names(lanes); };
  EXPECT_EQ(names({of(standard, 1), of(predictive, 1)}), (Names{"standard", "predictive"}));
  EXPECT_EQ(names({of(standard, 1), of(standard, 1)}), (Names{"standard 1", "standard 2"}));
  const std::string eta = find_parameter("coupling.eta")->label;
  EXPECT_EQ(names({of(predictive, 1), of(predictive, 0.5)}), (Names{eta + " 1.0", eta + " 0.5"}));
  EXPECT_EQ(names({of(predictive, 1), of(standard, 1), of(predictive, 0.5)}),
            (Names{"predictive, " + eta + " 1.0", "standard", "predictive, " + eta + " 0.5"}));
  for (const CouplingKind first : {standard, proposed, predictive, tank}) {
    const std::vector<Parameters> one{of(first, 1)};
    EXPECT_NE(law_beside(one), first);
    const std::vector<Parameters> two{one[0], of(law_beside(one), 1)};
    EXPECT_NE(law_beside(two), first);
    EXPECT_NE(law_beside(two), two[1].kind);
  }
}

TEST(Twin, IsOneFileFromWhichBothComeAgain) {
  const test::TempDir dir;
  const RunPlan plan = pair();
  const Session session = recorded(plan, dir / "a.h5");
  ASSERT_EQ(session.lanes(), 2u);
  const Both both = run_both(plan);
  EXPECT_EQ(first_difference(rows_of(session), both.first), -1);
  EXPECT_EQ(first_difference(rows_of(session.lane(kTwinLane)), both.twin), -1);
  EXPECT_EQ(session.lane(kTwinLane).changes.size(), 1u);
  const Both again = run_both(replay(session, "a.h5", session_parameters(session, "a.h5")));
  EXPECT_EQ(first_difference(again.first, both.first), -1);
  EXPECT_EQ(first_difference(again.twin, both.twin), -1);
}

TEST(Twin, IsRunAgainWithWhatIsChosenOtherwiseButForWhatTheTwoDifferIn) {
  const test::TempDir dir;
  const Session session = recorded(pair(), dir / "a.h5");
  Parameters chosen = session_parameters(session, "a.h5");
  chosen.hand_stiffness = 500;
  chosen.kind = CouplingKind::predictive;
  const RunPlan again = replay(session, "a.h5", chosen);
  ASSERT_EQ(again.lanes(), 2u);
  EXPECT_EQ(again.beside[0].parameters.hand_stiffness, 500);
  EXPECT_EQ(again.beside[0].parameters.kind, CouplingKind::standard);
}

TEST(Twin, StandsBehindTheFirstRunInATable) {
  const test::TempDir dir;
  const Session session = recorded(pair(), dir / "a.h5");
  write_csv(session, dir / "a.csv", false);
  std::ifstream file(dir / "a.csv");
  std::string header, row;
  std::getline(file, header);
  std::getline(file, row);
  EXPECT_NE(header.find(",twin_time_s,"), std::string::npos);
  EXPECT_EQ(std::ranges::count(header, ','), std::ranges::count(row, ','));
  constexpr int kTips = 5 * 3;  // places and velocities of both tips, and the total force
  EXPECT_EQ(std::ranges::count(header, ',') + 1, 2 * (session.layout.stride() + kTips));
}

TEST(Twin, KilledWhileRecordingKeepsAsManyRowsOfBoth) {
  const test::TempDir dir;
  const RunPlan plan = pair();
  {
    SessionWriter writer(dir / "a.h5", session_info(plan), false);
    const Both both = run_both(plan);
    for (std::size_t k = 0; k < 1400; ++k) writer.append(both.first.row(k));
    for (std::size_t k = 0; k < 900; ++k) writer.append(both.twin.row(k), kTwinLane);
  }
  const Recovered saved = recover_session(dir / "a.h5.part", false);
  const Session session = read_session(saved.file);
  ASSERT_EQ(session.lanes(), 2u);
  EXPECT_EQ(session.size(), 512u);  // the smaller number of whole blocks
  EXPECT_EQ(session.lane(kTwinLane).size(), 512u);
}

TEST(Lanes, KilledWhileRecordingKeepAsManyRowsOfEach) {
  const test::TempDir dir;
  const RunPlan plan = three();
  {
    SessionWriter writer(dir / "a.h5", session_info(plan), false);
    const Both both = run_both(plan);
    for (std::size_t k = 0; k < 1400; ++k) writer.append(both.first.row(k));
    for (std::size_t k = 0; k < 1300; ++k) writer.append(both.first.row(k), kTwinLane);
    for (std::size_t k = 0; k < 900; ++k) writer.append(both.first.row(k), 2);
  }
  const Session session = read_session(recover_session(dir / "a.h5.part", false).file);
  ASSERT_EQ(session.lanes(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(session.lane(i).size(), 512u) << i;
}

TEST(Lanes, AreRecordedAsManyAsTheFileSays) {
  const test::TempDir dir;
  const RunPlan plan = three();
  EXPECT_THROW(Recorder(dir / "a.h5", session_info(plan), plan.parameters, false),
               std::invalid_argument);
}

TEST(Twin, EndsWhereItsSecondRunBecomesUnstable) {
  RunPlan plan = test::plan("free.toml", "free.csv", 8);
  Lane& wild = plan.beside.emplace_back();
  wild.parameters = plan.parameters;
  wild.parameters.kind = CouplingKind::standard;
  wild.parameters.k_vc = 1e5;
  wild.parameters.torque_limit = 1e4;
  RunPlan tame = plan;
  tame.beside.clear();
  const auto none = [](std::span<const double>, const auto&) { return true; };
  EXPECT_FALSE(simulate(tame, {}, none).diverged);
  const RunEnd end = simulate(plan, {}, none);
  EXPECT_TRUE(end.diverged);
  EXPECT_LT(end.rows, plan.rows);
  EXPECT_FALSE(end.why.empty());
}

}  // namespace
}  // namespace limpid
