#include "app/run/own_world.h"

#include <gtest/gtest.h>

#include "app/base/folders.h"
#include "core/dynamics/arm.h"
#include "core/dynamics/inverse_kinematics.h"
#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

// An arm with all joints about y or z, stretched out along x, as many arms are at zero.
ArmDescription stretched_arm() {
  ArmDescription arm = test::random_arm(6, 1);
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    arm.joints[i].origin = Pose::Identity();
    arm.joints[i].origin.translation() = Vec3(i > 0 ? 0.3 : 0, 0, 0);
    arm.joints[i].axis = i % 2 ? Vec3::UnitY() : Vec3::UnitZ();
    arm.joints[i].lower = -2;
    arm.joints[i].upper = 2;
  }
  return arm;
}

TEST(OwnWorld, IsTheDefaultOneForTheBuiltInArm) {
  EXPECT_TRUE(suits_default_world(test::omni()));
  EXPECT_EQ(default_scene(test::omni()), default_scene());
  EXPECT_FALSE(suits_default_world(stretched_arm()));
  EXPECT_EQ(default_scene(stretched_arm()).filename(), "free.toml");
}

TEST(OwnWorld, HasAPathWithinReachAndLimits) {
  std::vector<ArmDescription> arms{stretched_arm()};
  for (const int dof : {1, 2, 3, 7}) arms.push_back(test::random_arm(dof, 5));
  for (const ArmDescription& arm : arms) {
    const SmallPath path = small_path(arm);
    const double size = reach(arm);
    double widest = 0;
    for (const Vec3& point : path.hand.position) {
      widest = std::max(widest, (point - path.hand.position.front()).norm());
    }
    EXPECT_LE(widest, 0.0501 * size);
    EXPECT_GE(widest, 0.01 * size) << arm.dof();
    EXPECT_LT((path.hand.position.front() - path.hand.position.back()).norm(), 1e-9);
    EXPECT_LT((Arm<kAnyDof>(arm).tip_at(path.start.x1) - path.start.target).norm(), 1e-12);
    const Eigen::VectorXd guess = path.start.x1;
    for (std::size_t i = 0; i < path.hand.position.size(); i += 100) {
      EXPECT_TRUE(inverse_kinematics(arm, path.hand.position[i], guess)) << arm.dof() << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace limpid
