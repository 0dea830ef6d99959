// The arms, scenes and hands that come with the program.
#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/dynamics/arm.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/session/hand_file.h"
#include "devices/files/urdf_file.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/objects.h"

namespace limpid {
namespace {

constexpr double kLength = 0.135;  // of both links [m]

ArmDescription omni() { return read_urdf(test::assets() / "devices/omni.urdf"); }

// Closed form, independent of the file: two links in a vertical plane that turns.
Vec3 tip_at(const Vec3& q) {
  const double out = kLength * (std::cos(q[1]) + std::cos(q[1] + q[2]));
  const double up = -kLength * (std::sin(q[1]) + std::sin(q[1] + q[2]));
  return {out * std::cos(q[0]), out * std::sin(q[0]), up};
}

Vec3 angles_at(const Vec3& tip) {
  const double half = std::acos(tip.norm() / (2 * kLength));
  const double down = std::atan2(-tip.z(), std::hypot(tip.x(), tip.y()));
  return {std::atan2(tip.y(), tip.x()), down - half, 2 * half};
}

Vec3 rest(const ArmDescription& arm) {
  Vec3 q;
  for (int i = 0; i < 3; ++i) {
    const Joint& joint = arm.joints[static_cast<std::size_t>(i)];
    q[i] = (joint.lower + joint.upper) / 2;
  }
  return q;
}

Vec3 rest_tip() { return tip_at(rest(omni())); }

TEST(Omni, HasTheGeometryOfItsClosedForm) {
  const ArmDescription arm = omni();
  ASSERT_EQ(arm.dof(), 3);
  for (const Vec3& q : {Vec3(0.3, -0.9, 1.2), Vec3(-0.5, 0.1, 2.0)}) {
    Pose at = Pose::Identity();
    for (std::size_t i = 0; i < 3; ++i) {
      at = at * arm.joints[i].origin *
           Eigen::AngleAxisd(q[static_cast<Eigen::Index>(i)], arm.joints[i].axis);
    }
    EXPECT_LT((at * arm.tip.translation() - tip_at(q)).norm(), 1e-15);
  }
}

TEST(Omni, RestsWithTheUpperArmUpAndTheForearmDown) {
  const Vec3 q = rest(omni());
  EXPECT_NEAR(q[0], 0, 1e-12);
  EXPECT_NEAR(q[1], -std::numbers::pi / 4, 1e-3);
  EXPECT_NEAR(q[2], std::numbers::pi / 2, 1e-3);
}

TEST(Omni, HasLinksThatCanExist) {
  for (const Link& link : omni().links) {
    const Vec3 moments =
        Eigen::SelfAdjointEigenSolver<Mat3>(link.inertia, Eigen::EigenvaluesOnly).eigenvalues();
    EXPECT_GT(link.mass, 0);
    EXPECT_GT(moments[0], 0);
    EXPECT_LE(moments[2], moments[0] + moments[1]) << link.name;
  }
}

TEST(Omni, GivesThreePointThreeNewtonAtTheTip) {
  const ArmDescription arm = omni();
  const Vec3 tip = tip_at(rest(arm));
  const double levers[] = {std::hypot(tip.x(), tip.y()), tip.norm(), kLength};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_GE(arm.joints[i].effort, 3.3 * levers[i]);
    EXPECT_LE(arm.joints[i].effort, 3.3 * levers[i] + 0.01) << "rounded up to two digits";
  }
}

void expect_within_reach(const ArmDescription& arm, const HandPath& path) {
  for (const Vec3& p : path.position) {
    const Vec3 q = angles_at(p);
    for (int i = 0; i < 3; ++i) {
      const Joint& joint = arm.joints[static_cast<std::size_t>(i)];
      ASSERT_GT(q[i], joint.lower) << path.source << " " << p.transpose();
      ASSERT_LT(q[i], joint.upper) << path.source << " " << p.transpose();
    }
  }
}

TEST(Omni, ReachesEveryHand) {
  const ArmDescription arm = omni();
  int hands = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::assets() / "hands")) {
    if (entry.path().extension() != ".csv") continue;
    expect_within_reach(arm, read_hand(entry.path()));
    ++hands;
  }
  EXPECT_GE(hands, 20);
}

