// Bodies so quick that they could pass a thing between two ticks.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/body_worlds.h"
#include "tests/support/meshes.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;

constexpr double kQuick = 10;  // [m/s]

Object without_friction(Object object) {
  object.material = {1000, 0, 0, 0};
  return object;
}

// Plates that stand still, 0.3 m wide, of this thickness around z = 0, as every kind of object.
std::vector<Object> plates(double thick) {
  std::vector<Object> all(2);
  all[0].shape = Box{{0.3, 0.3, thick}};
  all[1].shape = Cylinder{0.15, thick};
  all.push_back(test::obstacle(test::sheet(6, 0.3)));
  for (Object& plate : all) plate = without_friction(plate);
  return all;
}

// A small ball of plastic, a slab that is turned at random, and a peg.
std::vector<Object> bullets(Random& random, const Vec3& at) {
  std::vector<Object> all = {test::body("ball", Sphere{0.003}, 1e-3, at),
                             test::body("slab", Box{{0.02, 0.02, 0.003}}, 0.01, at),
                             test::body("peg", Cylinder{0.004, 0.012}, 2e-3, at)};
  for (Object& body : all) {
    body = without_friction(body);
    body.pose.linear() = random.rotation();
  }
  return all;
}

TEST(QuickBodies, PassNoPlate) {
  Random random(81);
  for (const double thick : {0.5e-3, 1e-3, 4e-3, 8e-3}) {
    for (const Object& plate : plates(thick)) {
      for (const double restitution : {0.0, 0.5, 1.0}) {
        const Vec3 at(random.between(-0.05, 0.05), random.between(-0.05, 0.05),
                      random.between(0.03, 0.05));
        for (Object& bullet : bullets(random, at)) {
          SCOPED_TRACE(testing::Message() << bullet.name << " on " << plate.shape.index() << ", "
                                          << thick << " m, restitution " << restitution);
          bullet.body->restitution = restitution;
          bullet.body->mass *= random.log_between(0.1, 100);
          Scene scene;
          scene.add(plate);
          scene.add(bullet);
          BodyWorld world(scene);
          world.set_speed(0, {random.between(-4, 4), random.between(-4, 4), -kQuick},
                          random.point(50));
          for (int k = 0; k < 60 && world.center(0).head<2>().norm() < 0.14; ++k) {
            EXPECT_LT(test::run(world, 1), 1e-9);
            ASSERT_GT(world.center(0).z(), 0) << k;
          }
        }
      }
    }
  }
}

TEST(QuickBodies, BounceAsTheirRestitutionSays) {
  Random random(82);
  for (int i = 0; i < 20; ++i) {
    const double e = random.between(0.1, 1), speed = random.between(3, kQuick);
    Scene scene;
    scene.add(plates(4e-3)[0]);
    scene.add(without_friction(
        test::body("ball", Sphere{0.003}, 1e-3, {0, 0, random.between(0.02, 0.03)})));
    scene.objects.back().body->restitution = e;
    scene.gravity.setZero();
    BodyWorld world(scene);
    world.set_speed(0, {0, 0, -speed}, Vec3::Zero());
    test::run(world, 30);
    EXPECT_NEAR(world.speed(0).z(), e * speed, 0.01 * speed) << e;
  }
}

// A slab and a heavy cube that come flat meet a plate with four corners at once.
TEST(QuickBodies, ThatFallFlatBounceFlat) {
  for (const double e : {0.0, 0.5, 1.0}) {
    Scene scene;
    scene.gravity.setZero();
    scene.add(plates(1e-3)[0]);
    scene.add(
        without_friction(test::body("slab", Box{{0.02, 0.02, 0.003}}, 0.01, {-0.05, 0, 0.02})));
    scene.add(without_friction(test::body("cube", Box{{0.03, 0.03, 0.03}}, 1, {0.05, 0, 0.02})));
    scene.objects[1].body->restitution = scene.objects[2].body->restitution = e;
    BodyWorld world(scene);
    world.set_speed(0, {0, 0, -kQuick}, Vec3::Zero());
    world.set_speed(1, {0, 0, -3}, Vec3::Zero());
    EXPECT_LT(test::run(world, 20), 1e-9);
    for (int i = 0; i < 2; ++i) {
      EXPECT_NEAR(world.speed(i).z(), e * (i == 0 ? kQuick : 3), 1e-6) << e;
      EXPECT_LT(world.spin(i).norm(), 1e-3) << e;
    }
  }
}

// Over the border of a plate by less than the way of a tick.
TEST(QuickBodies, FlyOnPastWhatTheyMiss) {
  Scene scene;
  scene.add(plates(4e-3)[0]);
  const double beside = 0.15 + 0.003 + 0.5e-3;
  const Vec3 at(beside, 0, 0.043), start(0, 0, -kQuick);
  scene.add(test::body("ball", Sphere{0.003}, 1e-3, at));
  BodyWorld world(scene);
  world.set_speed(0, start, Vec3::Zero());
  test::run(world, 10);
  const Vec3 right = at + 0.01 * start + 0.5 * scene.gravity * 1e-4;
  EXPECT_LT((world.center(0) - right).norm(), 1e-12);
}

// Lids that lie on the floor, and lids in the air.
TEST(QuickBodies, PassNoBody) {
  Random random(83);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const bool lies = i % 2 == 0;
    const double thick = random.log_between(0.5e-3, 3e-3), speed = random.between(0.5, kQuick);
    Scene scene;
    if (!lies) scene.gravity.setZero();
    if (lies) scene.add(test::floor_at(0));
    const double mass = random.log_between(0.02, 1);
    scene.add(without_friction(
        test::body("lid", Box{{0.1, 0.1, thick}}, mass, {0, 0, lies ? thick / 2 : 0})));
    const Vec3 at(random.between(-0.02, 0.02), random.between(-0.02, 0.02), 0.03);
    const double of_it = random.log_between(1e-4, 0.02);  // a ball of lead weighs 6 g
    scene.add(without_friction(test::body("ball", Sphere{0.005}, of_it, at)));
    BodyWorld world(scene);
    world.set_speed(1, {0, 0, -speed}, Vec3::Zero());
    for (int k = 0; k < 60; ++k) {
      EXPECT_LT(test::run(world, 1), 1e-9);
      const Vec3 above = world.pose(0).inverse() * world.center(1);
      if (above.head<2>().lpNorm<Eigen::Infinity>() > 0.04) break;
      ASSERT_GT(above.z(), 0) << k;
    }
    const Vec3 momentum = mass * world.speed(0) + of_it * world.speed(1);
    if (!lies) {
      EXPECT_NEAR(momentum.z(), -of_it * speed, 1e-6 * of_it * speed);
    }
  }
}

}  // namespace
}  // namespace limpid
