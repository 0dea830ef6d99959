#include "app/run/simulate.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <stdexcept>

#include "core/dynamics/arm.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

using test::first_difference;
using test::plan;
using test::Rows;
using test::rows_of;

TEST(Simulate, RunsEveryRowOfThePlan) {
  const RunPlan p = plan("table.toml", "touch.csv", 1.5);
  std::uint64_t count = 0;
  const RunEnd end = simulate(p, {}, [&](std::span<const double> row, LaneChanges changed) {
    const RowLayout layout(3);
    EXPECT_EQ(row.size(), static_cast<std::size_t>(layout.stride()));
    EXPECT_EQ(layout.in(row, Column::time)[0], static_cast<double>(count) * p.parameters.tick);
    EXPECT_EQ(changed[0], nullptr);
    ++count;
    return true;
  });
  EXPECT_EQ(count, 1500u);
  EXPECT_EQ(end.rows, 1500u);
  EXPECT_FALSE(end.stopped);
  EXPECT_FALSE(end.diverged);
}

TEST(Simulate, StartsAtRestWithTheTipOnTheHandsFirstPoint) {
  const RunPlan p = plan("table.toml", "touch.csv", 0.01);
  const Rows rows = rows_of(p);
  const Arm<kAnyDof> arm(p.arm);
  Arm<kAnyDof>::Frames f;
  arm.frames(rows.vec(0, Column::device_position), f);
  EXPECT_LT((arm.tip(f) - p.hand.at(0)).norm(), 1e-6);
  EXPECT_EQ(rows.vec(0, Column::device_velocity).norm(), 0);
  EXPECT_EQ(rows.vec(0, Column::device_position), rows.vec(0, Column::proxy_position));
}

TEST(Simulate, GivesTheSameBitsTwice) {
  const RunPlan p = plan("obstacles.toml", "touch.csv", 3);
  EXPECT_EQ(first_difference(rows_of(p), rows_of(p)), -1);
}

TEST(Simulate, GivesTheSameBitsAtItsOwnPaceAndAsFastAsItGoes) {
  const RunPlan p = plan("table.toml", "touch.csv", 0.3);
  Rows paced(RowLayout(3));
  const RunEnd end = simulate(p, {.realtime = true}, [&](std::span<const double> row, LaneChanges) {
    paced.add(row);
    return true;
  });
  EXPECT_EQ(end.rows, 300u);
  EXPECT_EQ(first_difference(rows_of(p), paced), -1);
}

TEST(Simulate, StopsWhenItIsToldTo) {
  const RunPlan p = plan("table.toml", "touch.csv", 2);
  std::atomic<bool> stop = false;
  std::uint64_t count = 0;
  const RunEnd end = simulate(p, {.stop = &stop}, [&](std::span<const double>, LaneChanges) {
    stop = ++count == 123;
    return true;
  });
  EXPECT_TRUE(end.stopped);
  EXPECT_EQ(end.rows, 123u);
}

TEST(Simulate, StopsWhenItsSinkHasEnough) {
  const RunPlan p = plan("table.toml", "touch.csv", 2);
  std::uint64_t count = 0;
  const RunEnd end =
      simulate(p, {}, [&](std::span<const double>, LaneChanges) { return ++count < 45; });
  EXPECT_TRUE(end.stopped);
  EXPECT_EQ(end.rows, 45u);
}

TEST(Simulate, MakesChangesAtTheirRowsAndSaysSo) {
  RunPlan p = plan("table.toml", "touch.csv", 0.5);
  p.changes = {{100, "coupling.eta = 2.5"},
               {100, "device.damping = 0.05"},
               {300, "coupling.kind = \"standard\""},
               {400, "device.damping = "}};
  std::uint64_t row_count = 0;
  std::vector<std::uint64_t> changed_at;
  Parameters last;
  simulate(p, {}, [&](std::span<const double> row, LaneChanges changed) {
    const RowLayout layout(3);
    if (changed[0] != nullptr) {
      changed_at.push_back(row_count);
      last = *changed[0];
    }
    EXPECT_EQ(layout.in(row, Column::eta)[0], row_count < 100 ? 1 : 2.5);
    EXPECT_EQ(layout.in(row, Column::kind)[0], row_count < 300 ? 1 : 0);
    ++row_count;
    return true;
  });
  EXPECT_EQ(changed_at, (std::vector<std::uint64_t>{100, 300, 400}));
  EXPECT_TRUE(std::isnan(last.damping));  // back to the arm's own value
  EXPECT_EQ(last.eta, 2.5);
}