TEST(Omni, ReachesPeoplesHands) {
  const auto folder = test::shared_hands();
  if (folder.empty()) GTEST_SKIP() << "no recordings of people on this computer";
  const ArmDescription arm = omni();
  for (const char* name : {"handwriting_1.csv", "wiping_1.csv", "wiping_2.csv"}) {
    expect_within_reach(arm, read_hand(folder / name));
  }
}

TEST(Planar2, BendsInThePlane) {
  const ArmDescription arm = read_urdf(test::assets() / "devices/planar2.urdf");
  ASSERT_EQ(arm.dof(), 2);
  for (const Joint& joint : arm.joints) EXPECT_EQ(joint.axis, Vec3::UnitZ());
}

// Axes of the service: to the right, away from the user, who sits ahead of the origin, and up.
TEST(Inverse3, HasTheCursorOfItsServiceForJointsAndFeelsAlikeInAllDirections) {
  const ArmDescription description = read_urdf(test::assets() / "devices/inverse3.urdf");
  ASSERT_EQ(description.dof(), 3);
  EXPECT_TRUE(description.warnings.empty());
  const Arm<3> arm(description);
  const Vec3 middle(0, -0.12, 0.16);  // [m]
  EXPECT_LT((rest(description) * kSlideUnit - middle).norm(), 1e-12);
  const Vec3 place = arm.tip_at(middle / kSlideUnit);
  EXPECT_LT((place - rest_tip()).norm(), 0.002) << "where the scenes are";
  for (const Vec3& cursor : {Vec3(0.1, -0.2, 0.02), Vec3(-0.2, 0, 0.3)}) {
    const Vec3 moved = cursor - middle;
    const Vec3 tip = arm.tip_at(cursor / kSlideUnit);
    EXPECT_LT((tip - place - Vec3(-moved.y(), moved.x(), moved.z())).norm(), 1e-12);
  }
  double mass = 0;
  for (std::size_t i = 3; i-- > 0;) {
    mass += description.links[i].mass;
    EXPECT_NEAR(mass, 0.149, 0.0011) << "what slide " << i << " moves [kg]";
    EXPECT_NEAR(description.joints[i].effort / kSlideUnit, 4, 1e-12);
  }
}

TEST(Touch, IsAnOmniFiveTimesAsHeavyWithTheFrictionOfItsDataSheet) {
  const ArmDescription light = omni(), real = read_urdf(test::assets() / "devices/touch.urdf");
  ASSERT_EQ(real.dof(), 3);
  EXPECT_TRUE(real.warnings.empty());
  const Vec3 lever(0.2, std::hypot(0.2, 0.04), kLength);  // of the joints at (0.2, 0, -0.04) [m]
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(real.links[i].mass, 5 * light.links[i].mass, 1e-12);
    EXPECT_LT((real.links[i].inertia - 5 * light.links[i].inertia).norm(), 1e-12);
    EXPECT_NEAR(real.joints[i].friction / lever[static_cast<Eigen::Index>(i)], 0.26, 1e-3);
    EXPECT_NEAR(real.joints[i].continuous / real.joints[i].effort, 0.88 / 3.3, 2e-3);
    EXPECT_EQ(light.joints[i].continuous, 0) << "the ideal arm stays cold";
    EXPECT_EQ(real.joints[i].damping, light.joints[i].damping);
    EXPECT_EQ(real.joints[i].lower, light.joints[i].lower);
    EXPECT_EQ(real.joints[i].upper, light.joints[i].upper);
  }
}

// Slides that stand where the Inverse3's do, with the middle of their travel where the scenes are.
TEST(SlidingDevices, HaveTheMassForceAndFrictionThatTheirFilesSay) {
  struct Expected {
    const char* file;
    double mass, effort, friction, damping;  // [kg, N, N, N s/m]
    Vec3 travel;                             // [m]
  };
  for (const Expected& e : {Expected{"omega.urdf", 0.2, 12, 0.4, 1, {0.16, 0.16, 0.11}},
                            Expected{"falcon.urdf", 0.25, 9, 0.5, 1.5, {0.102, 0.102, 0.102}}}) {
    const ArmDescription arm = read_urdf(test::assets() / "devices" / e.file);
    ASSERT_EQ(arm.dof(), 3) << e.file;
    EXPECT_TRUE(arm.warnings.empty()) << e.file;
    EXPECT_LT((Arm<3>(arm).tip_at(rest(arm)) - rest_tip()).norm(), 0.002) << e.file;
    double mass = 0;
    for (std::size_t i = 3; i-- > 0;) {
      const Joint& joint = arm.joints[i];
      mass += arm.links[i].mass;
      EXPECT_NEAR(mass, e.mass, 0.0021) << e.file << ", what slide " << i << " moves [kg]";
      EXPECT_NEAR(joint.effort / kSlideUnit, e.effort, 1e-9) << e.file;
      EXPECT_NEAR(joint.friction / kSlideUnit, e.friction, 1e-9) << e.file;
      EXPECT_NEAR(joint.damping / kSlideUnit / kSlideUnit, e.damping, 1e-9) << e.file;
      EXPECT_NEAR((joint.upper - joint.lower) * kSlideUnit, e.travel[static_cast<Eigen::Index>(i)],
                  1e-9)
          << e.file;
    }
  }
}

