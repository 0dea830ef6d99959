// Trials of walls: what is held, what is not, and why.
#include "app/run/wall_trial.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "app/run/fitted_gains.h"
#include "app/run/tip_limits.h"
#include "app/run/wall_tap.h"
#include "core/dynamics/arm.h"
#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

Parameters of(CouplingKind kind) {
  Parameters p;
  p.kind = kind;
  return p;
}

TEST(WallTrial, HoldsTheWallThatIsNamedForTheIdealArm) {
  const ArmDescription arm = test::omni();
  const Parameters p = of(CouplingKind::predictive);
  const double named = tip_limits(arm, rest_pose(arm), p, {}).wall(p.kind).stiffness;
  const WallTrial trial = try_wall(arm, rest_pose(arm), p, named);
  EXPECT_EQ(trial.named, named);
  EXPECT_EQ(trial.held, named) << trial.fault;
  EXPECT_EQ(trial.fault, "");
}

TEST(WallTrial, HalvesAWallUntilItIsHeld) {
  const ArmDescription arm = test::omni();
  const Parameters p = of(CouplingKind::proposed);
  const double named = 64 * tip_limits(arm, rest_pose(arm), p, {}).wall(p.kind).stiffness;
  const WallTrial trial = try_wall(arm, rest_pose(arm), p, named);
  EXPECT_GT(trial.held, 0);
  EXPECT_LT(trial.held, named);
  EXPECT_EQ(std::exp2(std::round(std::log2(named / trial.held))), named / trial.held);
  EXPECT_NE(trial.fault.find("N/m in a grip of"), std::string::npos) << trial.fault;
}

// Through the spring k_vc a wall as stiff as that is felt half as stiff.
TEST(WallTrial, AsksASpringForNoStiffness) {
  const ArmDescription arm = test::omni();
  const Parameters p = of(CouplingKind::standard);
  const double spring = tip_limits(arm, rest_pose(arm), p, {}).wall(p.kind).stiffness;
  EXPECT_EQ(try_wall(arm, rest_pose(arm), p, spring).held, spring);
}

// A stiff wall on the device itself trembles: Colgate and Schenkel's bound is far below it.
TEST(WallTrial, SaysThatTheTipTrembles) {
  const ArmDescription arm = test::omni();
  Parameters p = of(CouplingKind::direct);
  p.hand_damping = 0;
  const TipLimits limits = tip_limits(arm, rest_pose(arm), p, {});
  const WallTrial trial = try_wall(arm, rest_pose(arm), p, 100 * limits.every_hand);
  EXPECT_LT(trial.held, 100 * limits.every_hand);
  EXPECT_TRUE(trial.fault.find("trembles") != std::string::npos ||
              trial.fault.find("unstable") != std::string::npos)
      << trial.fault;
}

TEST(WallTrial, PressesArmsThatMoveInALineOrAPlane) {
  for (const int joints : {1, 2}) {
    const ArmDescription arm = test::random_arm(joints, 5);
    const Parameters p = of(CouplingKind::standard);
    const WallTrial trial = try_wall(arm, rest_pose(arm), p, 1);
    EXPECT_EQ(trial.held, 1) << joints << " joints: " << trial.fault;
  }
}

// 5 N m of friction are 38 N at the tip, and the hand presses with at most 4 N.
TEST(WallTrial, HoldsNoWallThatNoHandReaches) {
  const ArmDescription arm = test::omni();
  Parameters p = of(CouplingKind::predictive);
  p.friction = 5;
  const WallTrial trial = try_wall(arm, rest_pose(arm), p, 500);
  EXPECT_EQ(trial.held, 0);
  EXPECT_EQ(trial.fault, "no simulated hand reaches a wall of 500 N/m");
}

TEST(WallTrial, EndsWhenItIsStopped) {
  const ArmDescription arm = test::omni();
  const std::atomic<bool> stop = true;
  EXPECT_EQ(try_wall(arm, rest_pose(arm), of(CouplingKind::predictive), 600, &stop).held, 0);
}

// Only the first joint can be turned: it moves the tip sideways. The wall is tried that way, too,
// although the tip is damped least up and down.
TEST(WallTrial, PressesAlongEachAxisOfTheInertia) {
  ArmDescription arm = test::omni();
  arm.joints[1].friction = arm.joints[2].friction = 5;
  const Parameters p = of(CouplingKind::predictive);
  EXPECT_LT(std::abs(tap_place(arm, rest_pose(arm), p).out.y()), 1e-6);
  const WallTrial sideways = try_wall(arm, rest_pose(arm), p, 300);
  EXPECT_EQ(sideways.held, 300) << sideways.fault;
  arm.joints[0].friction = 5;
  EXPECT_EQ(try_wall(arm, rest_pose(arm), p, 300).fault,
            "no simulated hand reaches a wall of 300 N/m");
}

}  // namespace
}  // namespace limpid
