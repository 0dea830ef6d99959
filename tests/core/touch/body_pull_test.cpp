// Bodies that are pulled on from outside, without an arm.
#include <gtest/gtest.h>

#include <cmath>

#include "core/dynamics/random.h"
#include "core/touch/body_world.h"
#include "tests/support/body_worlds.h"

namespace limpid::test {
namespace {

constexpr double kSwing = 25;      // frequency of the pull's spring with the body [rad/s]
constexpr double kLongest = 0.12;  // distance beyond which the pull grows no further [m]

TEST(BodyPull, HoldsABodyAsFarBelowTheTargetWhateverItsMass) {
  for (const double mass : {0.0005, 0.05, 5.0}) {
    Scene scene;
    scene.add(body("ball", Sphere{0.02}, mass, {0.1, 0, 0.2}));
    BodyWorld world(scene);
    const Vec3 target(0.1, 0.01, 0.21);
    world.pull({0, Vec3::Zero(), target});
    const double gain = run(world, 1500);
    const Vec3 expected = target - Vec3(0, 0, 9.81 / (kSwing * kSwing));
    EXPECT_LT((world.center(0) - expected).norm(), 1e-9) << mass;
    EXPECT_LT(world.speed(0).norm(), 1e-9) << mass;
    EXPECT_LE(gain, 1e-13 * mass) << mass;
  }
}

// x(t) = x0 (1 + w t) exp(-w t), to the order of the tick.
TEST(BodyPull, BringsABodyToRestAsACriticallyDampedSpringDoes) {
  Scene scene;
  scene.gravity.setZero();
  scene.add(body("ball", Sphere{0.02}, 0.05, {0, 0, 0}));
  BodyWorld world(scene);
  const double x0 = 0.02;
  world.pull({0, Vec3::Zero(), {x0, 0, 0}});
  for (int k = 1; k <= 300; ++k) {
    run(world, 1);
    const double wt = kSwing * 1e-3 * k;
    EXPECT_NEAR(x0 - world.center(0).x(), x0 * (1 + wt) * std::exp(-wt), 0.02 * x0) << k;
  }
}

// A slow lift gives the weight times the way, plus little for the tick's losses.
TEST(BodyPull, GivesWhatItsWorkIs) {
  const double mass = 0.08, sag = 9.81 / (kSwing * kSwing);
  Scene scene;
  scene.add(body("slab", Box{{0.03, 0.05, 0.01}}, mass, {0.1, -0.2, 0.3}));
  BodyWorld world(scene);
  double gain = -1;
  for (int k = 0; k < 3000; ++k) {
    const double part = std::min(1.0, k / 2000.0);
    const double rise = 0.05 * (1 - std::cos(3.14159265358979 * part));
    world.pull({0, Vec3::Zero(), {0.1, -0.2, 0.3 + sag + rise}});
    gain = std::max(gain, run(world, 1));
  }
  ASSERT_NEAR(world.center(0).z(), 0.4, 1e-6);
  const double given = mass * 9.81 * 0.1;
  EXPECT_NEAR(world.all_pulled(), given, 0.01 * given);
  EXPECT_LE(gain, 1e-13);
}

// Swung round and turned in any way, the body gains no energy from nowhere.
TEST(BodyPull, MakesNoEnergy) {
  Scene scene;
  scene.add(body("slab", Box{{0.03, 0.05, 0.01}}, 0.08, {0.1, -0.2, 0.3}));
  BodyWorld world(scene);
  double gain = -1, fastest = 0;
  for (int k = 0; k < 3000; ++k) {
    const double t = 1e-3 * k;
    const Vec3 target(0.1 + 0.1 * std::sin(7 * t), -0.2 + 0.1 * std::cos(5 * t), 0.3 + 0.05 * t);
    world.pull(k % 700 < 500 ? BodyPull{0, {0.015, -0.02, 0.005}, target} : BodyPull{});
    gain = std::max(gain, run(world, 1));
    fastest = std::max(fastest, world.spin(0).norm());
  }
  EXPECT_GT(fastest, 5);
  EXPECT_LE(gain, 1e-12);
}

TEST(BodyPull, PullsNoHarderThanItIsAllowedTo) {
  Scene scene;
  scene.gravity.setZero();
  scene.add(body("ball", Sphere{0.02}, 0.5, {0, 0, 0}));
  BodyWorld world(scene);
  world.pull({0, Vec3::Zero(), {3, 4, 0}});
  double most = 0;
  for (int k = 0; k < 300; ++k) {
    const Vec3 before = world.speed(0);
    run(world, 1);
    most = std::max(most, (world.speed(0) - before).norm() / 1e-3);
  }
  EXPECT_LE(most, kSwing * kSwing * kLongest * (1 + 1e-9));
  EXPECT_GT(most, 0.8 * kSwing * kSwing * kLongest);
}

TEST(BodyPull, WakesWhatSleeps) {
  Scene scene;
  scene.add(floor_at(0));
  scene.add(body("block", Box{{0.03, 0.03, 0.03}}, 0.05, {0, 0, 0.015}));
  BodyWorld world(scene);
  run(world, 2000);
  ASSERT_EQ(world.awake(), 0);
  world.pull({0, Vec3::Zero(), {0, 0, 0.1}});
  run(world, 1000);
  EXPECT_GT(world.center(0).z(), 0.07);
  world.pull({});
  run(world, 3000);
  EXPECT_NEAR(world.center(0).z(), 0.015, 1e-3);
  EXPECT_EQ(world.awake(), 0);
}

TEST(BodyPull, OfABodyThatIsNotThereIsNone) {
  Scene scene;
  scene.gravity.setZero();
  scene.add(body("ball", Sphere{0.02}, 0.5, {0, 0, 0}));
  BodyWorld world(scene);
  world.pull({7, Vec3::Zero(), {1, 0, 0}});
  run(world, 10);
  EXPECT_EQ(world.center(0), Vec3::Zero());
  EXPECT_EQ(world.all_pulled(), 0);
}

// A pull at the axis moves nothing; elsewhere the door turns to the target.
TEST(BodyPull, TurnsWhatIsOnAHinge) {
  for (const bool of_world : {true, false}) {
    Scene scene;
    scene.gravity.setZero();
    if (!of_world) scene.add(body("frame", Box{{0.2, 0.2, 0.02}}, 1e5, {0, 0, -0.5}));
    Object door = body("door", Box{{0.1, 0.01, 0.1}}, 0.1, {0.05, 0, 0});
    BodyJoint& joint = door.body->joint.emplace();
    joint.kind = BodyJoint::Kind::hinge;
    joint.point = {-0.05, 0, 0};
    if (!of_world) joint.to = "frame";
    scene.add(door);
    BodyWorld world(scene);
    const int number = world.count() - 1;
    world.pull({number, {-0.05, 0, 0.03}, {0, 0.02, 0.03}});
    EXPECT_LE(run(world, 500), 1e-12);
    EXPECT_LT((world.center(number) - Vec3(0.05, 0, 0)).norm(), of_world ? 1e-12 : 1e-4);
    world.pull({number, {0.05, 0, 0}, {0.03, 0.1, 0}});
    EXPECT_LE(run(world, 1500), 1e-12);
    const Vec3 tip = world.pose(number) * Vec3(0.05, 0, 0);
    EXPECT_LT((tip - 0.1 * Vec3(0.03, 0.1, 0).normalized()).norm(), 1e-3) << of_world;
  }
}

}  // namespace
}  // namespace limpid::test
