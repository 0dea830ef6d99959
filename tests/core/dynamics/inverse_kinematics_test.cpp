#include "core/dynamics/inverse_kinematics.h"

#include <gtest/gtest.h>

#include "core/dynamics/arm.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;
using test::random_arm;

Vec3 tip_at(const ArmDescription& description, const Eigen::VectorXd& x) {
  const Arm<kAnyDof> arm(description);
  Arm<kAnyDof>::Frames f;
  arm.frames(x, f);
  return arm.tip(f);
}

TEST(InverseKinematics, PutsTheTipWhereItIsAsked) {
  for (const int n : {2, 3, 7}) {
    const ArmDescription arm = random_arm(n, 3);
    Random random(4);
    for (int round = 0; round < 20; ++round) {
      const Vec3 target = tip_at(arm, random.vector(n, 2));
      const auto x = inverse_kinematics(arm, target, random.vector(n, 1));
      ASSERT_TRUE(x) << n << " joints, round " << round;
      EXPECT_LT((tip_at(arm, *x) - target).norm(), 1e-6);
    }
  }
}

TEST(InverseKinematics, StaysWithinTheLimits) {
  ArmDescription arm = random_arm(3, 8);
  for (Joint& joint : arm.joints) {
    joint.lower = -0.6;
    joint.upper = 0.9;
  }
  Random random(5);
  for (int round = 0; round < 20; ++round) {
    Eigen::VectorXd inside(3);
    for (double& c : inside) c = random.between(-0.6, 0.9);
    const auto x = inverse_kinematics(arm, tip_at(arm, inside), rest_pose(arm));
    ASSERT_TRUE(x);
    EXPECT_GE(x->minCoeff(), -0.6);
    EXPECT_LE(x->maxCoeff(), 0.9);
  }
}

TEST(InverseKinematics, FindsNothingOutOfReach) {
  const ArmDescription arm = random_arm(3, 8);
  const Vec3 away = 1.01 * reach(arm) * Vec3(1, 2, 3).normalized();
  const Vec3 far = arm.joints[0].origin.translation() + away;
  EXPECT_FALSE(inverse_kinematics(arm, far, Eigen::VectorXd::Zero(3)));
}

TEST(InverseKinematics, FindsAMicrometreOrNothing) {
  // Two links in a line with a reach of 0.5 m; the base's place adds nothing.
  ArmDescription arm;
  arm.joints.resize(2);
  arm.links.resize(2);
  arm.joints[0].origin.translation() = Vec3(0.7, -0.4, 0.2);
  arm.joints[1].origin.translation() = Vec3(0.3, 0, 0);
  arm.tip.translation() = Vec3(0.2, 0, 0);
  EXPECT_NEAR(reach(arm), 0.5, 1e-15);
  const Vec3 base = arm.joints[0].origin.translation(), out = Vec3(3, 4, 0) / 5;
  const Eigen::VectorXd guess = Eigen::Vector2d(0.3, 0.2);
  const auto inside = inverse_kinematics(arm, base + 0.499 * out, guess);
  ASSERT_TRUE(inside);
  EXPECT_LT((tip_at(arm, *inside) - base - 0.499 * out).norm(), 1e-6);
  for (const double beyond : {2e-6, 1e-5, 1e-4, 1e-3}) {
    EXPECT_FALSE(inverse_kinematics(arm, base + (0.5 + beyond) * out, guess)) << beyond;
  }
}

TEST(Reach, IsNeverExceeded) {
  const ArmDescription arm = random_arm(3, 8);
  Random random(6);
  for (int round = 0; round < 2000; ++round) {
    const Vec3 tip = tip_at(arm, random.vector(3, 3.2));
    EXPECT_LE((tip - arm.joints[0].origin.translation()).norm(), reach(arm) * (1 + 1e-12));
  }
}

}  // namespace
}  // namespace limpid
