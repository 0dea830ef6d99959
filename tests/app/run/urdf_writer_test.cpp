#include "app/run/urdf_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

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

// Shapes of the base and of links, each with numbers of its own.
TEST(UrdfOfAnArm, HasItsShapesButNotThoseThatStandForOthers) {
  ArmDescription arm = test::random_arm(2, 93);
  arm.visuals.clear();
  const auto add = [&](int link, Visual::Shape shape, const Vec3& size) {
    const double turn = 0.1 * static_cast<double>(arm.visuals.size() + 1);
    Visual visual{.link = link, .shape = shape, .size = size};
    visual.origin.linear() = Eigen::AngleAxisd(turn, Vec3(1, 2, 2) / 3).toRotationMatrix();
    visual.origin.translation() = Vec3(turn, -turn, 2 * turn);
    arm.visuals.push_back(visual);
  };
  add(-1, Visual::Shape::box, Vec3(0.01, 0.02, 0.03));
  add(0, Visual::Shape::cylinder, Vec3(0.04, 0.05, 1));
  add(0, Visual::Shape::stand_in, Vec3(7, 7, 7));
  add(1, Visual::Shape::sphere, Vec3(0.06, 1, 1));
  add(1, Visual::Shape::box, Vec3(0.07, 0.08, 0.09));
  const ArmDescription read = parse_urdf(urdf_text(arm, ""), "text", {});
  std::erase_if(arm.visuals,
                [](const Visual& each) { return each.shape == Visual::Shape::stand_in; });
  ASSERT_EQ(read.visuals.size(), arm.visuals.size());
  for (std::size_t i = 0; i < arm.visuals.size(); ++i) {
    const Visual &a = arm.visuals[i], &b = read.visuals[i];
    EXPECT_EQ(b.link, a.link) << i;
    EXPECT_EQ(b.shape, a.shape) << i;
    EXPECT_EQ(b.size, a.size) << i;
    EXPECT_LT((b.origin.matrix() - a.origin.matrix()).norm(), 1e-9) << i;
  }
}

TEST(UrdfOfAnArm, NamesTheFilesOfItsMeshes) {
  ArmDescription arm = test::random_arm(1, 94);
  arm.visuals = {{.link = 0, .mesh = "/models/a & b.glb", .size = Vec3(2, -3, 4)}};
  const std::string text = urdf_text(arm, "");
  EXPECT_NE(text.find("<mesh filename=\"/models/a &amp; b.glb\" scale=\"2 -3 4\"/>"),
            std::string::npos)
      << text;
}

// The writer's own links are called base and tip, and a comment ends at two hyphens.
TEST(UrdfOfAnArm, IsReadWhateverItsLinksAndItsRemarkAre) {
  ArmDescription arm = test::random_arm(3, 95);
  arm.links[0].name = "base";
  arm.links[1].name = "tip";
  arm.links[2].name = "hand";
  const std::string text = urdf_text(arm, "one -- two --- three");
  EXPECT_EQ(text.find("--"), text.find("<!--") + 2);
  EXPECT_EQ(text.find("--", text.find("<!--") + 4), text.find("-->")) << text;
  EXPECT_NE(text.find("one - - two - - - three"), std::string::npos) << text;
  const ArmDescription read = parse_urdf(text, "text", {});
  ASSERT_EQ(read.dof(), 3);
  EXPECT_EQ(read.links[0].name, "base_link");
  EXPECT_EQ(read.links[1].name, "tip_link");
  EXPECT_EQ(read.links[2].name, "hand");
  EXPECT_LT((read.tip.matrix() - arm.tip.matrix()).norm(), 1e-9);
  EXPECT_EQ(read.tip_link, "tip");
}

// A file says of an arm only what somebody knows.
TEST(UrdfOfAnArm, SaysNothingThatIsNotKnown) {
  ArmDescription arm = test::random_arm(2, 96);
  for (Joint& joint : arm.joints) joint.spring = joint.offset = joint.continuous = 0;
  arm.delay.reset();
  arm.encoder_step = arm.assumed_delay = 0;
  const std::string text = urdf_text(arm, "");
  for (const char* word : {"<spring", "<warmth", "<readings", "delay="}) {
    EXPECT_EQ(text.find(word), std::string::npos) << word;
  }
  arm.joints[1].offset = 0.25;
  arm.assumed_delay = 0.002;
  const ArmDescription read = parse_urdf(urdf_text(arm, ""), "text", {});
  EXPECT_DOUBLE_EQ(read.joints[1].offset, 0.25) << "a spring that only pulls";
  EXPECT_EQ(read.joints[0].offset, 0);
  EXPECT_EQ(read.assumed_delay, 0.002);
  EXPECT_FALSE(read.delay);
}

}  // namespace
}  // namespace limpid
