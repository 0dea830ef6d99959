#include "core/touch/scene.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace limpid
