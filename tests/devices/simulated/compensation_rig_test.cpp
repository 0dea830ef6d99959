// The loop around devices that have weight, springs and friction of their own.
#include <gtest/gtest.h>

#include <cmath>

#include "core/dynamics/arm.h"
#include "core/dynamics/inverse_kinematics.h"
#include "core/math/eigen.h"
#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/fake_device.h"
#include "tests/support/rows.h"
#include "tests/support/wisher.h"

namespace limpid {
namespace {

using test::Rows;

const Vec3 kHeldAt(0.19, 0, 0);

ArmDescription sprung() {
  ArmDescription arm = test::omni();
  for (Joint& joint : arm.joints) {
    joint.spring = 0.1;
    joint.offset = 0.02;
  }
  return arm;
}

Parameters of(CouplingKind kind) {
  Parameters p;
  p.kind = kind;
  return p;
}

// Rows of a second and a half in a hand that moves to and fro and may let go in the middle.
Rows moved(const ArmDescription& arm, const Parameters& p, double amplitude, double grip = 1) {
  Rig rig(arm, Scene{});
  rig.start(p, rest_at(arm, kHeldAt));
  Rows rows(rig.layout());
  for (int k = 0; k < 1500; ++k) {
    const double t = k * p.tick, swing = amplitude * (1 - std::cos(6 * t));
    rig.step(p, {{kHeldAt + Vec3(0.3 * swing, swing, -0.5 * swing), grip}}, rows.add());
  }
  return rows;
}

double farthest(const Rows& a, const Rows& b, Column c) {
  double most = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    most = std::max(most, (a.vec(k, c) - b.vec(k, c)).cwiseAbs().maxCoeff());
  }
  return most;
}

class CompensatedRig : public testing::TestWithParam<CouplingKind> {};
INSTANTIATE_TEST_SUITE_P(Laws, CompensatedRig,
                         testing::Values(CouplingKind::standard, CouplingKind::proposed,
                                         CouplingKind::predictive));

TEST_P(CompensatedRig, HoldsAnArmThatWouldFall) {
  Parameters p = of(GetParam());
  p.weighs = p.springy = true;
  const ArmDescription arm = sprung();
  const Rows fallen = moved(arm, p, 0, 0);
  p.holds_weight = p.holds_springs = true;
  const Rows held = moved(arm, p, 0, 0);
  const auto away = [&](const Rows& rows) {
    return (rows.vec(1499, Column::device_position) - rows.vec(0, Column::device_position)).norm();
  };
  EXPECT_GT(away(fallen), 0.3);
  EXPECT_LT(away(held), 0.01);
  // The motors bear just these loads; the law has nothing to do.
  const Arm<kAnyDof> any(arm);
  Arm<kAnyDof>::Frames f;
  const Vec<kAnyDof> x = held.vec(1499, Column::device_position);
  any.frames(x, f);
  Eigen::VectorXd loads = any.weight(f, Vec3(0, 0, -9.81)) + 0.1 * x;
  loads.array() += 0.02;
  EXPECT_LT((held.vec(1499, Column::motor_torque) - loads).norm(), 2e-3 * loads.norm());
}

// In a hand the arm moves, and is felt, like an arm without weight and springs.
TEST_P(CompensatedRig, MovesAsAnArmWithoutWeightAndSprings) {
  const ArmDescription arm = sprung();
  Parameters p = of(GetParam());
  const Rows plain = moved(arm, p, 0.02);
  p.weighs = p.springy = p.holds_weight = p.holds_springs = true;
  const Rows held = moved(arm, p, 0.02);
  EXPECT_LT(farthest(held, plain, Column::device_position), 1e-3);
  EXPECT_LT(farthest(held, plain, Column::hand_torque_estimate), 5e-3);
  p.holds_weight = p.holds_springs = false;
  EXPECT_GT(farthest(moved(arm, p, 0.02), plain, Column::hand_torque_estimate), 0.05)
      << "that it is there, and would be taken for the hand";
}

TEST_P(CompensatedRig, TakesFrictionOffTheHandAndGivesLessThanItTakes) {
  const ArmDescription arm = test::omni();
  Parameters p = of(GetParam());
  p.friction = 0.03;
  const Rows with = moved(arm, p, 0.02);
  p.friction_share = 0.7;
  const Rows without = moved(arm, p, 0.02);
  const auto effort = [](const Rows& rows) {
    double sum = 0;
    for (std::size_t k = 200; k < rows.size(); ++k) {
      sum += rows.vec(k, Column::hand_torque).squaredNorm();
    }
    return std::sqrt(sum);
  };
  EXPECT_LT(effort(without), 0.6 * effort(with));
  // E_c less the compensation's part is that of a coupling without friction.
  double path = 0;
  for (std::size_t k = 1; k < without.size(); ++k) {
    path += (without.vec(k, Column::device_position) - without.vec(k - 1, Column::device_position))
                .cwiseAbs()
                .sum();
  }
  const double given = without.at(without.size() - 1, Column::energy_compensation);
  EXPECT_GT(given, 0.4 * 0.7 * 0.03 * path) << "it does help";
  EXPECT_LT(given, 0.7 * 0.03 * path) << "and stays below what friction takes";
  EXPECT_LE(without.at(without.size() - 1, Column::energy_total) - given, 1e-4);
}

TEST(Compensated, LeavesEveryLoopWithoutItAsItWas) {
  const ArmDescription arm = test::omni();
  for (const Rows& rows : {moved(arm, {}, 0.02)}) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      ASSERT_TRUE(rows.vec(k, Column::compensation_torque).isZero(0));
      ASSERT_EQ(rows.vec(k, Column::motor_torque), rows.vec(k, Column::commanded_torque));
    }
    EXPECT_EQ(rows.at(rows.size() - 1, Column::energy_compensation), 0);
  }
}

