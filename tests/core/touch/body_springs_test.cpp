// Springs between points of bodies, against what oscillators and pendulums do: without a damper
// they neither make nor lose energy, however they turn.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/dynamics/random.h"
#include "tests/support/body_worlds.h"

namespace limpid::test {
namespace {

Vec3 any(Random& random, double size) {
  return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}

// Energy over the run, less that at its start, at most and at least [J].
struct Drift {
  double most = 0, least = 0, size = 0;  // size: the largest kinetic energy that was seen
};
Drift drift(BodyWorld& world, int ticks) {
  Drift all;
  run(world, 1);
  const double first = world.energy();
  for (int k = 1; k < ticks; ++k) {
    run(world, 1);
    all.most = std::max(all.most, world.energy() - first);
    all.least = std::min(all.least, world.energy() - first);
    for (int i = 0; i < world.count(); ++i)
      all.size = std::max(all.size, 0.5 * 0.01 * world.speed(i).squaredNorm());
  }
  return all;
}

TEST(BodySprings, OfAnyPointsKeepTheEnergyOfWhatTheyHold) {
  Random random(5150);
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    Scene scene;
    scene.gravity = i % 3 == 0 ? Vec3(0, 0, -9.81) : Vec3(Vec3::Zero());
    const double mass = random.between(0.01, 0.5);
    const Vec3 size = Vec3(0.03, 0.03, 0.03) + any(random, 0.02);
    Object one = body("one", Box{size}, mass, {0.9, 1.1, 0.7});
    one.pose.linear() = turned(random.between(-3, 3), any(random, 1));
    scene.add(one);
    BodySpring spring;
    spring.between = {"one", ""};
    spring.points = {any(random, 0.02), Vec3(0.9, 1.1, 0.7) + any(random, 0.2)};
    spring.stiffness = std::pow(10, random.between(0, 3));
    spring.length = i % 4 == 0 ? 0 : random.between(0, 0.2);
    scene.springs.push_back(spring);
    if (i % 2 == 1) {
      scene.add(body("two", Sphere{0.01}, random.between(0.01, 0.5),
                     Vec3(0.9, 1.1, 0.7) + any(random, 0.15)));
      spring.between = {"one", "two"};
      spring.points[1] = any(random, 0.008);
      scene.springs.push_back(spring);
    }
    BodyWorld world(scene);
    const Drift d = drift(world, 4000);
    EXPECT_EQ(world.stood_still(), 0);
    EXPECT_LT(d.most, 1e-8 * std::max(d.size, 1e-3));
    const double lost = world.count() > 1 ? 0 : -d.least;  // two may meet, and lose some
    EXPECT_LT(lost, 1e-6 * std::max(d.size, 1e-3));
  }
}

// On a slider, a spring of no length beside the rail is as one on it: x'' = -k/m x.
TEST(BodySprings, BesideARailSwingAsThoseOnIt) {
  for (const double beside : {0.0, 0.05}) {
    SCOPED_TRACE(beside);
    Scene scene;
    Object ball = body("ball", Sphere{0.01}, 0.05, {0.9, 1.1, 0.7});
    BodyJoint& rail = ball.body->joint.emplace();
    rail.kind = BodyJoint::Kind::slider;
    rail.axis = Vec3::UnitX();
    scene.add(ball);
    BodySpring spring;
    spring.between = {"ball", ""};
    spring.points = {Vec3::Zero(), Vec3(1.0, 1.1 + beside, 0.7)};
    spring.stiffness = 100;
    scene.springs.push_back(spring);
    BodyWorld world(scene);
    // The midpoint rule's frequency: tan(w T/2) = w0 T/2.
    const double w = 2 / kTick * std::atan(std::sqrt(100 / 0.05) * kTick / 2);
    for (int k = 1; k <= 3000; ++k) {
      run(world, 1);
      ASSERT_NEAR(world.center(0).x(), 1.0 - 0.1 * std::cos(w * kTick * k), 1e-9) << k;
    }
  }
}

// A ball on a spring of no length under gravity is an oscillator in each direction.
TEST(BodySprings, OfNoLengthMakeOscillatorsOfWhatHangsOnThem) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  scene.add(body("ball", Sphere{0.01}, 0.05, {0.95, 1.13, 0.7}));
  BodySpring spring;
  spring.between = {"ball", ""};
  spring.points = {Vec3::Zero(), Vec3(0.9, 1.1, 0.75)};
  spring.stiffness = 20;
  scene.springs.push_back(spring);
  BodyWorld world(scene);
  const Vec3 rest = Vec3(0.9, 1.1, 0.75) + 0.05 / 20 * scene.gravity;
  const double w = 2 / kTick * std::atan(std::sqrt(20 / 0.05) * kTick / 2);
  for (int k = 1; k <= 6000; ++k) {
    run(world, 1);
    const Vec3 is = rest + std::cos(w * kTick * k) * (Vec3(0.95, 1.13, 0.7) - rest);
    ASSERT_LT((world.center(0) - is).norm(), 1e-9) << k;
  }
}

// In a circle around its anchor m v^2/r = k (r - L); the angular momentum stays to round-off.
TEST(BodySprings, CarryABallRoundTheirAnchor) {
  const double k = 30, length = 0.1, r = 0.16, m = 0.05;
  Scene scene;
  scene.gravity.setZero();
  scene.add(body("ball", Sphere{0.01}, m, {0.9 + r, 1.1, 0.7}));
  BodySpring spring;
  spring.between = {"ball", ""};
  spring.points = {Vec3::Zero(), Vec3(0.9, 1.1, 0.7)};
  spring.stiffness = k;
  spring.length = length;
  scene.springs.push_back(spring);
  BodyWorld world(scene);
  const double v = std::sqrt(k * (r - length) * r / m);
  world.set_speed(0, {0, 0.6 * v, 0.8 * v}, Vec3::Zero());
  const auto momentum = [&] {
    return Vec3(m * (world.center(0) - Vec3(0.9, 1.1, 0.7)).cross(world.speed(0)));
  };
  const Vec3 first = momentum();
  for (int tick = 0; tick < 5000; ++tick) {
    run(world, 1);
    ASSERT_NEAR((world.center(0) - Vec3(0.9, 1.1, 0.7)).norm(), r, 1e-4 * r);
    ASSERT_LT((momentum() - first).norm(), 1e-10 * first.norm());
  }
}

TEST(BodySprings, WithADamperOnlyLose) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  Object block = body("block", Box{Vec3(0.04, 0.03, 0.02)}, 0.06, {0.9, 1.1, 0.7});
  block.pose.linear() = turned(0.7, {0.3, 1, 0.2});
  scene.add(block);
  BodySpring spring;
  spring.between = {"block", ""};
  spring.points = {Vec3(0.02, 0.015, 0.01), Vec3(0.93, 1.12, 0.78)};
  spring.stiffness = 60;
  spring.length = 0.03;
  spring.damping = 0.02;
  scene.springs.push_back(spring);
  BodyWorld world(scene);
  run(world, 1);
  double before = world.energy();
  for (int tick = 0; tick < 10000; ++tick) {
    run(world, 1);
    ASSERT_LT(world.energy(), before + 1e-12);
    before = world.energy();
  }
}

}  // namespace
}  // namespace limpid::test
