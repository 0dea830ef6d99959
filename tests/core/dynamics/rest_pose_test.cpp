#include <gtest/gtest.h>

#include "core/dynamics/arm.h"
#include "tests/support/random_arm.h"
#include "tests/support/singular_values.h"

namespace limpid {
namespace {

// Ratio of the tip's slowest direction to its fastest.
double roundness(const ArmDescription& description, const Eigen::VectorXd& x) {
  const Arm<kAnyDof> arm(description);
  Arm<kAnyDof>::Frames f;
  arm.frames(Vec<kAnyDof>(x), f);
  Jacobian<kAnyDof> J;
  arm.point_jacobian(f, arm.dof() - 1, arm.tip(f), J);
  const Eigen::VectorXd s = test::singular_values(J);
  return s[0] / s[s.size() - 1];
}

TEST(RestPose, IsTheMiddleOfTheLimits) {
  ArmDescription arm = test::random_arm(3, 2);
  arm.joints[0].lower = -1;
  arm.joints[0].upper = 3;
  const Eigen::VectorXd x = rest_pose(arm);
  EXPECT_EQ(x[0], 1);
  EXPECT_EQ(x[1], 0) << "without limits";
}

TEST(RestPose, IsBentWhereTheMiddleIsStretchedOut) {
  ArmDescription arm = test::random_arm(6, 1);
  for (std::size_t i = 0; i < 6; ++i) {
    arm.joints[i].origin = Pose::Identity();
    arm.joints[i].origin.translation() = Vec3(i > 0 ? 0.3 : 0, 0, 0);
    arm.joints[i].axis = i == 0 ? Vec3::UnitZ() : Vec3::UnitY();
    arm.joints[i].lower = i == 2 ? -0.2 : -3;
    arm.joints[i].upper = -arm.joints[i].lower;
  }
  arm.tip.translation() = Vec3(0.3, 0, 0);
  EXPECT_LT(roundness(arm, Eigen::VectorXd::Zero(6)), 1e-9);
  const Eigen::VectorXd x = rest_pose(arm);
  EXPECT_GT(roundness(arm, x), 0.05);
  for (Eigen::Index i = 0; i < 6; ++i) {
    const Joint& joint = arm.joints[static_cast<std::size_t>(i)];
    EXPECT_TRUE(x[i] > joint.lower && x[i] < joint.upper);
  }
  EXPECT_EQ(rest_pose(arm), x) << "the same every time";
}

}  // namespace
}  // namespace limpid
