// Recordings run again, bit for bit.
#include "app/run/replay.h"

#include <cmath>

#include "app/base/version.h"
#include "app/run/analysis.h"
#include "app/run/program_build.h"
#include "app/run/recorder.h"
#include "core/dynamics/inverse_kinematics.h"
#include "devices/files/config_file.h"
#include "tests/app/run/recorded.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

using test::first_difference;
using test::recorded;
using test::rows_of;

RunPlan eventful() {
  RunPlan plan = test::plan("obstacles.toml", "touch.csv", 3);
  plan.parameters.eta = 0.8;
  plan.parameters.hand_stiffness = 417.3;
  plan.changes = {{500, "coupling.kind = \"standard\""}, {900, "coupling.eta = 2.123456789012345"},
                  {901, "coupling.kind = \"proposed\""}, {1200, "observer.velocity = \"adaptive\""},
                  {1200, "device.encoder_step = 4e-4"},  {1500, "device.damping = 0.02"},
                  {1800, "proxy.inertia_ratio = 0.01"},  {2100, "device.damping = "},
                  {2200, "device.torque_limit = 0.1"}};
  for (std::size_t k = 0; k < plan.rows; ++k) plan.force.push_back(k % 1000 < 800);
  return plan;
}

TEST(Replay, GivesEveryRowOfARunAgainWithItsChangesInTheMiddle) {
  const test::TempDir dir;
  const RunPlan plan = eventful();
  const Session session = recorded(plan, dir / "a.h5");
  ASSERT_EQ(session.size(), plan.rows);
  EXPECT_EQ(first_difference(rows_of(plan), rows_of(session)), -1);  // the file lost nothing
  const RunPlan again = replay(session, "a.h5", session_parameters(session, "a.h5"));
  EXPECT_EQ(again.rows, plan.rows);
  EXPECT_EQ(again.changes.size(), plan.changes.size());
  EXPECT_EQ(first_difference(rows_of(session), rows_of(again)), -1);
}

TEST(Replay, BeginsWithWhatTheLoopKeptOfItsBodiesAndTellsItOn) {
  const test::TempDir dir;
  Session session = recorded(test::plan("table.toml", "touch.csv", 0.2), dir / "a.h5");
  session.world = {1, 2, 3};
  const RunPlan plan = replay(session, "a.h5", session_parameters(session, "a.h5"));
  ASSERT_TRUE(plan.start);
  EXPECT_EQ(plan.start->world, session.world);
  SessionInfo info = session_info(plan);
  info.bodies = {"die"};
  Recorder recorder(dir / "b.h5", info, plan.parameters, false);
  tell_start(recorder, plan);
  ASSERT_TRUE(recorder.push(std::vector<double>(recorder.stride(), 0.0)));
  recorder.finish();
  EXPECT_EQ(read_session(dir / "b.h5").world, session.world);
}

TEST(Replay, RefusesRowsOfMoreBodiesThanTheSceneHas) {
  const test::TempDir dir;
  Session session = recorded(test::plan("table.toml", "touch.csv", 0.2), dir / "a.h5");
  session.info.bodies = {"die"};
  session.layout = session.info.layout();
  session.rows.assign(static_cast<std::size_t>(session.layout.stride()), 0.0);
  EXPECT_THAT(test::refusal([&] { replay(session, "a.h5", {}); }),
              testing::AllOf(testing::HasSubstr("a.h5"), testing::HasSubstr("/objects/pose"),
                             testing::HasSubstr("1 bodies; needed: 0")));
}

TEST(Replay, OfAReplayIsTheSameStill) {
  const test::TempDir dir;
  const Session first = recorded(eventful(), dir / "a.h5");
  const RunPlan plan = replay(first, "a.h5", session_parameters(first, "a.h5"));
  const Session second = recorded(plan, dir / "b.h5");
  EXPECT_EQ(first_difference(rows_of(first), rows_of(second)), -1);
  EXPECT_EQ(second.changes.size(), first.changes.size());
}

TEST(Replay, KeepsWhatIsChosenOtherwiseAgainstTheRecordedChanges) {
  const test::TempDir dir;
  const Session session = recorded(eventful(), dir / "a.h5");
  Parameters chosen = session_parameters(session, "a.h5");
  EXPECT_EQ(chosen.eta, 0.8);
  chosen.eta = 3;
  const auto rows = rows_of(replay(session, "a.h5", chosen));
  for (std::size_t k = 0; k < rows.size(); ++k) ASSERT_EQ(rows.at(k, Column::eta), 3);
  // All other settings are as recorded.
  EXPECT_EQ(rows.at(700, Column::kind), 0);
  EXPECT_EQ(rows.at(1000, Column::kind), 1);
}

