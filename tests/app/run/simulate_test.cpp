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

}  // namespace
}  // namespace limpid
