#include "render/near_surface.h"

#include <gtest/gtest.h>

#include <cmath>

namespace limpid {
namespace {

Scene rough_table() {
  Scene scene;
  scene.add({"table", pose_at(Vec3::Zero()), Plane{Vec3::UnitZ()}, {600, 0, 0.6, 0.4}});
  scene.add({"ball", pose_at(Vec3(0, 0, 0.1)), Sphere{0.03}});
  return scene;
}

ViewState touched_with(const Vec3& force) {
  ViewState state;
  state.contacts.push_back({Vec3(0.2, 0, -0.001), force});
  return state;
}

TEST(NearSurface, IsTheNearestOfAll) {
  const auto found = nearest_surface(rough_table(), Vec3(0, 0, 0.06), 0.05);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->distance, 0.01, 1e-12);
  EXPECT_NEAR((found->point - Vec3(0, 0, 0.07)).norm(), 0, 1e-12);
  EXPECT_EQ(found->material.friction_static, 0);
  EXPECT_FALSE(nearest_surface(rough_table(), Vec3(1, 0, 0.2), 0.05));
}

TEST(NearSurface, GivesContactsTheFrictionOfWhatTheyTouch) {
  ViewState state = touched_with(Vec3(0, 0, 1));
  add_surfaces(rough_table(), state);
  EXPECT_EQ(state.contacts[0].friction, 0.6);
  EXPECT_TRUE(state.contacts[0].normal.isApprox(Vec3::UnitZ()));
  EXPECT_FALSE(state.contacts[0].slips);
}

TEST(NearSurface, GivesContactsOfASmoothSurfaceNone) {
  Scene smooth = rough_table();
  for (Object& object : smooth.objects) {
    object.material.friction_static = object.material.friction_kinetic = 0;
  }
  ViewState state = touched_with(Vec3(0.5, 0, 1));
  add_surfaces(smooth, state);
  EXPECT_EQ(state.contacts[0].friction, 0);
  EXPECT_FALSE(state.contacts[0].slips);
}

TEST(NearSurface, TellsSlippingFromSticking) {
  for (const auto& [along, slips] :
       {std::pair(0.0, false), {0.2, false}, {0.4, true}, {0.5, false}, {0.6, true}}) {
    ViewState state = touched_with(2 * Vec3(0, along, 1));
    add_surfaces(rough_table(), state);
    EXPECT_EQ(state.contacts[0].slips, slips) << along;
  }
}

TEST(NearSurface, ShadesWhereTheTipIsNear) {
  ViewState state;
  state.proxy.links.push_back(Pose::Identity());
  state.proxy.tip = Vec3(0.3, 0, 0.02);
  add_surfaces(rough_table(), state);
  ASSERT_TRUE(state.shade);
  EXPECT_TRUE(state.shade->position.isApprox(Vec3(0.3, 0, 0)));
  EXPECT_NEAR(state.shade->height, 0.02, 1e-12);
  state.proxy.tip.z() = 0.3;
  add_surfaces(rough_table(), state);
  EXPECT_FALSE(state.shade);
}

// Bodies are where their poses say, each where its own does.
TEST(NearSurface, IsOnTheBodyThatIsThere) {
  Scene scene;
  for (const double at : {0.0, 0.2}) {
    Object ball{"ball", pose_at(Vec3(at, 0, 0)), Sphere{0.03}};
    ball.body.emplace();
    scene.add(ball);
  }
  const std::vector<Pose> bodies{pose_at(Vec3(0, 0.5, 0)), pose_at(Vec3(0.2, 0.5, 0))};
  for (const Pose& body : bodies) {
    const Vec3 at = body.translation() + Vec3(0, 0, 0.04);
    const auto found = nearest_surface(scene, at, 0.02, bodies);
    ASSERT_TRUE(found) << at.transpose();
    EXPECT_NEAR(found->distance, 0.01, 1e-12);
  }
  EXPECT_FALSE(nearest_surface(scene, Vec3(0.2, 0, 0.04), 0.02, bodies)) << "it has left";
}

}  // namespace
}  // namespace limpid
