// Motors that warm up under a hand that presses: what they give, and what the laws promise.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/coupling/laws.h"
#include "core/tick/motor_warmth.h"
#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/fake_device.h"
#include "tests/support/rows.h"
#include "tests/support/table.h"

namespace limpid {
namespace {

using test::kTable;

constexpr double kTime = 2;          // of the motors [s]
constexpr double kBears = 0.25;      // part of their torque, for hours
constexpr double kStiffWall = 2000;  // [N/m]

ArmDescription warming(double time = kTime) {
  ArmDescription arm = test::omni();
  for (Joint& joint : arm.joints) {
    joint.continuous = kBears * joint.effort;
    joint.warming = time;
  }
  return arm;
}

Scene stiff_wall() { return test::table({kStiffWall}); }

struct WarmPress {
  explicit WarmPress(CouplingKind kind, const ArmDescription& described = warming())
      : arm(described), rig(arm, stiff_wall()), rows(rig.layout()) {
    p.kind = kind;
    p.hand_stiffness = 300;
    p.hand_damping = 2;
    rig.start(p, rest_at(arm, kTable + Vec3(0, 0, 0.005)));
  }
  Vec3 target(double depth) const { return kTable + Vec3(0, 2e-5 * std::sin(0.1 * k), -depth); }
  // Presses so deep, got there at 0.2 m/s.
  void press(double depth, double seconds) {
    for (int i = 0; i < seconds * 1e3; ++i, ++k) {
      now += std::clamp(depth - now, -2e-4, 2e-4);
      rig.step(p, {{target(now), 1}}, rows.add());
    }
  }
  // Largest excess of a motor's torque over what its warmth leaves it [N m].
  double excess() const {
    double most = -1;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Eigen::VectorXd tau = rows.vec(i, Column::motor_torque);
      const Eigen::VectorXd warmth = rows.vec(i, Column::motor_warmth);
      for (Eigen::Index j = 0; j < tau.size(); ++j) {
        const Joint& joint = arm.joints[static_cast<std::size_t>(j)];
        const double limit = warm_limit(joint.effort, joint.continuous, warmth[j]);
        most = std::max(most, std::abs(tau[j]) - limit);
      }
    }
    return most;
  }
  double most(Column c) const {
    double most = -1e9;
    for (std::size_t i = 0; i < rows.size(); ++i) most = std::max(most, rows.vec(i, c).maxCoeff());
    return most;
  }
  double least(Column c, std::size_t from) const {
    double least = 1e9;
    for (std::size_t i = from; i < rows.size(); ++i) least = std::min(least, rows.at(i, c));
    return least;
  }
  // Largest part that a motor gives of its peak at the end.
  double part() const {
    const Eigen::VectorXd tau = rows.vec(rows.size() - 1, Column::motor_torque);
    double part = 0;
    for (Eigen::Index j = 0; j < tau.size(); ++j) {
      part = std::max(part, std::abs(tau[j]) / arm.joints[static_cast<std::size_t>(j)].effort);
    }
    return part;
  }