// A recording begins in the middle of a motion, and again from its first row.
TEST(Compensated, GoesOnFromARecordingsFirstRowBitForBit) {
  const ArmDescription arm = sprung();
  Parameters p;
  p.weighs = p.springy = p.holds_weight = p.holds_springs = true;
  p.friction = 0.02;
  p.friction_share = 0.7;
  Rig rig(arm, Scene{});
  rig.start(p, rest_at(arm, kHeldAt));
  Rows thrown(rig.layout()), recorded(rig.layout()), again(rig.layout());
  const auto hand = [](int k) {
    return RigInput{{kHeldAt + Vec3(0, 0.02 * std::sin(8e-3 * k), 0.01), 1}};
  };
  for (int k = 0; k < 300; ++k) rig.step(p, hand(k), thrown.add());
  RigStart scratch = rest_at(arm, kHeldAt);
  rig.restart_here(p, scratch, hand(299).hand.target);
  for (int k = 300; k < 800; ++k) rig.step(p, hand(k), recorded.add());
  Rig other(arm, Scene{});
  RigStart start = start_of(other.layout(), recorded.row(0));
  start.target = hand(299).hand.target;
  other.start(p, start);
  for (int k = 300; k < 800; ++k) other.step(p, hand(k), again.add());
  EXPECT_EQ(test::first_difference(recorded, again), -1);
}

// A guarded device that stands still, played by the test; the motors hold its arm.
struct HeldDevice : testing::Test {
  HeldDevice() : rig(arm, Scene{}, nullptr), rows(rig.layout()) {
    p.holds_weight = true;
    for (Eigen::Index i = 0; i < 3; ++i) device.reading.x[static_cast<std::size_t>(i)] = x0[i];
    rig.start(p, {x0, x0 * 0, x0, x0 * 0, x0 * 0, Vec3::Zero(), false});
    rig.plug(&device);
    Arm<3> own(arm);
    Arm<3>::Frames f;
    own.frames(x0, f);
    weight = own.weight(f, arm.gravity);
  }
  void step(int ticks = 1) {
    for (int i = 0; i < ticks; ++i) {
      ++device.reading.count;
      // A reading trembles in its last bit, as in a real hand: a constant one gets no force.
      if (std::isfinite(device.reading.x[0])) {
        device.reading.x[0] = x0[0] + (device.reading.count % 2 == 0 ? 1e-13 : 0);
      }
      input.hand = {rig.tip(), 1};
      input.force = wisher.at(armed);
      rig.step(p, input, rows.add());
    }
  }
  Eigen::Vector3d told() const { return {device.told[0], device.told[1], device.told[2]}; }
  void hold() {
    armed = true;
    step(700);
    ASSERT_LT((told() - weight).norm(), 1e-9) << told().transpose() << " of " << weight.transpose();
  }
  void expect_nothing_and_stays_so() {
    step();
    EXPECT_TRUE(told().isZero(0));
    step(1000);
    EXPECT_TRUE(told().isZero(0));
  }

  // An arm heavier than the built-in one, and out of balance.
  static ArmDescription heavy() {
    ArmDescription arm = test::omni();
    for (Link& link : arm.links) {
      link.mass *= 3;
      link.com += Vec3(0.04, 0, 0);
    }
    return arm;
  }