TEST(Replay, RefusesASessionWhoseTextsAreBroken) {
  const test::TempDir dir;
  const Session whole = recorded(test::plan("table.toml", "touch.csv", 0.1), dir / "a.h5");
  Session broken = whole;
  broken.info.device_urdf = "<robot";
  EXPECT_THAT(test::refusal([&] { replay(broken, "a.h5", Parameters{}); }),
              testing::HasSubstr("a.h5"));
  broken = whole;
  broken.info.scene = "[[plane]\n";
  EXPECT_THAT(test::refusal([&] { replay(broken, "a.h5", Parameters{}); }),
              testing::HasSubstr("a.h5"));
  broken = whole;
  broken.info.config = "coupling.eta = true\n";
  EXPECT_THAT(test::refusal([&] { session_parameters(broken, "a.h5"); }),
              testing::HasSubstr("coupling.eta"));
}

// A real device's hand is not measured: the observer's estimate of it acts instead. The estimate
// lags by the observer's time, m / alpha. So the integral of the torque is short by that time's
// share of the present torque, and the damped arm is behind by this over b_d.
TEST(Replay, LetsTheEstimateActWhereNobodyMeasuredTheHand) {
  const test::TempDir dir;
  const RunPlan plan = test::plan("free.toml", "touch.csv", 3);
  const Session measured = recorded(plan, dir / "a.h5");
  Recorder recorder(dir / "b.h5", session_info(plan), plan.parameters, false);
  const RowLayout& layout = measured.layout;
  double strongest = 0;  // [N m]
  for (std::size_t k = 0; k < measured.size(); ++k) {
    std::vector<double> row(measured.row(k).begin(), measured.row(k).end());
    for (double& value : layout.in(std::span(row), Column::hand_torque)) {
      strongest = std::max(strongest, std::abs(value));
      value = std::nan("");
    }
    ASSERT_TRUE(recorder.push_waiting(row));
  }
  recorder.finish();
  const Session blind = read_session(dir / "b.h5");
  const auto again = rows_of(replay(blind, "b.h5", session_parameters(blind, "b.h5")));
  ASSERT_EQ(again.size(), measured.size());
  const auto before = rows_of(measured);
  const Analysis analysis = analyze(plan.arm, rest_pose(plan.arm), plan.parameters, {});
  const double lag = 1 / *std::ranges::min_element(analysis.w_f);
  const double allowed = lag * strongest / plan.arm.joints[0].damping;
  double error = 0, way = 0;
  for (std::size_t k = 0; k < again.size(); ++k) {
    const Eigen::VectorXd x = before.vec(k, Column::device_position);
    error = std::max(error, (again.vec(k, Column::device_position) - x).cwiseAbs().maxCoeff());
    way = std::max(way, (x - before.vec(0, Column::device_position)).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(error, allowed);
  EXPECT_LT(error, way / 10);
}

// A recording of a real device with this plan: nobody measured the hand.
Session blind(const RunPlan& plan, const std::filesystem::path& out) {
  Recorder recorder(out, session_info(plan), plan.parameters, false);
  simulate(plan, {}, [&](std::span<const double> row, LaneChanges) {
    std::vector<double> copy(row.begin(), row.end());
    const RowLayout layout(plan.arm.dof());
    for (double& value : layout.in(std::span(copy), Column::hand_torque)) value = std::nan("");
    return recorder.push_waiting(copy);
  });
  recorder.finish();
  return read_session(out);
}

TEST(Replay, LetsEveryRowsOwnEstimateActHoweverLongItIsAndWhateverItsTick) {
  // k T / T is not k to the last bit; with a tick of 1 ms it falls short from row 2001 on.
  const test::TempDir dir;
  for (const double tick : {0.001, 0.0007, 0.003}) {
    RunPlan plan = test::plan("table.toml", "touch.csv", 0.001);
    plan.parameters.tick = tick;
    plan.rows = 4500;
    const std::string name = "blind-" + std::to_string(tick) + ".h5";
    const Session session = blind(plan, dir / name.c_str());
    const auto again = rows_of(replay(session, name, session_parameters(session, name)));
    ASSERT_EQ(again.size(), 4500u);
    for (std::size_t k = 0; k < again.size(); ++k) {
      const auto estimate = session.at(k, Column::hand_torque_estimate);
      const Eigen::VectorXd acted = again.vec(k, Column::hand_torque);
      for (int i = 0; i < 3; ++i) {
        ASSERT_EQ(acted[i], estimate[static_cast<std::size_t>(i)]) << tick << ' ' << k;
      }
    }
  }
}

TEST(Replay, TakesTheNearestRecordedEstimateAtAnotherTick) {
  const test::TempDir dir;
  RunPlan plan = test::plan("free.toml", "touch.csv", 0.001);
  plan.rows = 900;
  const Session session = blind(plan, dir / "a.h5");
  RunPlan faster = replay(session, "a.h5", session_parameters(session, "a.h5"));
  faster.parameters.tick = 0.0004;
  faster.force.clear();
  faster.rows = 2300;
  const auto rows = rows_of(faster);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    // 0.4 k is never halfway: five rows at 0, 0.4, 0.8, 1.2, 1.6.
    const std::size_t nearest[] = {0, 0, 1, 1, 2};
    const std::size_t row = std::min<std::size_t>(2 * (k / 5) + nearest[k % 5], 899);
    ASSERT_EQ(rows.at(k, Column::hand_torque), session.at(row, Column::hand_torque_estimate)[0])
        << k;
  }
}

TEST(Replay, HasTickSeedLengthAndStartOfTheRecording) {
  const test::TempDir dir;
  RunPlan plan = test::plan("table.toml", "touch.csv", 0.001);
  plan.parameters.tick = 0.002;
  plan.parameters.eta = 0.8;
  plan.rows = 345;
  plan.seed = 7654321;
  const Session session = recorded(plan, dir / "a.h5");
  EXPECT_EQ(session.info.tick, 0.002);
  EXPECT_EQ(session.info.seed, 7654321u);
  EXPECT_EQ(session_parameters(session, "a.h5").tick, 0.002);
  // The chosen settings: defaults, T = 1 ms.
  const RunPlan again = replay(session, "a.h5", Parameters{});
  EXPECT_EQ(again.parameters.tick, 0.002);
  EXPECT_EQ(again.parameters.eta, 1);
  EXPECT_EQ(again.seed, 7654321u);
  EXPECT_EQ(again.rows, 345u);
  EXPECT_EQ(again.hand.position.size(), 345u);
  EXPECT_EQ(again.hand.tick, 0.002);
  ASSERT_TRUE(again.start);
  EXPECT_EQ(again.start->x1, rows_of(session).vec(0, Column::device_position));
  EXPECT_TRUE(again.hand_torque.empty());
  EXPECT_EQ(session_info(again).seed, 7654321u);
  EXPECT_EQ(session_info(again).tick, 0.002);
}

TEST(Replay, TicksAsTheFileSaysEvenIfItsParametersSayOtherwise) {
  const test::TempDir dir;
  Session session = recorded(test::plan("table.toml", "touch.csv", 0.05), dir / "a.h5");
  session.info.tick = 0.004;
  EXPECT_EQ(session_parameters(session, "a.h5").tick, 0.004);
}

// The virtual arm in a real device's place has each of the forces that the motors compensated.
TEST(Replay, GivesTheVirtualArmTheForcesThatTheMotorsHeld) {
  for (const auto& [weight, springs] : {std::pair(true, false), {false, true}, {false, false}}) {
    const test::TempDir dir;
    RunPlan plan = test::plan("free.toml", "touch.csv", 0.2);
    plan.parameters.holds_weight = weight;
    plan.parameters.holds_springs = springs;
    Session session = blind(plan, dir / "a.h5");
    session.changes = {{50, springs ? "model.springs = false" : "model.springs = true"},
                       {90, weight ? "model.gravity = false" : "model.gravity = true"}};
    const RunPlan again = replay(session, "a.h5", session_parameters(session, "a.h5"));
    EXPECT_EQ(again.parameters.weighs, weight);
    EXPECT_EQ(again.parameters.springy, springs);
    Parameters p = again.parameters;
    for (const SettingChange& change : again.changes) {
      apply_change(p, change);
      if (change.row == 50) {
        EXPECT_EQ(p.weighs, weight);
      }
    }
    EXPECT_EQ(p.springy, !springs);
    EXPECT_EQ(p.weighs, !weight);
    EXPECT_EQ(p.holds_springs, p.springy);
    EXPECT_EQ(p.holds_weight, p.weighs);
  }
}

// Limpid 0.2 recorded a key that chose among constants of its filter of encoder steps.
TEST(Replay, SaysWhereAFormerFilterMadeTheRows) {
  const test::TempDir dir;
  RunPlan plan = test::plan("table.toml", "touch.csv", 0.05);
  plan.parameters.kind = CouplingKind::predictive;
  Session session = recorded(plan, dir / "a.h5");
  const auto says = [&](double step, const std::string& own) {
    Parameters p = plan.parameters;
    p.encoder_step = step;
    const std::string table = "[predictor]\n";
    session.info.config = config_text(p);
    session.info.config.insert(session.info.config.find(table) + table.size(), own);
    const std::string note = replay(session, "a.h5", p).note;
    return note.find("filter") != std::string::npos;
  };
  EXPECT_TRUE(says(1e-4, "preset = \"auto\"\n"));
  EXPECT_FALSE(says(0, "preset = \"auto\"\n")) << "exact encoders";
  EXPECT_FALSE(says(1e-4, "preset = \"auto\"\np = 0.3\n")) << "a memory of its own";
  EXPECT_FALSE(says(1e-4, "")) << "recorded now";
  session.changes = {{20, "device.encoder_step = 1e-4"}, {30, "predictor.preset = \"fine\""}};
  EXPECT_TRUE(says(0, "preset = \"auto\"\n")) << "set while it ran";
}

TEST(Replay, TellsARecordingAllThatDecidesTheRun) {
  RunPlan plan = test::plan("dial.toml", "dial.csv", 0.1);
  plan.parameters.tick = 0.002;
  plan.parameters.eta = 0.25;
  plan.seed = 99;
  plan.hand.source = "whose hand";
  Lane& twin = plan.beside.emplace_back();
  twin.parameters.kind = CouplingKind::tank;
  const SessionInfo info = session_info(plan);
  EXPECT_EQ(info.tick, 0.002);
  EXPECT_EQ(info.dof, 3);
  EXPECT_EQ(info.app_version, program_version());
  EXPECT_EQ(info.build, program_build());
  EXPECT_EQ(info.seed, 99u);
  EXPECT_EQ(info.source, "whose hand");
  EXPECT_EQ(info.device_urdf, plan.arm.urdf);
  EXPECT_EQ(info.scene, plan.document.toml);
  EXPECT_EQ(info.models.size(), plan.document.models.size());
  ASSERT_TRUE(info.arm);
  EXPECT_EQ(info.arm->name, plan.arm.name);
  std::vector<std::string> bodies;
  for (const Object& object : plan.document.scene.objects) {
    if (object.body) bodies.push_back(object.name);
  }
  EXPECT_FALSE(bodies.empty());
  EXPECT_EQ(info.bodies, bodies);
  Parameters read;
  apply_config_text(read, info.config, "config");
  EXPECT_EQ(read, plan.parameters);
  ASSERT_EQ(info.beside.size(), 1u);
  Parameters beside;
  apply_config_text(beside, info.beside[0], "config");
  EXPECT_EQ(beside, twin.parameters);
}

// A lane may start with bodies of its own, or as the first one does.
TEST(Replay, TellsTheStartOfEachLane) {
  const test::TempDir dir;
  RunPlan plan = test::plan("table.toml", "touch.csv", 0.1);
  plan.start = rest_at(plan.arm, plan.hand.at(0));
  plan.start->world = {1, 2, 3};
  plan.beside.resize(2);
  plan.beside[1].start = plan.start;
  plan.beside[1].start->world = {4};
  SessionInfo info = session_info(plan);
  info.bodies = {"die"};
  Recorder recorder(dir / "a.h5", info, plan.settings(), false);
  tell_start(recorder, plan);
  ASSERT_TRUE(recorder.push(std::vector<double>(recorder.stride(), 0.0)));
  recorder.finish();
  const Session session = read_session(dir / "a.h5");
  EXPECT_EQ(session.world, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(session.lane(1).world, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(session.lane(2).world, (std::vector<double>{4}));
}

}  // namespace
}  // namespace limpid
