#include "app/run/urdf_writer.h"

#include <gtest/gtest.h>

#include "devices/files/urdf_file.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Slides;

class UrdfOf : public testing::TestWithParam<Slides> {};
INSTANTIATE_TEST_SUITE_P(Arms, UrdfOf, testing::Values(Slides::none, Slides::some, Slides::all));

TEST_P(UrdfOf, AnArmReadsAsThatArm) {
  ArmDescription arm = test::random_arm(4, 91, GetParam());
  arm.name = "a \"robot\" & <more>";
  for (std::size_t i = 0; i < 4; ++i) {
    Joint& joint = arm.joints[i];
    joint.friction = 0.01 * static_cast<double>(i + 1);
    joint.spring = 0.02 * static_cast<double>(i);
    joint.offset = -0.003 * static_cast<double>(i);
    if (i > 1) {
      joint.continuous = 0.1 * static_cast<double>(i) * joint.effort;
      joint.warming = 30.0 * static_cast<double>(i);
    }
    if (i == 0 && !arm.slides(0)) continue;  // this one has no stops
    joint.lower = -0.5 - 0.1 * static_cast<double>(i);
    joint.upper = 0.7;
  }
  arm.gravity = Vec3(1, -2, -9.5);
  arm.delay = 0.00213;
  arm.encoder_step = 3.3e-4;
  arm.assumed_delay = 0.0017;
  const ArmDescription read = parse_urdf(urdf_text(arm, "a remark -- <of> it"), "text", {});
  EXPECT_EQ(read.name, arm.name);
  ASSERT_EQ(read.dof(), 4);
  EXPECT_EQ(read.gravity, arm.gravity);
  EXPECT_EQ(read.delay, arm.delay);
  EXPECT_DOUBLE_EQ(read.encoder_step, arm.encoder_step);
  EXPECT_EQ(read.assumed_delay, arm.assumed_delay);
  EXPECT_LT((read.tip.matrix() - arm.tip.matrix()).norm(), 1e-9);
  for (std::size_t i = 0; i < 4; ++i) {
    const Joint &a = arm.joints[i], &b = read.joints[i];
    EXPECT_EQ(b.kind, a.kind);
    EXPECT_EQ(b.name, a.name);
    EXPECT_LT((b.origin.matrix() - a.origin.matrix()).norm(), 1e-9);
    EXPECT_LT((b.axis - a.axis).norm(), 1e-9);
    EXPECT_DOUBLE_EQ(b.lower, a.lower);
    EXPECT_DOUBLE_EQ(b.upper, a.upper);
    EXPECT_DOUBLE_EQ(b.effort, a.effort);
    EXPECT_DOUBLE_EQ(b.damping, a.damping);
    EXPECT_DOUBLE_EQ(b.friction, a.friction);
    EXPECT_DOUBLE_EQ(b.spring, a.spring);
    EXPECT_DOUBLE_EQ(b.offset, a.offset);
    EXPECT_DOUBLE_EQ(b.continuous, a.continuous);
    EXPECT_DOUBLE_EQ(b.warming, a.warming);
    EXPECT_DOUBLE_EQ(read.links[i].mass, arm.links[i].mass);
    EXPECT_LT((read.links[i].com - arm.links[i].com).norm(), 1e-12);
    EXPECT_LT((read.links[i].inertia - arm.links[i].inertia).norm(), 1e-15);
  }
}

// A device gives less than its file says: what is written of it has to be readable.
TEST(UrdfOfAnArm, HasNoMotorThatBearsMoreThanItGives) {
  ArmDescription arm = test::random_arm(2, 92);
  arm.joints[0].continuous = 2 * arm.joints[0].effort;
  arm.joints[0].warming = 60;
  const ArmDescription read = parse_urdf(urdf_text(arm, ""), "text", {});
  EXPECT_DOUBLE_EQ(read.joints[0].continuous, read.joints[0].effort);
}

}  // namespace
}  // namespace limpid
