#include "core/touch/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/touch/mass_properties.h"

namespace limpid {
namespace {

TEST(Scene, HasObjectsOfOneShapeTogetherInTheOrderOfShapes) {
  Scene scene;
  const Shape added[] = {JointStop{}, Box{}, Plane{}, Mesh{}, Box{}, Sphere{}, Plane{}};
  const std::size_t places[] = {0, 0, 0, 2, 2, 1, 1};
  for (std::size_t i = 0; i < std::size(added); ++i) {
    EXPECT_EQ(scene.add({.name = std::to_string(i), .shape = added[i]}), places[i]) << i;
  }
  std::string order;
  for (const Object& object : scene.objects) order += object.name;
  EXPECT_EQ(order, "2651430");
}

TEST(Scene, HasWhatMovesBehindWhatStandsStillAsItCame) {
  Scene scene;
  EXPECT_EQ(scene.add({.name = "a", .shape = Mesh{}, .body = Body{}}), 0u);
  EXPECT_EQ(scene.add({.name = "b", .shape = Sphere{}, .body = Body{}}), 1u);
  EXPECT_EQ(scene.add({.name = "c", .shape = JointStop{}}), 0u);
  EXPECT_EQ(scene.add({.name = "d", .shape = Sphere{}}), 0u);
  std::string order;
  for (const Object& object : scene.objects) order += object.name;
  EXPECT_EQ(order, "dcab");
  EXPECT_EQ(count_bodies(scene), 2);
}

TEST(Scene, HasNoStopOfAJointAmongItsSurfaces) {
  Scene scene;
  EXPECT_EQ(stiffest_surface(scene), 0);
  scene.add({.shape = JointStop{}, .material = {JointStop::kUsualStiffness}});
  EXPECT_EQ(stiffest_surface(scene), 0);
  scene.add({.shape = Sphere{}, .material = {5}});
  scene.add({.shape = Mesh{}, .material = {7}});
  EXPECT_EQ(stiffest_surface(scene), 7);
  set_surface_stiffness(scene, 9);
  for (const Object& object : scene.objects) {
    EXPECT_EQ(object.material.stiffness, has_surface(object) ? 9 : JointStop::kUsualStiffness);
  }
}

Object body_of(const Shape& shape, std::vector<BodyPart> parts = {}) {
  return {.name = {},
          .pose = pose_at(Vec3(1, 2, 3)),
          .shape = shape,
          .body = Body{},
          .parts = std::move(parts)};
}

Vec3 center_of(const Object& object) { return mass_properties(object).center; }

TEST(Body, HasItsCentreOfMassWhereItsShapesBalance) {
  const BodyPart beside{pose_at(Vec3(0.1, 0, 0)), Box{Vec3::Constant(0.02)}};
  EXPECT_EQ(center_of(body_of(Box{Vec3::Constant(0.02)})), Vec3::Zero());
  // Two bodies of the same size balance in the middle.
  const Vec3 between = center_of(body_of(Box{Vec3::Constant(0.02)}, {beside}));
  EXPECT_NEAR((between - Vec3(0.05, 0, 0)).norm(), 0, 1e-12);
  // A ball with half of the cube's volume shifts the centre towards itself by a third.
  const double radius = 0.02 * std::cbrt(0.5 * 3 / (4 * std::numbers::pi));
  const BodyPart ball{pose_at(Vec3(0, 0.09, 0)), Sphere{radius}};
  const Vec3 drawn = center_of(body_of(Box{Vec3::Constant(0.02)}, {ball}));
  EXPECT_NEAR((drawn - Vec3(0, 0.03, 0)).norm(), 0, 1e-12);
  Object said = body_of(Box{}, {beside});
  said.body->center = Vec3(0.01, 0.02, 0.03);
  EXPECT_EQ(center_of(said), Vec3(0.01, 0.02, 0.03));
}

TEST(Body, GoesByItsNumberWhereItHasNoName) {
  Scene scene;
  scene.objects = {{.name = "table", .shape = Plane{}}, body_of(Sphere{}), body_of(Sphere{})};
  scene.objects[1].name = "ball";
  EXPECT_EQ(count_bodies(scene), 2);
  EXPECT_EQ(body_names(scene), (std::vector<std::string>{"ball", "object 2"}));
}

}  // namespace
}  // namespace limpid
