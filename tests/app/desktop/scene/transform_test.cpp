// Effects of the mouse on an object.
#include "app/desktop/scene/transform.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace limpid {
namespace {

constexpr double kPi = std::numbers::pi;

struct Seen {
  Camera camera;
  Object object{.name = "block",
                .pose = pose_at({0.17, 0.02, -0.04}),
                .shape = Box{.size = {0.02, 0.03, 0.04}}};

  Seen() {
    camera.resize(900, 500);
    camera.finish();
  }
  Eigen::Vector2d pixel(const Vec3& point) const { return *camera.project(point); }
  Object to(TransformKind kind, std::optional<int> axis, const Eigen::Vector2d& begin,
            const Eigen::Vector2d& now, bool steps = false) const {
    Transform transform(kind, object, nullptr);
    transform.axis = axis;
    return transform.to(camera, begin, now, steps).object;
  }
};

TEST(Transform, MovesSoThatTheGraspedPointStaysUnderTheMouse) {
  const Seen seen;
  const Vec3 middle = seen.object.pose.translation();
  const Eigen::Vector2d begin = seen.pixel(middle);
  const Object moved = seen.to(TransformKind::move, {}, begin, begin + Eigen::Vector2d(60, -25));
  const Vec3 way = moved.pose.translation() - middle;
  EXPECT_NEAR(way.dot(seen.camera.forward()), 0, 1e-12) << "as far from the eye";
  EXPECT_TRUE(
      seen.pixel(moved.pose.translation()).isApprox(begin + Eigen::Vector2d(60, -25), 1e-9));
  EXPECT_EQ(moved.shape, seen.object.shape);
}

// Millimetres, degrees about the axis from whichever side, and a factor.
TEST(Transform, TakesNumbersAsTheyAreTyped) {
  Seen seen;
  const auto by = [&](TransformKind kind, std::optional<int> axis, double amount) {
    Transform transform(kind, seen.object, nullptr);
    transform.axis = axis;
    return transform.by(seen.camera, amount).object;
  };
  const Vec3 middle = seen.object.pose.translation();
  EXPECT_LT(
      (by(TransformKind::move, 1, -25).pose.translation() - middle + 0.025 * Vec3::UnitY()).norm(),
      1e-15);
  for (const auto view : {Camera::View::top, Camera::View::front, Camera::View::side}) {
    seen.camera.look(view);
    seen.camera.finish();
    for (int axis = 0; axis < 3; ++axis) {
      const Mat3 turned = by(TransformKind::turn, axis, 30).pose.linear();
      const Mat3 wanted = Eigen::AngleAxisd(kPi / 6, Vec3::Unit(axis)).toRotationMatrix();
      EXPECT_LT((turned - wanted).norm(), 1e-12) << axis;
    }
  }
  EXPECT_EQ(std::get<Box>(by(TransformKind::scale, 2, 1.5).shape).size, Vec3(0.02, 0.03, 0.06));
}

TEST(Transform, MovesAlongOneAxisToWhereTheMouseIsNearestToIt) {
  const Seen seen;
  const Vec3 middle = seen.object.pose.translation();
  for (int axis = 0; axis < 3; ++axis) {
    // The mouse goes along the axis on the screen: the point follows it exactly.
    const Vec3 there = middle + 0.037 * Vec3::Unit(axis);
    const Object moved = seen.to(TransformKind::move, axis, seen.pixel(middle), seen.pixel(there));
    EXPECT_TRUE(moved.pose.translation().isApprox(there, 1e-9)) << axis;
    // Steps are whole multiples of 5 mm.
    const Object stepped =
        seen.to(TransformKind::move, axis, seen.pixel(middle), seen.pixel(there), true);
    EXPECT_TRUE(stepped.pose.translation().isApprox(middle + 0.035 * Vec3::Unit(axis), 1e-9));
  }
}

TEST(Transform, StaysWhereItIsAlongAnAxisThatPointsAtTheEye) {
  Seen seen;
  seen.camera.look(Camera::View::top);
  seen.camera.finish();
  const Vec3 middle = seen.camera.target();
  seen.object.pose = pose_at(middle);
  const Object moved = seen.to(TransformKind::move, 2, seen.pixel(middle),
                               seen.pixel(middle) + Eigen::Vector2d(40, 3));
  EXPECT_TRUE(moved.pose.translation().allFinite());
  EXPECT_LT((moved.pose.translation() - middle).norm(), 0.5);
}

TEST(Transform, TurnsByTheAngleOfTheMouseAboutThePivot) {
  const Seen seen;
  const Eigen::Vector2d middle = seen.pixel(seen.object.pose.translation());
  const auto at = [&](double angle) {
    return Eigen::Vector2d(middle + 80 * Eigen::Vector2d(std::cos(angle), -std::sin(angle)));
  };
  for (const double angle : {0.4, -1.2, 3.0}) {
    // A motion counterclockwise on the screen turns the object about the direction to the eye.
    const Object turned = seen.to(TransformKind::turn, {}, at(0.3), at(0.3 + angle));
    const Mat3 expected = Eigen::AngleAxisd(angle, -seen.camera.forward()).toRotationMatrix();
    EXPECT_TRUE(turned.pose.linear().isApprox(expected, 1e-9)) << angle;
    EXPECT_TRUE(turned.pose.translation().isApprox(seen.object.pose.translation(), 1e-12));
    for (int axis = 0; axis < 3; ++axis) {
      const double side = Vec3::Unit(axis).dot(-seen.camera.forward()) < 0 ? -1 : 1;
      const Object about = seen.to(TransformKind::turn, axis, at(0.3), at(0.3 + angle));
      EXPECT_TRUE(about.pose.linear().isApprox(
          Eigen::AngleAxisd(side * angle, Vec3::Unit(axis)).toRotationMatrix(), 1e-9));
    }
  }
  const Object stepped = seen.to(TransformKind::turn, {}, at(0), at(0.9 * kPi / 12), true);
  EXPECT_NEAR(Eigen::AngleAxisd(stepped.pose.linear()).angle(), kPi / 12, 1e-9);
}

TEST(Transform, TurnsTheNormalOfAPlane) {
  Seen seen;
  seen.object.shape = Plane{};
  const Eigen::Vector2d middle = seen.pixel(seen.object.pose.translation());
  const Object turned = seen.to(TransformKind::turn, 0, middle + Eigen::Vector2d(50, 0),
                                middle + Eigen::Vector2d(0, -50));
  const Vec3 normal = std::get<Plane>(turned.shape).normal;
  EXPECT_NEAR(std::abs(normal.y()), 1, 1e-9);
  EXPECT_EQ(turned.pose.linear(), Mat3::Identity()) << "a pose does not turn a plane";
}

TEST(Transform, ScalesByHowFarTheMouseIsFromThePivot) {
  Seen seen;
  const Eigen::Vector2d middle = seen.pixel(seen.object.pose.translation());
  const Eigen::Vector2d begin = middle + Eigen::Vector2d(30, 40),
                        now = middle + Eigen::Vector2d(0, 75);
  const auto size = [](const Object& object) { return std::get<Box>(object.shape).size; };
  EXPECT_TRUE(
      size(seen.to(TransformKind::scale, {}, begin, now)).isApprox(Vec3(0.03, 0.045, 0.06), 1e-9));
  EXPECT_TRUE(
      size(seen.to(TransformKind::scale, 1, begin, now)).isApprox(Vec3(0.02, 0.045, 0.04), 1e-9));
  EXPECT_GT(size(seen.to(TransformKind::scale, {}, begin, middle)).minCoeff(), 0)
      << "never nothing";
  seen.object.shape = Cylinder{.radius = 0.01, .length = 0.05};
  const auto tube = [&](std::optional<int> axis) {
    return std::get<Cylinder>(seen.to(TransformKind::scale, axis, begin, now).shape);
  };
  EXPECT_NEAR(tube(2).length, 0.075, 1e-12);
  EXPECT_EQ(tube(2).radius, 0.01);
  EXPECT_NEAR(tube(0).radius, 0.015, 1e-12);
  EXPECT_EQ(tube(0).length, 0.05);
  EXPECT_NEAR(tube({}).radius * tube({}).length, 1.5 * 1.5 * 0.01 * 0.05, 1e-12);
}

// A model's middle need not be the origin of its frame.
TEST(Transform, TurnsAndScalesAMeshAboutItsMiddle) {
  Seen seen;
  Model model;
  for (const float x : {20.f, 60.f})
    model.vertices.push_back({.position = {x, 0, 0}, .normal = {0, 0, 1}});
  seen.object.shape = Mesh{.model = "m", .scale = 1, .unit = 1e-3};
  Transform transform(TransformKind::scale, seen.object, &model);
  const Vec3 middle = seen.object.pose * Vec3(0.04, 0, 0);
  EXPECT_TRUE(transform.pivot.isApprox(middle, 1e-9));
  const Eigen::Vector2d at = seen.pixel(middle);
  const Object grown =
      transform.to(seen.camera, at + Eigen::Vector2d(20, 0), at + Eigen::Vector2d(50, 0), false)
          .object;
  EXPECT_NEAR(std::get<Mesh>(grown.shape).scale, 2.5, 1e-9);
  EXPECT_TRUE((grown.pose * Vec3(2.5 * 0.04, 0, 0)).isApprox(middle, 1e-9));
  transform.kind = TransformKind::turn;
  const Object turned =
      transform.to(seen.camera, at + Eigen::Vector2d(20, 0), at + Eigen::Vector2d(0, 20), false)
          .object;
  EXPECT_TRUE((turned.pose * Vec3(0.04, 0, 0)).isApprox(middle, 1e-9));
}

TEST(Transform, IsNotThereForWhatCannotBeSeenToChange) {
  const Object stop{.shape = JointStop{}}, plane{.shape = Plane{}}, ball{.shape = Sphere{}};
  Object marble = ball;
  marble.body = Body{};
  using enum TransformKind;
  for (const TransformKind kind : {move, turn, scale}) EXPECT_FALSE(can(kind, stop));
  EXPECT_TRUE(can(move, plane));
  EXPECT_TRUE(can(turn, plane));
  EXPECT_FALSE(can(scale, plane));
  EXPECT_FALSE(can(turn, ball));
  EXPECT_TRUE(can(turn, marble)) << "it may roll";
}

}  // namespace
}  // namespace limpid
