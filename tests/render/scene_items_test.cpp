// Drawn items of a scene.
#include "render/scene_items.h"

#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

// Value by IEC 61966-2-1, the standard of screens.
constexpr float kLightOfHalf = 0.2140f;

TEST(SceneItems, HaveTheColourThatTheSceneSaysElseTheThemes) {
  Scene scene;
  Object ball{.name = "ball", .shape = Sphere{0.02}};
  scene.add(ball);
  ball.name = "moves";
  ball.body = Body{};
  ball.color = Vec3(1, 0.5, 0);
  ball.parts.push_back({Pose::Identity(), Box{Vec3::Constant(0.01)}, Vec3(0, 0, 1)});
  ball.parts.push_back({Pose::Identity(), Cylinder{}});
  scene.add(ball);
  const SceneItems items = collect_items(test::random_arm(3, 4), scene, {});
  ASSERT_EQ(items.world.size(), 1u);
  EXPECT_FALSE(items.world[0].own_color);
  ASSERT_EQ(items.bodies.size(), 3u);
  const Eigen::Vector3f orange(1, kLightOfHalf, 0), blue(0, 0, 1);
  const Eigen::Vector3f expected[] = {orange, blue, orange};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(items.bodies[i].own_color);
    for (const Vertex& vertex : items.bodies[i].model.vertices) {
      ASSERT_LT((vertex.color - expected[i]).norm(), 1e-3f) << i;
    }
  }
}

// A general pose.
Pose placed() {
  Pose pose = pose_at(Vec3(0.1, -0.05, 0.2));
  pose.linear() = Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  return pose;
}

