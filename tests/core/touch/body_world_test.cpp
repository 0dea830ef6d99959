#include "core/touch/body_world.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/dynamics/random.h"
#include "tests/support/body_worlds.h"
#include "tests/support/tick.h"

namespace limpid::test {
namespace {

TEST(BodyWorld, AFreeBodyTumblesWithoutLosingEnergyOrAngularMomentum) {
  Scene scene;
  scene.gravity.setZero();
  const Vec3 size(0.03, 0.05, 0.01);
  scene.add(body("slab", Box{size}, 0.05, {0.1, -0.2, 0.3}));
  BodyWorld world(scene);
  std::vector<double> numbers = state(world);
  const Vec3 spin(12, 15, -10);
  std::copy_n(spin.data(), 3, numbers.begin() + 10 + 15);
  ASSERT_TRUE(world.read(numbers));
  const Vec3 squares = size.cwiseProduct(size);
  const Vec3 I =
      0.05 / 12 *
      Vec3(squares.y() + squares.z(), squares.z() + squares.x(), squares.x() + squares.y());
  const auto momentum = [&] {
    const Mat3& R = world.pose(0).linear();
    return Vec3(R * I.cwiseProduct(R.transpose() * world.spin(0)));
  };
  const Vec3 at_first = momentum();
  run(world, 10000);
  const double energy = 0.5 * spin.dot(I.cwiseProduct(spin));
  EXPECT_NEAR(world.energy(), energy, 1e-9 * energy);
  EXPECT_LT((momentum() - at_first).norm(), 2e-4 * at_first.norm());
  EXPECT_LT((world.center(0) - Vec3(0.1, -0.2, 0.3)).norm(), 1e-15);
}

TEST(BodyWorld, AFreeBodyFallsAsTheMidpointRuleSays) {
  Scene scene;
  scene.gravity = {0.3, -1, -9.81};
  scene.add(body("ball", Sphere{0.02}, 0.05, {0, 0, 1}));
  BodyWorld world(scene);
  run(world, 400);
  EXPECT_LT((world.center(0) - (Vec3(0, 0, 1) + 0.08 * scene.gravity)).norm(), 1e-13);
  EXPECT_LT((world.speed(0) - 0.4 * scene.gravity).norm(), 1e-13);
}

TEST(BodyWorld, APendulumKeepsItsEnergyAndItsPeriod) {
  Scene scene;
  Object rod = body("rod", Box{{0.01, 0.01, 0.1}}, 0.05, {0, 0, -0.05});
  BodyJoint& joint = rod.body->joint.emplace();
  joint.kind = BodyJoint::Kind::hinge;
  joint.axis = Vec3::UnitY();
  joint.point = {0, 0, 0.05};
  scene.add(rod);
  BodyWorld world(scene);
  std::vector<double> numbers = state(world);
  numbers[10 + 18] = 0.02;  // a small swing [rad]
  ASSERT_TRUE(world.read(numbers));
  EXPECT_LT(run(world, 20000), 1e-12);
  EXPECT_GT(world.gain(), -1e-12);
  // Period by linear interpolation of upward crossings of the middle.
  std::vector<double> crossings;
  double before = world.joint(0);
  for (int k = 0; crossings.size() < 21; ++k) {
    run(world, 1);
    const double now = world.joint(0);
    if (before < 0 && now >= 0) crossings.push_back(T * (k + before / (before - now)));
    before = now;
  }
  const double I = 0.05 / 12 * (0.01 * 0.01 + 0.1 * 0.1) + 0.05 * 0.05 * 0.05;
  const double period = 2 * M_PI * std::sqrt(I / (0.05 * 9.81 * 0.05));
  EXPECT_NEAR((crossings.back() - crossings.front()) / 20, period, 1e-4 * period);
}

TEST(BodyWorld, ABlockSlidesAsCoulombSays) {
  for (const double friction : {0.2, 0.5}) {
    Scene scene;
    const double slope = 0.35;  // [rad]: tan 0.365
    scene.gravity = 9.81 * Vec3(std::sin(slope), 0, -std::cos(slope));
    scene.add(floor_at(0));
    scene.add(body("block", Box{{0.04, 0.04, 0.01}}, 0.1, {0, 0, 0.00499}, friction));
    BodyWorld world(scene);
    run(world, 500);
    const double pull = std::sin(slope) - friction * std::cos(slope);
    EXPECT_NEAR(world.center(0).x(), std::max(0.0, 0.5 * 9.81 * pull * 0.25), 1e-3) << friction;
  }
}

TEST(BodyWorld, WhatRestsSinksByItsWeightOverItsContactsStiffness) {
  Scene scene;
  scene.add(floor_at(0));
  scene.add(body("ball", Sphere{0.015}, 0.05, {0, 0, 0.015}));
  BodyWorld world(scene);
  run(world, 400);
  EXPECT_NEAR(0.015 - world.center(0).z(), 0.05 * 9.81 / 20000, 1e-8);
}

// A sliding disc keeps its contact points with the plane.
TEST(BodyWorld, WhatSlidesDoesNotSink) {
  for (const double mass : {0.005, 0.5}) {
    Scene scene;
    Object floor = floor_at(0);
    floor.material.friction_static = floor.material.friction_kinetic = 0.02;
    scene.add(floor);
    scene.add(body("puck", Cylinder{0.016, 0.012}, mass, {0, 0, 0.006}, 0.02));
    BodyWorld world(scene);
    run(world, 200);
    const double before = world.center(0).z();
    for (int k = 0; k < 1000; ++k) {
      world.touch(0);
      world.begin(T);
      const Vec3 push = k < 300 ? Vec3(mass, 0, 0) : Vec3::Zero();
      world.push(world.end_at(0, world.center(0)), push);
      world.settle();
      world.finish();
    }
    EXPECT_GT(world.center(0).x(), 0.05) << mass;
    EXPECT_NEAR(world.center(0).z(), before, 1e-5) << mass;
    EXPECT_GT(world.pose(0).linear()(2, 2), std::cos(0.004)) << mass;
  }
}

// The ball leaves with its speed times the restitution, and without turning, as the floor is
// smooth. The masses are so large that a bounce takes many ticks.
TEST(BodyWorld, ABallBouncesAsItsRestitutionSays) {
  for (const double mass : {0.03, 0.5}) {
    for (const double restitution : {0.6, 0.9, 0.97}) {
      Scene scene;
      scene.gravity.setZero();
      scene.add(floor_at(0));
      Object ball = body("ball", Sphere{0.01}, mass, {0, 0, 0.03}, 0);
      ball.body->restitution = restitution;
      scene.add(ball);
      BodyWorld world(scene);
      world.begin(T);
      world.push(world.end_at(0, world.center(0)), Vec3(0, 0, -mass / T));
      world.finish();
      EXPECT_NEAR(world.speed(0).z(), -1, 1e-9);
      run(world, 80);
      EXPECT_NEAR(world.speed(0).z(), restitution, 0.02) << mass;
      EXPECT_LT(world.spin(0).norm(), 1e-6) << mass;
    }
  }
}

// Rolling loses nothing, and the ball stays as deep as its weight presses it in.
TEST(BodyWorld, ABallRollsOnWithoutSinking) {
  Scene scene;
  scene.add(floor_at(0));
  scene.add(body("ball", Sphere{0.015}, 0.05, {0, 0, 0.015}));
  BodyWorld world(scene);
  run(world, 300);
  world.touch(0);
  world.begin(T);
  world.push(world.end_at(0, world.center(0) + Vec3(0, 0, 0.006)), Vec3(0.05 * 0.5 / T, 0, 0));
  world.settle();
  world.finish();
  run(world, 2000);
  EXPECT_NEAR(world.speed(0).x(), 0.5, 1e-3);
  EXPECT_NEAR(world.spin(0).y(), 0.5 / 0.015, 0.1);
  EXPECT_NEAR(0.015 - world.center(0).z(), 0.05 * 9.81 / 20000, 1e-7);
}

// Blocks turned against each other meet in eight corners; four of them count, in changing choice.
TEST(BodyWorld, AStackStandsStillAndSleeps) {
  Scene scene;
  scene.add(floor_at(0));
  Random random(3);
  for (int i = 0; i < 5; ++i) {
    Object o =
        body("block " + std::to_string(i), Box{Vec3::Constant(0.02)}, 0.006,
             {random.between(-0.001, 0.001), random.between(-0.001, 0.001), 0.01 + 0.02 * i});
    o.pose.linear() = turned(random.between(-0.3, 0.3), Vec3::UnitZ());
    scene.add(o);
  }
  BodyWorld world(scene);
  run(world, 4000);
  EXPECT_EQ(world.awake(), 0);
  for (int i = 0; i < 5; ++i) {
    EXPECT_LT((world.center(i) - scene.objects[static_cast<std::size_t>(i) + 1].pose.translation())
                  .norm(),
              1e-4)
        << i;
  }
}

// Two balls are a Newton's cradle.
TEST(BodyWorld, ABallHandsItsSpeedOnToAnother) {
  Scene scene;
  scene.gravity.setZero();
  for (const double x : {0.0, 0.03}) {
    Object ball = body("ball at " + std::to_string(x), Sphere{0.01}, 0.03, {x, 0, 0}, 0);
    ball.body->restitution = 1;
    scene.add(ball);
  }
  BodyWorld world(scene);
  world.begin(T);
  world.push(world.end_at(0, world.center(0)), Vec3(0.03 * 0.5 / T, 0, 0));
  world.finish();
  run(world, 100);
  EXPECT_LT(world.speed(0).norm(), 0.005);
  EXPECT_NEAR(world.speed(1).x(), 0.5, 0.005);
}

TEST(BodyWorld, ABallOnABallSinksByItsWeight) {
  Scene scene;
  scene.add(floor_at(0));
  scene.add(body("below", Sphere{0.01}, 0.05, {0, 0, 0.01}));
  scene.add(body("above", Sphere{0.01}, 0.05, {0, 0, 0.03}));
  BodyWorld world(scene);
  run(world, 60);  // before it rolls off
  EXPECT_NEAR(0.02 - (world.center(1).z() - world.center(0).z()), 0.05 * 9.81 / 20000, 1e-6);
}

// The bodies are not pressed in so far that they come out on the other side.
TEST(BodyWorld, MakesNoEnergyWhateverFallsOnWhatever) {
  Random random(7);
  const std::array<Shape, 4> shapes{Box{{0.03, 0.02, 0.04}}, Sphere{0.015}, Cylinder{0.012, 0.03},
                                    Capsule{0.01, 0.02}};
  for (int trial = 0; trial < 8; ++trial) {
    Scene scene;
    scene.add(floor_at(0));
    for (int i = 0; i < 5; ++i) {
      const double mass = random.log_between(0.005, 0.1);
      Object o =
          body("body " + std::to_string(i), shapes[static_cast<std::size_t>((i + trial) % 4)], mass,
               {0.005 * i, 0.003 * i, 0.03 + 0.05 * i}, 0.3);
      o.pose.linear() = turned(random.between(-3, 3), Vec3(1, 2, random.between(-1, 1)));
      o.body->contact_stiffness = random.log_between(10000, 50000);
      scene.add(o);
    }
    BodyWorld world(scene);
    EXPECT_LT(run(world, 2500), 1e-6) << trial;
    for (int i = 0; i < 5; ++i) EXPECT_GT(world.center(i).z(), 0.004) << trial << " " << i;
  }
}

// Depths by hand: four contact points of 20,000 N/m each below either body, plus the points' depth
// from the fall.
TEST(BodyWorld, CarriesAHeavyBodyOnALightOne) {
  for (const double ratio : {10.0, 100.0, 300.0}) {
    Scene scene;
    scene.add(floor_at(0));
    scene.add(body("light", Box{Vec3::Constant(0.03)}, 0.5 / ratio, {0, 0, 0.015}));
    scene.add(body("heavy", Box{Vec3::Constant(0.03)}, 0.5, {0, 0, 0.055}));  // it falls 1 cm
    BodyWorld world(scene);
    EXPECT_LT(run(world, 4000), 1e-6) << ratio;
    const double first = 0.5 * (1 + 1 / ratio) * 9.81 / 80000, second = 0.5 * 9.81 / 80000;
    EXPECT_NEAR(world.center(0).z(), 0.015 - first, 2e-5) << ratio;
    EXPECT_NEAR(world.center(1).z(), 0.045 - first - second, 1e-3) << ratio;
  }
}

// Stacked blocks sink one after another, from below: a row of springs that a weight presses
// together.
TEST(BodyWorld, StacksSinkByTheWeightAboveOverTheirContacts) {
  Scene scene;
  scene.add(floor_at(0));
  for (int i = 0; i < 10; ++i) {
    scene.add(body("block " + std::to_string(i), Box{Vec3::Constant(0.03)}, 0.02,
                   {0, 0, 0.015 + 0.03 * i}));
  }
  BodyWorld world(scene);
  EXPECT_LT(run(world, 1000), 1e-6);
  double below = -0.015;
  for (int i = 0; i < 10; ++i) {
    const double depth = below + 0.03 - world.center(i).z();
    // A little of the depth was there before anything pressed.
    EXPECT_NEAR(depth, 0.02 * 9.81 * (10 - i) / 80000, 5e-6) << i;
    below = world.center(i).z();
  }
}

TEST(BodyWorld, LaysThinPlatesDownOnTheFloorAndOnEachOther) {
  for (const double thick : {0.0005, 0.001, 0.002}) {
    for (const double tilt : {0.0, 0.2, 0.7, 1.5}) {
      Scene scene;
      scene.add(floor_at(0));
      Object plate = body("plate", Box{{0.1, 0.06, thick}}, 0.02, {0, 0, 0.06});
      plate.pose.linear() = turned(tilt, {1, 0.3, 0});
      scene.add(plate);
      BodyWorld world(scene);
      EXPECT_LT(run(world, 3000), 1e-6) << thick << " " << tilt;
      EXPECT_NEAR(world.center(0).z(), thick / 2, 3e-4) << thick << " " << tilt;
    }
  }
}

// 27 blocks of a cube meet at 432 points, and 64 of a larger one at more than there is room for.
TEST(BodyWorld, CountsThePointsThatItHasNoRoomFor) {
  const auto cube_of = [](int n) {
    Scene scene;
    scene.gravity.setZero();
    for (int i = 0; i < n * n * n; ++i) {
      scene.add(body("block " + std::to_string(i), Box{Vec3::Constant(0.03)}, 0.02,
                     0.03 * Vec3(i % n, i / n % n, i / (n * n))));
    }
    return scene;
  };
  BodyWorld fits(cube_of(3)), full(cube_of(4));
  run(fits, 1);
  run(full, 1);
  EXPECT_EQ(fits.left_out(), 0);
  EXPECT_GT(full.left_out(), 0);
  EXPECT_LT(run(full, 100), 1e-6);
}

TEST(BodyWorld, LosesSightOfWhatIsThrownAwayAndGoesOn) {
  for (const double speed : {100.0, 1e4, 1e8}) {
    Scene scene;
    scene.add(body("thrown", Box{Vec3::Constant(0.03)}, 0.02, {0, 0, 0.2}));
    scene.add(body("falling", Sphere{0.01}, 0.02, {0.5, 0, 0}));
    BodyWorld world(scene);
    std::vector<double> numbers = state(world);
    numbers[10 + 14] = speed;
    ASSERT_TRUE(world.read(numbers));
    EXPECT_LT(run(world, 500), 1e-9 * speed * speed);
    EXPECT_EQ(world.awake(), 1) << speed;
    EXPECT_GT(world.center(0).z(), 20);
    EXPECT_NEAR(world.center(1).z(), -0.5 * 9.81 * 0.25, 1e-9);
  }
}

TEST(BodyWorld, GoesToSleepAndIsWokenByWhatFallsOnIt) {
  Scene scene;
  scene.add(floor_at(0));
  for (int i = 0; i < 3; ++i) {
    scene.add(body("block " + std::to_string(i), Box{Vec3::Constant(0.03)}, 0.02,
                   {0, 0, 0.015 + 0.03 * i}));
  }
  scene.add(body("far", Box{Vec3::Constant(0.03)}, 0.02, {0.2, 0, 0.015}));
  scene.add(body("falling", Sphere{0.01}, 0.02, {0, 0.001, 3}));
  BodyWorld world(scene);
  run(world, 700);
  EXPECT_EQ(world.awake(), 1);
  const std::vector<double> asleep = state(world);
  run(world, 10);
  const std::vector<double> later = state(world);
  EXPECT_TRUE(std::equal(asleep.begin() + 10, asleep.begin() + 10 + 4 * 23, later.begin() + 10));
  run(world, 150);  // it hits the floor at 0.77 s
  EXPECT_EQ(world.awake(), 4);
}

TEST(BodyWorld, GoesOnFromItsNumbersBitForBit) {
  Scene scene;
  scene.add(floor_at(0));
  for (int i = 0; i < 6; ++i) {
    Object o = body("domino " + std::to_string(i), Box{{0.008, 0.025, 0.05}}, 0.02,
                    {0.025 * i, 0, 0.0255});
    if (i == 0) o.pose.linear() = turned(0.25, Vec3::UnitY());
    scene.add(o);
  }
  Object on_string = body("bob", Sphere{0.01}, 0.02, {0, 0.1, 0.1});
  BodyJoint& string = on_string.body->joint.emplace();
  string.kind = BodyJoint::Kind::ball;
  string.point = {0.05, 0, 0};
  scene.add(on_string);
  BodyWorld one(scene), other(scene);
  run(one, 250);  // the third is falling
  ASSERT_TRUE(other.read(state(one)));
  run(one, 500);
  run(other, 500);
  const std::vector<double> a = state(one), b = state(other);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(a, b);
}

// A scene is edited while the loop runs: this gives and makes no energy.
TEST(BodyWorld, GoesOnWithItsBooksInAnotherScene) {
  Scene scene;
  scene.add(floor_at(0));
  scene.add(body("block", Box{Vec3::Constant(0.03)}, 0.02, {0, 0, 0.1}));
  BodyWorld before(scene);
  for (int k = 0; k < 100; ++k) {
    before.touch(0);
    before.begin(T);
    const BodyWorld::End end = before.end_at(0, before.center(0));
    before.push(end, {0.1, 0, 0});
    before.settle();
    before.book(end, {0.1, 0, 0});
    before.finish();
  }
  ASSERT_GT(before.all_given(), 0);
  ASSERT_GT(before.given(), 0);
  scene.add(body("another", Sphere{0.01}, 0.02, {0.2, 0, 0.01}));
  BodyWorld after(scene);
  after.take_over(before);
  EXPECT_EQ(after.given(), before.given());
  EXPECT_EQ(after.all_given(), before.all_given());
  run(after, 1);
  EXPECT_NEAR(after.gain(), before.gain(), 1e-15);
  run(after, 1000);
  EXPECT_LT(after.gain(), 1e-9);
}

TEST(BodyWorld, RefusesNumbersOfAnotherScene) {
  Scene scene;
  scene.add(body("a", Sphere{0.01}, 0.02, {0, 0, 1}));
  BodyWorld one(scene);
  std::vector<double> numbers = state(one);
  scene.add(body("b", Sphere{0.01}, 0.02, {0, 0, 2}));
  BodyWorld two(scene);
  EXPECT_FALSE(two.read(numbers));
  EXPECT_FALSE(two.read({}));
  numbers[20] = std::nan("");
  EXPECT_FALSE(one.read(numbers));
}

// A force F of the arm on a body is answered within the tick by T F / (2 m) at the middle.
TEST(BodyWorld, AnswersAForceWithItsMass) {
  Scene scene;
  scene.gravity.setZero();
  scene.add(body("ball", Sphere{0.02}, 0.05, {0, 0, 0}));
  BodyWorld world(scene);
  world.touch(0);
  world.begin(T);
  const BodyWorld::End end = world.end_at(0, {0, 0, 0.02});
  world.push(end, {0, 0, -2});
  EXPECT_NEAR(world.velocity(end).z(), -2 * T / (2 * 0.05), 1e-15);
  EXPECT_NEAR(world.answer(end)(2, 2), T / (2 * 0.05), 1e-15);
  world.settle();
  world.book(end, {0, 0, -2});
  world.finish();
  EXPECT_NEAR(world.given(), 0.5 * 0.05 * world.speed(0).squaredNorm(), 1e-15);
}

// A tick found no forces for the arm and the bodies it touches.
TEST(BodyWorld, WhatIsHeldForATickOnlyLosesAndThenGoesOn) {
  Scene scene;
  scene.add(floor_at(0));
  scene.add(body("touched", Box{Vec3::Constant(0.03)}, 0.05, {0, 0, 0.0149}));
  scene.add(body("falling", Sphere{0.02}, 0.05, {0.3, 0, 0.5}));
  BodyWorld world(scene);
  run(world, 3);  // the floor is pushing it out
  const double before = world.gain(), speed = world.speed(0).norm();
  ASSERT_GT(speed, 0);
  const Vec3 there = world.center(0), falling = world.center(1);
  world.touch(0);
  world.begin(T);
  const BodyWorld::End end = world.end_at(0, world.center(0) + Vec3(0, 0, 0.015));
  world.push(end, {0, 0, -50});
  world.hold_touched();
  world.settle();
  world.book(end, {0, 0, -50});
  world.finish();
  EXPECT_EQ(world.center(0), there);
  EXPECT_EQ(world.speed(0), Vec3(Vec3::Zero()));
  EXPECT_EQ(world.given(), 0);
  EXPECT_LT(world.center(1).z(), falling.z());
  world.touch(0);
  run(world, 1);
  EXPECT_LE(world.gain(), before + 1e-12);
  EXPECT_EQ(world.awake(), 2);
}

TEST(BodyWorld, AKeyClicksWhereItsTableSays) {
  Scene scene;
  Object key = body("key", Box{{0.012, 0.012, 0.006}}, 0.002, {0, 0, 0});
  BodyJoint& joint = key.body->joint.emplace();
  joint.axis = -Vec3::UnitZ();
  joint.low = 0;
  joint.high = 0.0096;
  joint.force.travel = {{0, 0.5}, {0.002, 0.9}, {0.006, 0.1}, {0.0096, 0.9}};
  scene.add(key);
  BodyWorld world(scene);
  // Pressed with 0.6 N the key rests where its table says; with 1.2 N at the end.
  const double weight = 0.002 * 9.81;
  for (const auto& [force, rest] : {std::pair{0.6, 0.0005 * (0.1 + weight) / 0.1},
                                    std::pair{1.2, 0.0096 + (0.3 + weight) / 20000}}) {
    for (int k = 0; k < 3000; ++k) {
      world.touch(0);
      world.begin(T);
      // A damper of the test's own brings the key to rest.
      const BodyWorld::End end = world.end_at(0, world.center(0));
      world.push(end, {0, 0, -force - 0.5 * world.speed(0).z()});
      world.settle();
      world.finish();
    }
    EXPECT_NEAR(world.joint(0), rest, 2e-6) << force;
  }
}

}  // namespace
}  // namespace limpid::test