TEST(Simulate, RefusesAHandOutOfReachAndAChangeThatIsNone) {
  const auto sink = [](std::span<const double>, LaneChanges) { return true; };
  RunPlan far = plan("table.toml", "touch.csv", 0.1);
  for (Vec3& point : far.hand.position) point += Vec3(2, 0, 0);
  EXPECT_THROW(simulate(far, {}, sink), std::invalid_argument);
  RunPlan wrong = plan("table.toml", "touch.csv", 0.1);
  wrong.changes = {{10, "coupling.eta = -3"}};
  EXPECT_THROW(simulate(wrong, {}, sink), ParameterError);
  wrong.changes = {{10, "coupling.zeta = 3"}};
  EXPECT_THROW(simulate(wrong, {}, sink), ParameterError);
}

TEST(Simulate, SaysWhenTheLoopIsUnstable) {
  RunPlan p = plan("free.toml", "free.csv", 8);
  p.parameters.k_vc = 1e4;
  p.parameters.tick = 0.01;
  p.parameters.torque_limit = 1e4;
  p.rows = 20000;
  const RunEnd end = simulate(p, {}, [](std::span<const double>, LaneChanges) { return true; });
  EXPECT_TRUE(end.diverged);
  EXPECT_LT(end.rows, 20000u);
}

// A run that no clock paces is never late; each tick takes some time.
TEST(Simulate, SaysHowLateAndHowLongEachTickWas) {
  double longest = 0;
  simulate(plan("table.toml", "touch.csv", 0.2), {}, [&](std::span<const double> row, LaneChanges) {
    EXPECT_EQ(RowLayout(3).in(row, Column::wake_latency)[0], 0);
    const double took = RowLayout(3).in(row, Column::compute)[0];
    EXPECT_GE(took, 0);
    longest = std::max(longest, took);
    return true;
  });
  EXPECT_GT(longest, 0);
  EXPECT_LT(longest, 10);
}

TEST(Simulate, ExcitesTheTipAsLongAsThePlanSays) {
  RunPlan p = plan("free.toml", "free.csv", 0.1);
  const Rows calm = rows_of(p);
  for (int k = 0; k < 50; ++k) p.excitation.emplace_back(0.01 * k, -0.1, 0.2);
  const Rows rows = rows_of(p);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Vec3 wanted = k < 50 ? Vec3(0.01 * static_cast<double>(k), -0.1, 0.2) : Vec3(0, 0, 0);
    ASSERT_EQ(Vec3(rows.vec(k, Column::excitation)), wanted) << k;
  }
  EXPECT_EQ(calm.vec(50, Column::excitation).norm(), 0);
  EXPECT_GT((rows.vec(50, Column::device_position) - calm.vec(50, Column::device_position)).norm(),
            1e-5);
}

// Force is wanted as the plan has it at each row, and from its end on as at its last one.
TEST(Simulate, ArmsAndCutsAtTheRowsOfThePlan) {
  RunPlan p = plan("free.toml", "free.csv", 0.4);
  for (int k = 0; k < 300; ++k) p.force.push_back(k < 100 || k >= 200);
  const Rows rows = rows_of(p);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    ASSERT_EQ(rows.at(k, Column::force_wanted), k >= 100 && k < 200 ? 0 : 1) << k;
  }
  p.force = {true, false};
  EXPECT_EQ(rows_of(p).at(399, Column::force_wanted), 0);
}

TEST(Simulate, FollowsTheHandsGrip) {
  RunPlan p = plan("free.toml", "free.csv", 0.2);
  p.hand = hand_through({0, 0.05, 0.2}, {Vec3(0.19, 0, 0), Vec3(0.2, 0, 0), Vec3(0.18, 0, 0)}, "x");
  p.hand.grip[1] = 0;
  const Rows rows = rows_of(p);
  for (const std::size_t k : {0, 10, 40, 60, 150}) {
    EXPECT_EQ(rows.at(k, Column::hand_grip), k < 50 ? 1 : 0) << k;
    EXPECT_LT((Vec3(rows.vec(k, Column::hand_target)) - p.hand.sample(k, 1e-3)).norm(), 1e-12) << k;
  }
}

TEST(Simulate, CountsTicksToTheNearestAndAtLeastOne) {
  EXPECT_EQ(ticks_in(1, 0.001), 1000u);
  EXPECT_EQ(ticks_in(0.0014, 0.001), 1u);
  EXPECT_EQ(ticks_in(0.0016, 0.001), 2u);
  EXPECT_EQ(ticks_in(0, 0.001), 1u);
}

TEST(Simulate, IgnoresSettingsOfOlderRecordingsAndRefusesKeysThatNeverWere) {
  Parameters p;
  apply_change(p, {0, "predictor.preset = \"fine\""});
  EXPECT_EQ(p, Parameters{});
  EXPECT_THROW(apply_change(p, {0, "coupling.zeta = "}), ParameterError);
  p.torque_limit = 3;
  apply_change(p, {0, "device.torque_limit = "});
  EXPECT_TRUE(std::isnan(p.torque_limit));
}

}  // namespace
}  // namespace limpid