void expect_same_bounds(const Bounds& a, const Bounds& b) {
  EXPECT_LT((a.min() - b.min()).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT((a.max() - b.max()).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(SceneItems, StandWhereTheirShapesAre) {
  const std::pair<Shape, Vec3> shapes[] = {{Sphere{0.03}, Vec3::Constant(0.03)},
                                           {Box{{0.02, 0.04, 0.06}}, {0.01, 0.02, 0.03}},
                                           {Cylinder{0.02, 0.1}, {0.02, 0.02, 0.05}},
                                           {Capsule{0.02, 0.1}, {0.02, 0.02, 0.07}}};
  for (const auto& [shape, half] : shapes) {
    Scene scene;
    scene.add({.name = "fixed", .pose = placed(), .shape = shape});
    scene.add({.name = "moves", .pose = placed(), .shape = shape, .body = Body{}});
    const SceneItems items = collect_items(test::omni(), scene, {});
    ASSERT_EQ(items.world.size(), 1u);
    expect_same_bounds(items.world[0].model.bounds(), Bounds(-half, half));
    EXPECT_TRUE(items.world[0].pose.isApprox(placed()));
    EXPECT_EQ(items.world[0].link, -1);
    ASSERT_EQ(items.bodies.size(), 1u);
    expect_same_bounds(items.bodies[0].model.bounds(), Bounds(-half, half));
    EXPECT_TRUE(items.bodies[0].pose.isApprox(Pose::Identity())) << "in the body's frame";
    EXPECT_EQ(items.bodies[0].link, 0);
    ASSERT_EQ(items.starts.size(), 1u);
    EXPECT_TRUE(items.starts[0].isApprox(placed()));
  }
}

TEST(SceneItems, HaveASlabUnderEachPlane) {
  for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(0, 0, 2), Vec3(1, 0, 0), Vec3(1, -2, 3)}) {
    const Vec3 point(0.1, 0.05, -0.04);
    Scene scene;
    scene.add({.pose = pose_at(point), .shape = Plane{normal}});
    const SceneItems items = collect_items(test::omni(), scene, {});
    ASSERT_EQ(items.world.size(), 1u);
    double highest = -1, lowest = 1;
    for (const Vertex& v : items.world[0].model.vertices) {
      const double height =
          normal.normalized().dot(items.world[0].pose * v.position.cast<double>() - point);
      highest = std::max(highest, height);
      lowest = std::min(lowest, height);
    }
    EXPECT_NEAR(highest, 0, 1e-6) << "its surface is the plane";
    EXPECT_LT(lowest, -0.005);
    const bool level = normal.head<2>().norm() == 0;
    ASSERT_EQ(items.level_planes.size(), level ? 1u : 0u);
    if (level) {
      EXPECT_EQ(items.level_planes[0], -0.04);
    }
  }
}

// A stop begins at its angle, seen from the joint along the arm, and fills half a radian behind.
TEST(SceneItems, HaveASectorAtEachStopOfAJoint) {
  const ArmDescription arm = test::omni();
  for (const int joint : {0, 1, 2}) {
    for (const double direction : {1.0, -1.0}) {
      Scene scene;
      scene.add({.shape = JointStop{.joint = joint, .angle = 0.3, .direction = direction}});
      const SceneItems items = collect_items(arm, scene, {});
      ASSERT_EQ(items.walls.size(), 1u);
      EXPECT_EQ(items.walls[0].link, joint - 1);
      const Joint& of = arm.joints[static_cast<std::size_t>(joint)];
      const Vec3 axis = of.axis.normalized();
      const Pose into = of.origin.inverse() * items.walls[0].pose;
      const Vec3 zero = Eigen::AngleAxisd(-0.3, axis) * (into.linear() * Vec3::UnitX());
      EXPECT_NEAR(zero.dot(axis), 0, 1e-9);
      double least = 9, most = -9;
      for (const Vertex& v : items.walls[0].model.vertices) {
        const Vec3 p = into * v.position.cast<double>();
        const double at = std::atan2(axis.cross(zero).dot(p), zero.dot(p));
        least = std::min(least, at);
        most = std::max(most, at);
      }
      EXPECT_NEAR(least, direction > 0 ? 0.3 : -0.2, 1e-6);
      EXPECT_NEAR(most, direction > 0 ? 0.8 : 0.3, 1e-6);
    }
  }
  Scene scene;
  scene.add({.shape = JointStop{.joint = 3}});
  EXPECT_TRUE(collect_items(arm, scene, {}).walls.empty()) << "of a joint that there is not";
}

// A model that is looked at shows shapes as large as itself at its place; bodies move away.
TEST(SceneItems, DrawNoShapeThatAModelShowsAlready) {
  const test::TempDir dir;
  std::ofstream out(dir / "box.obj");
  for (const int i : {0, 1, 2, 3, 4, 5, 6, 7}) {
    out << "v " << (i & 1) << ' ' << (i >> 1 & 1) << ' ' << (i >> 2 & 1) << '\n';
  }
  out << "f 1 2 4\nf 1 4 3\nf 5 6 8\nf 5 8 7\n";
  out.close();
  const VisualPicture seen{dir / "box.obj", pose_at(Vec3(0.1, 0, 0)), 0.1};
  const auto drawn = [&](double edge, bool moves) {
    Scene scene;
    Object box{.pose = pose_at(Vec3(0.15, 0.05, 0.05)), .shape = Box{Vec3::Constant(edge)}};
    if (moves) box.body = Body{};
    scene.add(box);
    const SceneItems items = collect_items(test::omni(), scene, std::span(&seen, 1));
    return items.world.size() + items.bodies.size() - 1;
  };
  EXPECT_EQ(drawn(0.1, false), 0u);
  EXPECT_EQ(drawn(0.11, false), 0u) << "a tenth of it apart at most";
  EXPECT_EQ(drawn(0.13, false), 1u);
  EXPECT_EQ(drawn(0.1, true), 1u);
  Scene scene;
  scene.add({.pose = pose_at(Vec3(0, 0, 0.1)), .shape = Plane{}});
  EXPECT_EQ(collect_items(test::omni(), scene, std::span(&seen, 1)).world.size(), 1u)
      << "the box's top is the plane";
  scene = {};
  scene.add({.pose = pose_at(Vec3(0, 0, 0.09)), .shape = Plane{}});
  EXPECT_EQ(collect_items(test::omni(), scene, std::span(&seen, 1)).world.size(), 2u);
}

TEST(Surroundings, HaveTheGroundBelowAllAndTheGridOnTheHighestLevelPlane) {
  Scene scene;
  const Surroundings bare = surroundings_of(collect_items(test::omni(), scene, {}), {});
  EXPECT_EQ(bare.grid.min().z(), bare.ground);
  EXPECT_EQ(bare.ground, bare.bounds.min().z());
  scene.add({.pose = pose_at(Vec3(0, 0, bare.ground + 0.01)), .shape = Plane{}});
  scene.add({.pose = pose_at(Vec3(0, 0, bare.ground + 0.03)), .shape = Plane{}});
  scene.add({.pose = pose_at(Vec3(0.2, 0, -3)), .shape = Sphere{0.1}});
  const Surroundings with = surroundings_of(collect_items(test::omni(), scene, {}), {});
  EXPECT_NEAR(with.grid.min().z(), bare.ground + 0.03, 1e-12);
  EXPECT_EQ(with.grid.max().z(), with.grid.min().z()) << "flat";
  EXPECT_NEAR(with.ground, -3.1, 1e-3);
  EXPECT_GT(with.bounds.min().z(), -1) << "what lies far away is not framed";
}

TEST(Surroundings, TakeInWhatIsNearTheArmAndThePartOfAMeshThatIs) {
  const SceneItems items = collect_items(test::omni(), Scene{}, {});
  const Bounds bare = surroundings_of(items, {}).bounds;
  const Vec3 middle = bare.center();
  const double room = 0.6 * items.reach;
  const Bounds small(middle + Vec3(0, 0, 0.9 * room), middle + Vec3(0.01, 0.01, 0.95 * room));
  EXPECT_NEAR(surroundings_of(items, {small}).bounds.max().z(),
              std::max(bare.max().z(), small.max().z()), 1e-12);
  const Bounds desk(middle - Vec3(5, 5, 5), middle + Vec3(5, 5, 0));
  const Bounds with = surroundings_of(items, {desk}).bounds;
  EXPECT_NEAR(with.max().x(), std::max(bare.max().x(), middle.x() + room), 1e-9);
  EXPECT_NEAR(with.min().z(), std::min(bare.min().z(), middle.z() - room), 1e-9);
}

TEST(SceneItems, OfASceneTakeThePlaceOfThoseBefore) {
  const test::TempDir dir;
  std::ofstream(dir / "seen.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const VisualPicture seen{dir / "seen.obj", pose_at(Vec3(0.1, 0, 0)), 0.1};
  Scene scene;
  scene.add({.pose = pose_at(Vec3(0, 0, -0.1)), .shape = Plane{}});
  scene.add({.shape = Sphere{0.02}, .body = Body{}});
  scene.add({.shape = JointStop{.joint = 1, .angle = 0.3, .direction = 1}});
  scene.probes.push_back({"tip", 1, Vec3::Zero(), Vec3(0.1, 0, 0), 0.01});
  const ArmDescription arm = test::omni();
  SceneItems items = collect_items(arm, scene, std::span(&seen, 1));
  const auto counts = [&] {
    return std::array{items.base.size(),   items.moving.size(),      items.world.size(),
                      items.bodies.size(), items.starts.size(),      items.walls.size(),
                      items.probes.size(), items.level_planes.size()};
  };
  const auto first = counts();
  EXPECT_EQ(first[3] + first[4] + first[5] + first[6] + first[7], 5u);
  EXPECT_EQ(first[2], 2u) << "the plane and what is only looked at";
  collect_scene_items(arm, scene, std::span(&seen, 1), items);
  EXPECT_EQ(counts(), first);
  collect_scene_items(arm, Scene{}, {}, items);
  EXPECT_EQ(counts(), (std::array<std::size_t, 8>{first[0], first[1]}));
}

// A probe is drawn where it touches, and never thinner than can be seen.
TEST(SceneItems, HaveTheProbesOfTheArm) {
  Scene scene;
  const Vec3 from(0.01, 0.02, 0.03), to(0.11, 0.02, 0.03);
  scene.probes = {{"rod", 2, from, to, 0.01}, {"point", 0, from, from, 0}};
  const SceneItems items = collect_items(test::omni(), scene, {});
  ASSERT_EQ(items.probes.size(), 2u);
  EXPECT_EQ(items.probes[0].link, 2);
  const Vec3 r = Vec3::Constant(0.01);
  expect_same_bounds(items.probes[0].model.bounds(), Bounds(from - r, to + r));
  EXPECT_EQ(items.probes[1].link, 0);
  EXPECT_GT(items.probes[1].model.bounds().sizes().minCoeff(), 0.003);
}

// The room before the arm is as wide to both sides of its foot.
TEST(Surroundings, FrameAsMuchRoomOnBothSidesOfTheArm) {
  const Bounds room = collect_items(test::omni(), Scene{}, {}).arm_bounds;
  const double foot = test::omni().joints[0].origin.translation().y();
  EXPECT_NEAR(room.max().y() - foot, foot - room.min().y(), 0.005);
}

}  // namespace
}  // namespace limpid
