// Bodies on flat models of many triangles, with edges at places that are drawn: as on a plane, by
// the laws of slopes.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/body_worlds.h"
#include "tests/support/meshes.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;

// A level sheet of triangles whose corners are drawn but for the height, 0.6 m wide.
Object level_model(Random& random, int parts, double friction) {
  test::Triangles flat = test::grid(parts, parts);
  const double shake = 0.3 / parts;
  flat = flat.mapped([&](const Vec3& v) {
    const Vec3 more(random.between(-shake, shake), random.between(-shake, shake), 0);
    return Vec3(0.6 * (v + more - Vec3(0.5, 0.5, 0)));
  });
  Object floor = test::obstacle(flat, 1000);
  floor.material = {1000, 0, friction, friction};
  return floor;
}

struct Incline {
  Vec3 moved = Vec3::Zero();         // [m]
  Vec3 acceleration = Vec3::Zero();  // over the second half [m/s^2]
  Vec3 end = Vec3::Zero();           // [m]
};

Incline run_down(const Scene& scene, int ticks) {
  BodyWorld world(scene);
  const Vec3 start = world.pose(0).translation();
  test::run(world, ticks / 2);
  const Vec3 half = world.pose(0).translation();
  test::run(world, ticks / 2);
  Incline slope;
  slope.end = world.pose(0).translation();
  slope.moved = slope.end - start;
  // From rest: x = a t^2 / 2 in each half.
  const double t = ticks * test::kTick;
  slope.acceleration = (slope.end - half) * 8 / (3 * t * t);
  return slope;
}

TEST(BodiesOnModels, BallsRollAsOnAPlane) {
  Random random(71);
  for (const int parts : {4, 20, 60}) {
    SCOPED_TRACE(parts);
    Scene scene;
    scene.gravity = Vec3(1.0, 0, -9.76);
    scene.add(level_model(random, parts, 0.6));
    const double r = random.between(0.008, 0.02);
    const Vec3 at(-0.1, random.between(-0.05, 0.05), r);
    scene.add(test::body("ball", Sphere{r}, 0.05, at, 0.6));
    const Incline s = run_down(scene, 600);
    EXPECT_NEAR(s.acceleration.x(), 5.0 / 7, 0.02 * 5 / 7);
    EXPECT_NEAR(s.moved.y(), 0, 1e-3 * s.moved.x());  // a millimetre in a metre
    EXPECT_NEAR(s.end.z(), r, 1e-4);
  }
}

// The way leads along a row of edges, over every corner there.
TEST(BodiesOnModels, BallsRollOverCornersAsOnAPlane) {
  for (const int parts : {6, 60}) {
    SCOPED_TRACE(parts);
    Scene scene;
    scene.gravity = Vec3(1.0, 0, -9.76);
    Object floor = test::obstacle(test::sheet(parts, 0.6), 1000);
    floor.material = {1000, 0, 0.6, 0.6};
    scene.add(floor);
    scene.add(test::body("ball", Sphere{0.01}, 0.05, Vec3(-0.09, 0, 0.01), 0.6));
    const Incline s = run_down(scene, 600);
    EXPECT_NEAR(s.acceleration.x(), 5.0 / 7, 0.01 * 5 / 7);
    EXPECT_NEAR(s.moved.y(), 0, 1e-4 * s.moved.x());
    EXPECT_NEAR(s.end.z(), 0.01, 3e-5);
  }
}

TEST(BodiesOnModels, CubesSlideAsOnAPlane) {
  Random random(72);
  for (const int parts : {4, 20, 60}) {
    SCOPED_TRACE(parts);
    Scene scene;
    const double steep = M_PI / 6;
    scene.gravity = 9.81 * Vec3(std::sin(steep), 0, -std::cos(steep));
    scene.add(level_model(random, parts, 0.2));
    const Vec3 at(-0.2, random.between(-0.05, 0.05), 0.02);
    scene.add(test::body("cube", Box{Vec3::Constant(0.04)}, 0.1, at, 0.2));
    const Incline s = run_down(scene, 400);
    const double a = 9.81 * (std::sin(steep) - 0.2 * std::cos(steep));
    EXPECT_NEAR(s.acceleration.x(), a, 0.02 * a);
    EXPECT_NEAR(s.moved.y(), 0, 1e-3 * s.moved.x());
    EXPECT_NEAR(s.end.z(), 0.02, 1e-4);
  }
}

TEST(BodiesOnModels, CubesRestAsOnAPlane) {
  Random random(73);
  for (const int parts : {4, 20, 60}) {
    SCOPED_TRACE(parts);
    Scene scene;
    scene.add(level_model(random, parts, 0.5));
    scene.add(test::body("cube", Box{Vec3::Constant(0.04)}, 0.1, Vec3(0.01, 0.02, 0.02)));
    const Incline s = run_down(scene, 2000);
    EXPECT_NEAR(s.end.z(), 0.02 - 0.1 * 9.81 / (4 * 20000), 2e-6);
    EXPECT_LT(s.moved.head<2>().norm(), 1e-5);
  }
}

}  // namespace
}  // namespace limpid