  const ArmDescription arm = heavy();
  const Eigen::Vector3d x0 = rest_pose(arm);
  Eigen::Vector3d weight;
  Parameters p;
  test::FakeDevice device{3};
  bool armed = false;
  test::Wisher wisher;
  RigInput input;
  Rig rig;
  Rows rows;
};

TEST_F(HeldDevice, IsHeldOnlyOnceForceIsArmedAndFadesIn) {
  step(300);
  EXPECT_TRUE(told().isZero(0));
  armed = true;
  for (int k = 1; k <= 500; ++k) {
    step();
    ASSERT_LE(told().norm(), weight.norm() * (k + 0.1) / 500);
  }
  EXPECT_GT(weight.norm(), 0.05) << "there is something to hold";
  hold();
}

TEST_F(HeldDevice, IsWithoutTorqueAtOnceWhenForceIsCut) {
  hold();
  armed = false;
  expect_nothing_and_stays_so();
}

TEST_F(HeldDevice, IsWithoutTorqueAtOnceWhenTheDeviceSaysNothingOrNonsense) {
  for (const int what : {0, 1, 2, 3}) {
    armed = false;
    step();
    hold();
    const DeviceReading well = device.reading;
    if (what == 0) device.reading.age = 0.006;
    if (what == 1) device.reading.x[1] = std::nan("");
    if (what == 2) device.reading.fault = true;
    if (what == 3) device.here = false;
    step();
    EXPECT_TRUE(told().isZero(0) || what == 3) << what;
    EXPECT_TRUE(rows.vec(rows.size() - 1, Column::motor_torque).isZero(0)) << what;
    device.reading = well;
    device.here = true;
    step(1000);
    EXPECT_TRUE(told().isZero(0)) << "until it is armed again: " << what;
  }
}

TEST_F(HeldDevice, FadesWithTheForceWhenNobodyWatchesAndAfterAStall) {
  hold();
  input.silence = 0.3;
  step(100);
  EXPECT_NEAR(told().norm(), 0.5 * weight.norm(), 0.05 * weight.norm());
  input = {};
  step(1000);
  hold();
  input.dt = 0.02;
  input.periods = 20;
  step();
  EXPECT_LE(told().norm(), weight.norm() * 1.1 / 500);
  input = {};
  for (int k = 1; k <= 500; ++k) {
    step();
    ASSERT_LE(told().norm(), weight.norm() * (k + 1.1) / 500);
  }
}

TEST_F(HeldDevice, StaysWithinLimitsWithTheLawsTorqueAddedUp) {
  p.torque_limit = 0.6 * weight.cwiseAbs().maxCoeff();
  armed = true;
  step(700);
  EXPECT_LE(told().cwiseAbs().maxCoeff(), p.torque_limit * (1 + 1e-12));
  EXPECT_NEAR(told().cwiseAbs().maxCoeff(), p.torque_limit, 1e-9) << "all that there is";
  p.torque_limit = kFromArm;
  SafetyLimits limits;
  limits.tip_force = 0.3;
  rig.limit(limits);
  step(700);
  Arm<3> own(arm);
  Arm<3>::Frames f;
  own.frames(x0, f);
  Jacobian<3> J;
  own.point_jacobian(f, 2, own.tip(f), J);
  const Vec3 force = least_squares(J.transpose(), told());
  EXPECT_LT(force.norm(), 0.3 * 1.01);
}

TEST_F(HeldDevice, TakesNoFrictionOffThatWasOnlySetForTheVirtualArm) {
  p.holds_weight = false;
  p.friction = 0.1;
  p.friction_share = 0.7;
  armed = true;
  step(600);
  for (int k = 0; k < 100; ++k) {
    device.reading.x[0] += 0.002;
    step();
    ASSERT_TRUE(rows.vec(rows.size() - 1, Column::compensation_torque).isZero(0));
  }
}

TEST_F(HeldDevice, SlewsWhereItIsSwitchedOnUnderForce) {
  p.holds_weight = false;
  armed = true;
  step(700);
  EXPECT_TRUE(told().isZero(1e-9));
  p.holds_weight = true;
  Eigen::Vector3d before = told();
  for (int k = 0; k < 600; ++k) {
    step();
    ASSERT_LE((told() - before).norm(), 1.01 * weight.norm() * 1e-3 / 0.5);
    before = told();
  }
  EXPECT_LT((told() - weight).norm(), 1e-9);
}

}  // namespace
}  // namespace limpid
