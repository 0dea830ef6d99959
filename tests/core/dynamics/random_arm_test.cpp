#include "core/dynamics/random_arm.h"

#include <gtest/gtest.h>

#include "core/dynamics/arm.h"
#include "core/dynamics/random.h"

namespace limpid {
namespace {

double mass_of(const ArmDescription& arm) {
  double mass = 0;
  for (const Link& link : arm.links) mass += link.mass;
  return mass;
}

Mat<kAnyDof> inertia(const ArmDescription& description, const Eigen::VectorXd& x) {
  const Arm<kAnyDof> arm(description);
  Arm<kAnyDof>::Frames frames;
  arm.frames(x, frames);
  Mat<kAnyDof> M;
  arm.inertia(frames, M);
  return M;
}

// An arm of the same material and shape, s times as long, has masses of s^3 and inertias of s^5.
TEST(RandomArm, BuiltLargerIsTheSameArmOfTheSameMaterial) {
  const ArmDescription arm = random_arm(5, 7);
  const Eigen::VectorXd x = Random(3).vector(5, 1);
  for (const double larger : {0.3, 2.0, 5.0}) {
    const ArmDescription built = weighing(arm, mass_of(arm) * larger * larger * larger);
    EXPECT_NEAR(mass_of(built) / mass_of(arm), larger * larger * larger, 1e-9);
    const Vec3 tip = Arm<kAnyDof>(arm).tip_at(x), far = Arm<kAnyDof>(built).tip_at(x);
    EXPECT_LT((far - larger * tip).norm(), 1e-12);
    EXPECT_LT((inertia(built, x) - std::pow(larger, 5) * inertia(arm, x)).norm(),
              1e-9 * inertia(built, x).norm());
  }
}

TEST(RandomArm, HasNoBetterBearingsForBeingSmall) {
  const ArmDescription arm = random_arm(4, 1);
  const ArmDescription small = weighing(arm, 0.02), large = weighing(arm, 20);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(small.joints[i].damping, arm.joints[i].damping);
    EXPECT_EQ(small.joints[i].effort, arm.joints[i].effort);
    EXPECT_GT(large.joints[i].damping, arm.joints[i].damping);
    EXPECT_GT(large.joints[i].effort, arm.joints[i].effort);
  }
}

// Rows follow from the random numbers, so a turn is a turn to round-off.
TEST(Random, TurnsWithoutStretching) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const Mat3 R = random.rotation();
    EXPECT_LT((R.transpose() * R - Mat3::Identity()).norm(), 1e-14);
    EXPECT_NEAR(R.determinant(), 1, 1e-14);
  }
}

TEST(Random, DrawsBetweenInTheLogarithm) {
  Random random(6);
  int below = 0;
  for (int i = 0; i < 1000; ++i) {
    const double x = random.log_between(0.01, 100);
    EXPECT_GE(x, 0.01 * (1 - 1e-12));
    EXPECT_LE(x, 100 * (1 + 1e-12));
    below += x < 1;
  }
  EXPECT_NEAR(below, 500, 60);
}

}  // namespace
}  // namespace limpid
