// Drawn items of a scene.
#include "render/scene_items.h"

#include <gtest/gtest.h>

#include "tests/support/random_arm.h"

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

}  // namespace
}  // namespace limpid
