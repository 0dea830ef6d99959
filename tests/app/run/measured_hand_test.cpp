// A measured hand: from a run, from its recording, and from the recording's re-run.
#include "app/run/measured_hand.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "app/run/replay.h"
#include "core/coupling/eta_min.h"
#include "core/dynamics/inverse_kinematics.h"
#include "tests/app/run/recorded.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

using test::rows_of;

// A hand that holds still in the middle of the table's scene, away from the table.
RunPlan still() {
  RunPlan plan = test::plan("table.toml", "touch.csv", 10.2);
  plan.hand = hand_through({0, 11}, {Vec3(0.19, 0, 0), Vec3(0.19, 0, 0)}, "test");
  plan.parameters.hand_stiffness = 640;
  plan.parameters.hand_damping = 2.7;
  plan.parameters.hand_mass_at_tip = 0.08;
  return plan;
}

Grip grip_of(const test::Rows& rows, const RunPlan& plan) {
  GripRecord record(rows.layout(), plan.parameters.tick);
  for (std::size_t k = 0; k < rows.size(); ++k) record.take(rows.row(k));
  return find_grip(plan.arm, plan.parameters, record);
}

TEST(MeasuredHand, IsTheSameFromARunItsRecordingAndItsReRun) {
  const test::TempDir dir;
  RunPlan plan = still();
  ASSERT_TRUE(measure_grip(plan));
  const test::Rows rows = rows_of(plan);
  const Grip grip = grip_of(rows, plan);
  ASSERT_TRUE(grip.known()) << grip.unknown;
  EXPECT_NEAR(grip.stiffness.value, 640, 0.02 * 640);
  EXPECT_NEAR(grip.damping.value, 2.7, 0.02 * 2.7);
  EXPECT_NEAR(grip.mass.value, 0.08, 0.02 * 0.08);
  const Session session = test::recorded(plan, dir / "a.h5");
  EXPECT_EQ(recorded_grip(session, "a.h5").stiffness.value, grip.stiffness.value);
  const RunPlan again = replay(session, "a.h5", session_parameters(session, "a.h5"));
  EXPECT_EQ(test::first_difference(rows, rows_of(again)), -1);
}

TEST(MeasuredHand, IsNotThereWhereNobodyMeasured) {
  const test::TempDir dir;
  RunPlan plan = still();
  plan.rows = 100;
  EXPECT_FALSE(measure_grip(plan)) << "too short";
  EXPECT_TRUE(plan.excitation.empty());
  const Session session = test::recorded(plan, dir / "a.h5");
  const Grip grip = recorded_grip(session, "a.h5");
  EXPECT_EQ(unknown_text(grip), "not known: the grip was not measured");
  EXPECT_FALSE(judged(plan.arm, plan.parameters, plan.document.scene, grip).hands);
}

// The laws that compensate the device's own forces see the excitation as a push of the hand: none
// of it counts as given by the law.
TEST(MeasuredHand, IsGivenTheExcitationsWorkBesideTheLawsOwn) {
  RunPlan plan = still();
  plan.parameters.kind = CouplingKind::predictive;
  ASSERT_TRUE(measure_grip(plan));
  const test::Rows rows = rows_of(plan);
  const std::size_t last = rows.size() - 1;
  double work = 0;
  for (std::size_t k = 0; k < last; ++k) {
    const Eigen::VectorXd dx =
        rows.vec(k + 1, Column::device_position) - rows.vec(k, Column::device_position);
    work += rows.vec(k, Column::compensation_torque).dot(dx);
  }
  EXPECT_NEAR(rows.at(last, Column::energy_compensation), work, 1e-12);
  EXPECT_NEAR(grip_of(rows, plan).work, work, 0.2 * work) << "without the first second";
  EXPECT_GT(work, 5e-3);
  EXPECT_GT(rows.at(last, Column::energy_ledger), 0.9 * rows.at(100, Column::energy_ledger));
}

TEST(MeasuredHand, GivesEtaMinAndWallsOfItsValuesAndWithinItsBounds) {
  RunPlan plan = still();
  Grip grip;
  grip.measured = true;
  grip.stiffness = {640, 60};
  grip.damping = {0.3, 0.04};
  grip.mass = {0.02, 0.002};
  grip.pose = *inverse_kinematics(plan.arm, Vec3(0.19, 0, 0), rest_pose(plan.arm));
  const MeasuredHand hand = judged(plan.arm, plan.parameters, plan.document.scene, grip);
  ASSERT_TRUE(hand.eta_min && hand.hands);
  const auto eta_at = [&](double stiffness, double damping) {
    Parameters p = plan.parameters;
    p.hand_stiffness = stiffness;
    p.hand_damping = damping;
    return analyze(plan.arm, grip.pose, p, std::nullopt).eta_min_compliant;
  };
  EXPECT_EQ(hand.eta_min->value, eta_at(640, 0.3));
  EXPECT_EQ(hand.eta_min->high, eta_at(700, 0.26)) << "the stiffest hand that damps least";
  EXPECT_EQ(hand.eta_min->low, eta_at(580, 0.34));
  EXPECT_LT(hand.eta_min->low, hand.eta_min->value);
  EXPECT_EQ(hand.hands->range.from, 580);
  EXPECT_EQ(hand.hands->range.to, 700);
  EXPECT_EQ(hand.hands->damping, 0.26);
  const Parameters taken = with_grip(plan.parameters, grip);
  EXPECT_EQ(taken.hand_stiffness, 640);
  EXPECT_EQ(taken.hand_damping, 0.3);
  EXPECT_EQ(taken.hand_mass_at_tip, 0.02);
}

TEST(MeasuredHand, IsWrittenWithTwoDigitsOfItsBound) {
  MeasuredHand hand;
  hand.eta_min = {0.742, 0.701, 0.778};
  EXPECT_EQ(grip_lines(hand).back().value, "0.74 (0.70 to 0.78)");
  hand.eta_min = {1e-6, 0, 2e-4};
  EXPECT_EQ(grip_lines(hand).back().value, "0, every eta is stable");
  EXPECT_EQ(bounded_text({312.4, 12.3}, "N/m"), "312 \xC2\xB1 12 N/m");
  EXPECT_EQ(bounded_text({3.14159, 0.0123}, "N s/m"), "3.142 \xC2\xB1 0.012 N s/m");
  EXPECT_EQ(bounded_text({3, 0}, "g"), "3 \xC2\xB1 0 g");
}

}  // namespace
}  // namespace limpid
