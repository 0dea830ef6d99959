#include "app/run/wall_tap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/run/tip_limits.h"
#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

Parameters predictive() {
  Parameters p;
  p.kind = CouplingKind::predictive;
  return p;
}

struct Tapped {
  TapPlace place;
  WallTap tap;
  RunPlan plan;
  std::vector<double> rows;
  double felt = 0, rattle = 0;
};

Tapped tap(const ArmDescription& arm, const Eigen::VectorXd& x, WallTap wanted,
           const Parameters& p) {
  Tapped t{tap_place(arm, x, p), wanted, {}, {}};
  t.tap.press = bearable_press(arm, t.place, p, wanted.press);
  t.plan = tap_plan(arm, t.place, t.tap, p);
  WallMeter meter = tap_meter(t.plan, t.tap);
  const RowLayout layout(arm.dof());
  simulate(t.plan, {}, [&](std::span<const double> row, LaneChanges) {
    t.rows.insert(t.rows.end(), row.begin(), row.end());
    meter.add(layout, row);
    return true;
  });
  t.felt = meter.felt();
  t.rattle = meter.rattle();
  return t;
}

TEST(WallTap, BeginsBeforeTheWallAndEndsPressedOnIt) {
  const ArmDescription arm = test::omni();
  const Tapped t = tap(arm, rest_pose(arm), {.wall = 1000, .press = 1}, predictive());
  EXPECT_NEAR(t.place.depth(t.plan.start->target), -WallTap::kAbove, 1e-6);
  const RowLayout layout(3);
  const auto last = std::span(t.rows).last(static_cast<std::size_t>(layout.stride()));
  const auto force = layout.in(last, Column::contact_force);
  EXPECT_NEAR(t.place.out.dot(Vec3(force[0], force[1], force[2])), t.tap.press, 0.1);
  EXPECT_NEAR(t.felt, 1, 0.02);
  EXPECT_LT(t.rattle, 0.01);
}

// Through the standard coupling's spring a wall has the compliance 1/K + lever^2/k_vc.
TEST(WallTap, FeelsAWallThroughASpringAsSoftAsItIs) {
  const ArmDescription arm = test::omni();
  Parameters p;
  p.kind = CouplingKind::standard;
  const Tapped t = tap(arm, rest_pose(arm), {.wall = 1000, .press = 1, .hold = 1.5}, p);
  const double spring =
      tip_limits(arm, rest_pose(arm), p, {}).walls[0].stiffness;  // k_vc over lever^2
  EXPECT_NEAR(t.felt, 1 / (1 + 1000 / spring), 0.03);
}

TEST(WallTap, AsksNoMoreOfTheMotorsThanTheyBearTwice) {
  const ArmDescription arm = weighing(test::random_arm(7, 3), 5);
  const TapPlace place = tap_place(arm, Eigen::VectorXd::Constant(7, 0.3), {});
  Parameters p;
  EXPECT_EQ(bearable_press(arm, place, p, 1e-3), 1e-3);
  p.torque_limit = 0.1;
  const double borne = bearable_press(arm, place, p, 100);
  EXPECT_LT(borne, 100);
  // Motors half as strong bear half of the force.
  p.torque_limit = 0.05;
  EXPECT_NEAR(bearable_press(arm, place, p, 100), borne / 2, 1e-12);
}

// The motor that has the most to do bears just twice the press. A motor that bears nothing allows
// for none, unless its joint is taken off the arm.
TEST(WallTap, AsksEachMotorThatIsThereForHalfOfWhatItBearsAtMost) {
  ArmDescription arm = test::random_arm(4, 3);
  const auto place = [&] { return tap_place(arm, Eigen::VectorXd::Constant(arm.dof(), 0.3), {}); };
  arm.joints.back().effort = 0;
  EXPECT_EQ(bearable_press(arm, place(), {}, 100), 0);
  arm.joints.pop_back();
  arm.links.pop_back();
  arm.frames.pop_back();
  const TapPlace of_three = place();
  const double press = bearable_press(arm, of_three, {}, 100);
  EXPECT_LT(press, 100);
  double most = 0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    // The way of the tip into the wall when this joint turns a little.
    constexpr double kTurn = 1e-5;  // [rad]
    const auto depth = [&](double turn) {
      Eigen::VectorXd x = of_three.x;
      x[i] += turn;
      return of_three.depth(Arm<kAnyDof>(arm).tip_at(x));
    };
    const double lever = std::abs(depth(kTurn) - depth(-kTurn)) / (2 * kTurn);  // [m]
    most = std::max(most, press * lever / arm.joints[static_cast<std::size_t>(i)].effort);
  }
  EXPECT_NEAR(most, 0.5, 1e-6);
}

TEST(WallTap, OfAnArmOfOneJointTurnsIt) {
  const ArmDescription arm = test::random_arm(1, 4);
  const Tapped t =
      tap(arm, Eigen::VectorXd::Constant(1, 0.2), {.wall = 300, .press = 1}, predictive());
  EXPECT_NEAR(t.felt, 1, 0.05);
}

// Without contact there is no stiffness, and no division by zero.
TEST(WallMeter, ThatSeesNoContactFindsNoWall) {
  const ArmDescription arm = test::omni();
  Tapped t = tap(arm, rest_pose(arm), {.wall = 1000, .press = 1}, predictive());
  WallMeter meter(arm, {"", pose_at(Vec3(0, 0, -5)), Plane{Vec3::UnitZ()}, {1000}}, 1e-3, 0);
  EXPECT_EQ(meter.felt(), 0);
  EXPECT_EQ(meter.rattle(), 0);
  meter.add(RowLayout(3), std::span(t.rows).first(static_cast<std::size_t>(RowLayout(3).stride())));
  EXPECT_EQ(meter.felt(), 0);
}

}  // namespace
}  // namespace limpid