// Joints away from the person, who sits ahead of the origin, to the person's left, and up.
TEST(DevicesOfMakers, HaveTheirTipForJointsAndStandWhereTheScenesAre) {
  for (const char* file : {"openhaptics.urdf", "forcedimension.urdf"}) {
    const ArmDescription description = read_urdf(test::assets() / "devices" / file);
    ASSERT_EQ(description.dof(), 3) << file;
    EXPECT_TRUE(description.warnings.empty()) << file;
    const Arm<3> arm(description);
    const Vec3 place = arm.tip_at(Vec3::Zero());
    EXPECT_LT((place - rest_tip()).norm(), 0.002) << file;
    const Vec3 moved(0.03, 0.05, -0.02);  // [m]
    const Vec3 tip = arm.tip_at(moved / kSlideUnit);
    EXPECT_LT((tip - place - Vec3(-moved.x(), -moved.y(), moved.z())).norm(), 1e-12) << file;
  }
}

TEST(Scenes, AllReadWithTheOmni) {
  const ArmDescription arm = omni();
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::assets() / "scenes")) {
    if (entry.path().extension() != ".toml") continue;
    EXPECT_FALSE(read_scene(entry.path(), arm).title.empty()) << entry.path();
    ++scenes;
  }
  EXPECT_GE(scenes, 20);
}

int times_entered(const HandPath& path, const std::function<bool(const Vec3&)>& inside) {
  int count = 0;
  for (std::size_t i = 1; i < path.position.size(); ++i) {
    count += inside(path.position[i]) && !inside(path.position[i - 1]) ? 1 : 0;
  }
  return count;
}

TEST(Hands, PushTheUpperArmThreeTimesThenTheTableThreeTimes) {
  const Scene scene = read_scene(test::assets() / "scenes/proximal.toml", omni()).scene;
  const HandPath path = read_hand(test::assets() / "hands/proximal.csv");
  const JointStop& stop = test::shape<JointStop>(scene);
  const Vec3 up = test::shape<Plane>(scene).normal;
  const Vec3 table = test::object<Plane>(scene).pose.translation();
  const auto pushes = [&](const Vec3& p) {
    return stop.direction * (angles_at(p)[stop.joint] - stop.angle) > 0;
  };
  const auto touches = [&](const Vec3& p) { return up.dot(p - table) < 0; };
  EXPECT_EQ(times_entered(path, pushes), 3);
  EXPECT_EQ(times_entered(path, touches), 3);
  for (const Vec3& p : path.position) EXPECT_FALSE(pushes(p) && touches(p));
  EXPECT_EQ(path.duration(), 12);
}

TEST(Hands, PressTheTableFiveMillimetresDeepAndLeaveItAgain) {
  const Scene scene = read_scene(test::assets() / "scenes/table.toml", omni()).scene;
  const HandPath path = read_hand(test::assets() / "hands/touch.csv");
  const double height = test::object<Plane>(scene).pose.translation().z();
  const auto touches = [&](const Vec3& p) { return p.z() < height; };
  EXPECT_EQ(times_entered(path, touches), 2);
  double lowest = 0;
  for (const Vec3& p : path.position) lowest = std::min(lowest, p.z());
  EXPECT_NEAR(lowest, -0.045, 1e-6);
  EXPECT_EQ(path.duration(), 10);
  EXPECT_EQ(read_hand(test::assets() / "hands/free.csv").duration(), 8);
}

}  // namespace
}  // namespace limpid