  const ArmDescription arm;
  Parameters p;
  Rig rig;
  test::Rows rows;
  int k = 0;
  double now = 0;  // depth of the hand's target [m]
};

constexpr double kHard = 0.03,
                 kSoft = 0.002;  // depths of the hand [m]: about 8 N and half a newton

TEST(WarmMotors, GiveWhatTheyBearForHoursUnderAHandThatPressesOn) {
  for (const CouplingKind kind : {CouplingKind::predictive, CouplingKind::proposed,
                                  CouplingKind::standard, CouplingKind::tank}) {
    SCOPED_TRACE(name(kind));
    WarmPress run(kind);
    run.press(kHard, 0.2);
    EXPECT_GT(run.part(), 0.45) << "cold motors give what is asked of them";
    run.press(kHard, 6 * kTime);
    EXPECT_NEAR(run.part(), kBears, 0.01);
    EXPECT_LE(run.excess(), 1e-12);
    EXPECT_LE(run.most(Column::motor_warmth), 1);
    EXPECT_GT(run.most(Column::motor_warmth), 0.98);
  }
}

// The promises are those of core/README.md for motors at their limit; this one falls and rises.
TEST(WarmMotors, AreKnownToTheLawWhichGivesNoEnergyAndRunsIntoNoDebt) {
  for (const double eta : {1.0, 0.3}) {
    SCOPED_TRACE(eta);
    WarmPress run(CouplingKind::predictive);
    run.p.eta = eta;
    run.press(kHard, 4 * kTime);
    run.press(kSoft, 4 * kTime);
    run.press(kHard, 2 * kTime);
    run.press(-0.02, 1);
    EXPECT_LE(run.most(Column::energy_total), 0.05e-3);
    EXPECT_LE(run.most(Column::energy_port), 0.05e-3);
    EXPECT_GT(run.least(Column::energy_ledger, 2), 1e-3);
    EXPECT_GT(run.least(Column::governor, 2), 0.99) << "the wall is as stiff as it is set to";
    EXPECT_EQ(run.rows.at(run.rows.size() - 1, Column::unsettled), 0);
    EXPECT_LE(run.excess(), 1e-12);
  }
}

TEST(WarmMotors, LeaveRowsOfAnArmWithoutAModelAsTheyAre) {
  WarmPress plain(CouplingKind::predictive, test::omni());
  WarmPress slow(CouplingKind::predictive, warming(1e5));  // warms up, and is not limited yet
  plain.press(kHard, 0.5);
  slow.press(kHard, 0.5);
  EXPECT_EQ(plain.most(Column::motor_warmth), 0);
  const double warmth = slow.most(Column::motor_warmth);
  EXPECT_GT(warmth, 0);
  EXPECT_LT(warmth, kWarmFrom);
  for (std::size_t i = 0; i < plain.rows.size(); ++i) {
    for (const Column c : {Column::device_position, Column::motor_torque, Column::proxy_position}) {
      ASSERT_EQ(plain.rows.vec(i, c), slow.rows.vec(i, c)) << i;
    }
  }
}

// A recording that begins while they are warm: its first row has all that a re-run needs.
TEST(WarmMotors, AreAsWarmInARerunFromTheMiddle) {
  WarmPress run(CouplingKind::predictive);
  run.press(kHard, kTime);
  ASSERT_TRUE(run.rig.steady());
  RigStart scratch;
  run.rig.present(scratch);
  const Vec3 target = run.target(run.now);
  run.rig.restart_here(run.p, scratch, target);
  test::Rows recorded(run.rig.layout()), again(run.rig.layout());
  const auto input = [&](int k) {
    return RigInput{{kTable - Vec3(0, 0, kHard * (1 + 0.1 * std::sin(0.01 * k))), 1}};
  };
  for (int k = 0; k < 2000; ++k) run.rig.step(run.p, input(k), recorded.add());
  Rig other(run.arm, stiff_wall());
  RigStart start = start_of(other.layout(), recorded.row(0));
  start.target = target;
  other.start(run.p, start);
  for (int k = 0; k < 2000; ++k) other.step(run.p, input(k), again.add());
  EXPECT_GT(recorded.at(0, Column::motor_warmth) + recorded.vec(0, Column::motor_warmth)[1],
            kWarmFrom);
  EXPECT_EQ(test::first_difference(recorded, again), -1);
}

// A device that the test plays, held 0.3 rad inside a stop of its first joint.
struct WarmDevice : testing::Test {
  WarmDevice() : rig(arm, stop(), nullptr), rows(rig.layout()) {
    for (Eigen::Index i = 0; i < 3; ++i) device.reading.x[static_cast<std::size_t>(i)] = x0[i];
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(3);
    rig.start({}, {x0, zero, x0, zero, zero, Vec3::Zero(), false});
    rig.plug(&device);
  }
  Scene stop() const {
    Scene scene;
    scene.add({.name = "stop", .shape = JointStop{0, x0[0] - 0.3, 1}, .material = {200}});
    return scene;
  }
  void step(int ticks, double dt = 1e-3) {
    for (int i = 0; i < ticks; ++i) {
      ++device.reading.count;
      device.reading.x[2] = x0[2] + (device.reading.count % 2 == 0 ? 1e-9 : 0);
      const ForceRequest wish =
          std::exchange(arms, false) ? ForceRequest::arm : ForceRequest::as_it_is;
      rig.step({}, {.hand = {rig.tip(), 1}, .force = wish, .dt = dt}, rows.add());
    }
  }
  double warmth() const { return rows.vec(rows.size() - 1, Column::motor_warmth)[0]; }

  static constexpr double kSlow = 20;  // time constant of its motors [s]
  const ArmDescription arm = warming(kSlow);
  const Eigen::VectorXd x0 = rest_pose(arm);
  test::FakeDevice device{3};
  bool arms = true;
  Rig rig;
  test::Rows rows;
};

TEST_F(WarmDevice, HoldsARealDevicesForceBack) {
  const double effort = arm.joints[0].effort;
  step(700);
  EXPECT_GT(std::abs(device.told[0]), 0.9 * effort);
  step(12'000);
  EXPECT_NEAR(std::abs(device.told[0]), kBears * effort, 0.01 * effort);
}

TEST_F(WarmDevice, CountsAPauseOfTheLoopAsTimeWithoutTorque) {
  step(1500);
  const double before = warmth();
  ASSERT_GT(before, 0.3);
  step(1, 1.0);
  const double heated = std::pow(1 / kBears, 2) * 0.01 / kSlow;
  EXPECT_LE(warmth(), (before + heated) * std::exp(-0.99 / kSlow) + 1e-9);
  EXPECT_GE(warmth(), before * std::exp(-1 / kSlow));
}

TEST_F(WarmDevice, IsNotForgottenWhenItStartsOverOrComesBack) {
  step(1500);
  const double before = warmth();
  RigStart start;
  rig.present(start);
  rig.start({}, start);
  step(1);
  EXPECT_NEAR(warmth(), before, 1e-2);
  device.here = false;
  step(100);
  rig.plug(nullptr);
  step(100);
  rig.plug(&device);
  device.here = true;
  step(1);
  EXPECT_NEAR(warmth(), before * std::exp(-0.2 / kSlow), 1e-2);
}

TEST_F(WarmDevice, IsAsWarmAsItSaysItself) {
  step(700);
  const double cold = std::abs(device.told[0]);
  device.reading.warmth = 1;
  step(50);
  EXPECT_EQ(warmth(), 1);
  EXPECT_NEAR(std::abs(device.told[0]), kBears * arm.joints[0].effort, 1e-9);
  EXPECT_LT(std::abs(device.told[0]), 0.6 * cold);
  device.reading.warmth = 0;
  step(50);
  EXPECT_GT(std::abs(device.told[0]), 0.6 * cold);
}

TEST_F(WarmDevice, HasTheOrientationOfItsToolInTheRow) {
  const auto orientation = [&] { return rows.vec(rows.size() - 1, Column::tool_orientation); };
  step(1);
  EXPECT_TRUE(orientation().array().isNaN().all());
  device.reading.orientation = {0.5, -0.5, 0.5, -0.5};
  step(1);
  EXPECT_EQ(orientation(), Eigen::Vector4d(0.5, -0.5, 0.5, -0.5));
  device.here = false;
  step(1);
  EXPECT_TRUE(orientation().array().isNaN().all()) << "nobody knows it";
}

}  // namespace
}  // namespace limpid
