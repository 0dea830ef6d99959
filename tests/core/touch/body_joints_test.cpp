// Joints that springs hold: ball joints, and hinges and sliders on what moves.
#include <gtest/gtest.h>

#include <cmath>

#include "core/dynamics/random.h"
#include "core/touch/joint_forces.h"
#include "tests/support/body_worlds.h"

namespace limpid::test {
namespace {

using Kind = BodyJoint::Kind;

// A ball of 50 g that hangs 10 cm below a joint.
constexpr double kMass = 0.05, kLength = 0.1, kRadius = 0.01, kWeight = kMass * 9.81;
const double kAbout = kMass * (0.4 * kRadius * kRadius + kLength * kLength);

Scene pendulum(double angle, double damping, double friction) {
  Scene scene;
  Object bob = body("bob", Sphere{kRadius}, kMass, Vec3::Zero());
  bob.pose.linear() = turned(angle, Vec3::UnitY());
  bob.pose.translation() = bob.pose.linear() * Vec3(0, 0, -kLength);
  BodyJoint& joint = bob.body->joint.emplace();
  joint.kind = Kind::ball;
  joint.point = {0, 0, kLength};
  joint.damping = damping;
  joint.friction = friction;
  scene.add(bob);
  return scene;
}

double angle_of(const BodyWorld& world) {
  return std::atan2(-world.center(0).x(), -world.center(0).z());
}

// Amplitudes of successive swings, on both sides in turn.
std::vector<double> peaks(BodyWorld& world, std::size_t wanted) {
  std::vector<double> all;
  double before = angle_of(world), rate = 0;
  for (int k = 0; k < 20000 && all.size() < wanted; ++k) {
    run(world, 1);
    const double now = angle_of(world);
    if (rate * (now - before) < 0) all.push_back(std::abs(before));
    rate = now - before;
    before = now;
  }
  return all;
}

TEST(BodyJoints, ADampedBallJointsPendulumFadesAsItShould) {
  const double w = std::sqrt(kWeight * kLength / kAbout);
  for (const double damping : {3e-5, 3e-4, 1e-3}) {
    BodyWorld world(pendulum(0.05, damping, 0));
    const double rate = damping / (2 * kAbout);
    const double period = 2 * M_PI / std::sqrt(w * w - std::pow(damping / (2 * kAbout), 2));
    const std::vector<double> found = peaks(world, 8);
    ASSERT_EQ(found.size(), 8u) << damping;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double expected = 0.05 * std::exp(-rate * period / 2 * static_cast<double>(i + 1));
      EXPECT_NEAR(found[i], expected, 0.01 * expected + 1e-5) << damping << " " << i;
    }
  }
}

// Dry friction ends each half swing nearer to the middle, by twice the friction over the weight's
// stiffness.
TEST(BodyJoints, DryFrictionOfABallJointTakesTheSameOffEverySwing) {
  const double friction = 0.01 * kWeight * kLength;
  BodyWorld world(pendulum(0.105, 0, friction));
  const std::vector<double> found = peaks(world, 4);
  ASSERT_EQ(found.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(found[i], 0.105 - 0.02 * static_cast<double>(i + 1), 1e-3) << i;
  }
  run(world, 5000);
  EXPECT_LE(kWeight * kLength * std::abs(std::sin(angle_of(world))), friction * 1.01);
  EXPECT_EQ(world.awake(), 0);
}

TEST(BodyJoints, ABallJointSticksWhereFrictionBearsTheWeight) {
  const double friction = kWeight * kLength * std::sin(0.3);
  BodyWorld held(pendulum(0.29, 0, friction)), moving(pendulum(0.31, 0, friction));
  const auto stay = [&](int ticks) {  // awake all the time
    for (int k = 0; k < ticks; ++k) {
      held.touch(0);
      run(held, 1);
    }
    return angle_of(held);
  };
  const double first = stay(1000);  // it slips a little while its weight comes on
  EXPECT_NEAR(first, 0.29, 2e-3);
  EXPECT_NEAR(stay(10000), first, 1e-7);
  run(moving, 3000);
  EXPECT_LT(angle_of(moving), 0.305);
  EXPECT_LE(kWeight * kLength * std::abs(std::sin(angle_of(moving))), friction * 1.01);
}

// A ball that only turns follows the tick's rule, computed by hand.
TEST(BodyJoints, WhatABallJointTakesUpIsItsDampersWork) {
  Scene scene;
  scene.gravity.setZero();
  Object ball = body("ball", Sphere{0.02}, 0.05, {0, 0, 0.3});
  BodyJoint& joint = ball.body->joint.emplace();
  joint.kind = Kind::ball;
  joint.damping = 2e-5;
  scene.add(ball);
  BodyWorld world(scene);
  set_moving(world, 0, Vec3::Zero(), {3, -20, 11});
  const double I = 0.4 * 0.05 * 4e-4;
  double lost = 0, first = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vec3 before = world.spin(0);
    if (k == 0) first = 0.5 * I * before.squaredNorm();
    run(world, 1);
    const Vec3 change = world.spin(0) - before;
    const Vec3 mean = before + 0.5 * change;
    EXPECT_LT((I * change + kTick * joint.damping * mean).norm(), 1e-15) << k;
    lost += kTick * joint.damping * mean.squaredNorm();
    ASSERT_NEAR(0.5 * I * world.spin(0).squaredNorm(), first - lost, 1e-15) << k;
  }
  EXPECT_GT(lost, 0.9 * first);
}

// Friction is a torque of constant size against the motion, in every direction.
TEST(BodyJoints, DryFrictionOfABallJointBrakesEvenly) {
  Scene scene;
  scene.gravity.setZero();
  Object ball = body("ball", Sphere{0.02}, 0.05, {0, 0, 0.3});
  BodyJoint& joint = ball.body->joint.emplace();
  joint.kind = Kind::ball;
  joint.friction = 1e-4;
  scene.add(ball);
  BodyWorld world(scene);
  const Vec3 spin(3, -20, 11);
  set_moving(world, 0, Vec3::Zero(), spin);
  const double I = 0.4 * 0.05 * 4e-4, all = spin.norm() * I / joint.friction;  // [s]
  run(world, static_cast<int>(0.5 * all / kTick));
  EXPECT_LT((world.spin(0) - 0.5 * spin).norm(), 0.01 * spin.norm());
  run(world, static_cast<int>(0.6 * all / kTick));
  EXPECT_LT(world.spin(0).norm(), 1e-6);
}

TEST(BodyJoints, TheProjectedTorqueIsWhatItSays) {
  Random random(11);
  int rubbing = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Mat3 R = random.rotation();
    Mat3 W = Mat3::Zero();
    for (int i = 0; i < 3; ++i) W(i, i) = random.log_between(1, 1e5);
    W = R * W * R.transpose();
    const double K = random.log_between(1, 1e5), radius = random.log_between(1e-6, 1);
    const Vec3 z = random.log_between(1e-7, 1e-2) * random.direction();
    const Vec3 b = random.log_between(1e-3, 50) * random.direction();
    const Vec3 l = friction_torque(K, radius, z, kTick, b, W);
    const Vec3 wanted = -K * (z + kTick * (b + W * l));
    const Vec3 held = wanted.norm() > radius ? Vec3(radius * wanted.normalized()) : wanted;
    EXPECT_LT((l - held).norm(), 1e-6 * radius) << trial;
    rubbing += wanted.norm() > radius;
    const Vec3 later = -l / K;
    EXPECT_LE(kTick * l.dot(b + W * l) + 0.5 * K * (later.squaredNorm() - z.squaredNorm()),
              1e-9 * K * z.squaredNorm())
        << trial;
  }
  EXPECT_GT(rubbing, 200);
  EXPECT_LT(rubbing, 1800);
}

// Two bodies on one axis in empty space; one turns against the other.
Scene two_on_an_axis(const BodyJoint& between) {
  Scene scene;
  scene.gravity.setZero();
  scene.add(body("base", Cylinder{0.03, 0.02}, 0.1, {0, 0, 0}));
  Object wheel = body("wheel", Cylinder{0.02, 0.02}, 0.05, {0, 0, 0.03});
  wheel.body->joint = between;
  wheel.body->joint->to = "base";
  wheel.body->joint->kind = Kind::hinge;
  scene.add(wheel);
  return scene;
}
const double kBase = 0.5 * 0.1 * 9e-4, kWheel = 0.5 * 0.05 * 4e-4;  // [kg m^2]
const double kReduced = kBase * kWheel / (kBase + kWheel);

// Mean period by linear interpolation of upward crossings of the middle.
double period_of(BodyWorld& world, int body, int most) {
  std::vector<double> crossings;
  double before = world.joint(body);
  for (int k = 0; k < most && crossings.size() < 6; ++k) {
    run(world, 1);
    const double now = world.joint(body);
    if (before < 0 && now >= 0) crossings.push_back(kTick * (k + before / (before - now)));
    before = now;
  }
  if (crossings.size() < 2) return 0;
  return (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
}

TEST(BodyJoints, AHingeOnABodySwingsOnItsSpring) {
  BodyJoint spring;
  spring.force.spring = 0.02;
  BodyWorld world(two_on_an_axis(spring));
  set_moving(world, 1, Vec3::Zero(), {0, 0, 20});
  const double w = std::sqrt(0.02 / kReduced);
  EXPECT_NEAR(period_of(world, 1, 2000), 2 * M_PI / w, 2e-3 * 2 * M_PI / w);
  EXPECT_NEAR(kBase * world.spin(0).z() + kWheel * world.spin(1).z(), kWheel * 20, 1e-12);
  EXPECT_LT(run(world, 2000), 1e-12);
  EXPECT_GT(std::abs(world.spin(1).z() - world.spin(0).z()), 0.1);
}

TEST(BodyJoints, AHingeOnABodyIsBrakedByDampingAndFriction) {
  BodyJoint damped;
  damped.damping = 2e-5;
  BodyWorld slows(two_on_an_axis(damped));
  set_moving(slows, 1, Vec3::Zero(), {0, 0, 20});
  EXPECT_LT(run(slows, 300), 1e-13);
  const double rest = 20 * std::exp(-0.3 * damped.damping / kReduced);
  EXPECT_NEAR(slows.spin(1).z() - slows.spin(0).z(), rest, 0.01 * rest);

  BodyJoint rubs;
  rubs.friction = 2e-4;
  BodyWorld stops(two_on_an_axis(rubs));
  set_moving(stops, 1, Vec3::Zero(), {0, 0, 20});
  const double all = 20 * kReduced / rubs.friction;  // [s]
  EXPECT_LT(run(stops, static_cast<int>(all / 2 / kTick)), 1e-13);
  EXPECT_NEAR(stops.spin(1).z() - stops.spin(0).z(), 10, 0.1);
  EXPECT_LT(run(stops, static_cast<int>(all / kTick)), 1e-13);
  EXPECT_NEAR(stops.spin(1).z(), stops.spin(0).z(), 1e-6);
  EXPECT_NEAR(stops.spin(0).z(), kWheel * 20 / (kBase + kWheel), 1e-6);
}

TEST(BodyJoints, AHingeOnABodyEndsAtItsStopsAndClicksIntoItsDetents) {
  BodyJoint stopped;
  stopped.low = -0.2;
  stopped.high = 0.5;
  stopped.stop_stiffness = 0.5;
  BodyWorld world(two_on_an_axis(stopped));
  set_moving(world, 1, Vec3::Zero(), {0, 0, 5});
  double most = 0;
  for (int k = 0; k < 1000; ++k) {
    EXPECT_LT(run(world, 1), 1e-12);
    most = std::max(most, world.joint(1));
  }
  EXPECT_GT(most, 0.5);
  EXPECT_LT(most, 0.5 + 5 * std::sqrt(kReduced / 0.5));
  EXPECT_NEAR(world.spin(1).z(), world.spin(0).z(), 0.3);  // exp(-3.1) of 5

  BodyJoint detent;
  detent.force.detent_force = 0.01;
  detent.force.detent_period = 0.25;
  detent.damping = 3e-5;
  BodyWorld clicks(two_on_an_axis(detent));
  set_moving(clicks, 1, Vec3::Zero(), {0, 0, 20});
  EXPECT_LT(run(clicks, 4000), 1e-12);
  const double steps = clicks.joint(1) / 0.25;
  EXPECT_NEAR(steps, std::round(steps), 1e-3);
  EXPECT_GT(steps, 1.5);
  // The joint's angle agrees with the bodies' poses.
  const Mat3 R = clicks.pose(0).linear().transpose() * clicks.pose(1).linear();
  const double angle = std::atan2(R(1, 0), R(0, 0));
  EXPECT_NEAR(std::remainder(clicks.joint(1) - angle, 2 * M_PI), 0, 1e-4);
}

// A drawer in a cabinet that moves and turns in empty space.
Scene drawer(const BodyJoint& between) {
  Scene scene;
  scene.gravity.setZero();
  scene.add(body("cabinet", Box{{0.08, 0.08, 0.04}}, 0.2, {0, 0, 0}));
  Object drawer = body("drawer", Box{{0.04, 0.04, 0.02}}, 0.05, {0, 0, 0});
  drawer.body->joint = between;
  drawer.body->joint->to = "cabinet";
  drawer.body->joint->kind = Kind::slider;
  drawer.body->joint->axis = Vec3::UnitX();
  scene.add(drawer);
  return scene;
}

TEST(BodyJoints, ASliderOnABodySwingsOnItsSpring) {
  BodyJoint spring;
  spring.force.spring = 20;
  BodyWorld world(drawer(spring));
  set_moving(world, 1, {0.5, 0, 0}, Vec3::Zero());
  const double reduced = 0.2 * 0.05 / 0.25, w = std::sqrt(20 / reduced);
  EXPECT_NEAR(period_of(world, 1, 3000), 2 * M_PI / w, 2e-3 * 2 * M_PI / w);
  EXPECT_NEAR(0.2 * world.speed(0).x() + 0.05 * world.speed(1).x(), 0.05 * 0.5, 1e-12);
  EXPECT_LT(run(world, 2000), 1e-12);
}

TEST(BodyJoints, ASliderOnABodyIsBrakedAndStopped) {
  BodyJoint rubs;
  rubs.friction = 0.1;
  rubs.low = -0.05;
  rubs.high = 0.05;
  BodyWorld world(drawer(rubs));
  set_moving(world, 1, {0.3, 0, 0}, Vec3::Zero());
  const double reduced = 0.04, slowing = 0.1 / reduced;
  EXPECT_LT(run(world, 100), 1e-13);
  EXPECT_NEAR(world.speed(1).x() - world.speed(0).x(), 0.3 - 0.1 * slowing, 0.003);
  EXPECT_NEAR(world.joint(1), 0.03 - 0.5 * slowing * 0.01, 3e-4);
  EXPECT_LT(run(world, 400), 1e-13);
  EXPECT_NEAR(world.speed(1).x(), world.speed(0).x(), 1e-6);

  BodyJoint free;
  free.low = -0.05;
  free.high = 0.05;
  BodyWorld stops(drawer(free));
  set_moving(stops, 1, {1, 0, 0}, Vec3::Zero());
  double most = 0;
  for (int k = 0; k < 400; ++k) {
    EXPECT_LT(run(stops, 1), 1e-12);
    most = std::max(most, stops.joint(1));
  }
  EXPECT_NEAR(most, 0.05, 2e-3);
}

// The rail bears every force off its line, however both parts turn.
TEST(BodyJoints, ASliderStaysOnItsLineWhileAllOfItTurns) {
  BodyJoint spring;
  spring.force.spring = 20;
  spring.damping = 0.5;
  BodyWorld world(drawer(spring));
  set_moving(world, 0, Vec3::Zero(), {1, 2, 3});
  set_moving(world, 1, {0.2, 0, 0}, {1, 2, 3});
  const auto momentum = [&] {
    Vec3 all = Vec3::Zero();
    const std::array<Vec3, 2> sizes{Vec3(0.08, 0.08, 0.04), Vec3(0.04, 0.04, 0.02)};
    for (int i = 0; i < 2; ++i) {
      const double mass = i == 0 ? 0.2 : 0.05;
      const Vec3 s = sizes[static_cast<std::size_t>(i)].cwiseAbs2();
      const Vec3 I = mass / 12 * Vec3(s.y() + s.z(), s.z() + s.x(), s.x() + s.y());
      const Mat3& R = world.pose(i).linear();
      all += mass * world.center(i).cross(world.speed(i)) +
             R * I.cwiseProduct(R.transpose() * world.spin(i));
    }
    return all;
  };
  const Vec3 before = momentum();
  for (int k = 0; k < 3000; ++k) {
    EXPECT_LT(run(world, 1), 1e-9) << k;
    const Pose relative = world.pose(0).inverse() * world.pose(1);
    EXPECT_LT(relative.translation().tail<2>().norm(), 2e-4) << k;
    EXPECT_GT(relative.linear().trace(), 3 - 1e-3) << k;
    EXPECT_NEAR(relative.translation().x(), world.joint(1), 1e-4) << k;
  }
  EXPECT_LT((momentum() - before).norm(), 2e-3 * before.norm());
}

// Far out on its line the body meets a line that turns fast.
TEST(BodyJoints, ASliderMakesNothingFarOutOnALineThatTurns) {
  BodyJoint spring;
  spring.force.spring = 6;
  spring.low = -0.15;
  spring.high = 0.15;
  BodyWorld world(drawer(spring));
  set_moving(world, 0, Vec3::Zero(), {0, 0, 8});
  set_moving(world, 1, {0.6, 0, 0}, {0, 0, 8});
  double most = 0;
  for (int k = 0; k < 2000; ++k) {
    ASSERT_LT(run(world, 1), 1e-12) << k;
    most = std::max(most, world.joint(1));
    const Pose relative = world.pose(0).inverse() * world.pose(1);
    ASSERT_LT(relative.translation().tail<2>().norm(), 1e-4) << k;
  }
  EXPECT_GT(most, 0.05);
}

// Holds after any number of turns.
TEST(BodyJoints, AHingeIsWhereItsHalvesAre) {
  BodyJoint light;
  light.damping = 1e-9;
  BodyWorld world(two_on_an_axis(light));
  set_moving(world, 1, Vec3::Zero(), {0, 0, 60});
  run(world, 3000);
  EXPECT_GT(world.joint(1), 2 * M_PI * 20);
  const Mat3 R = world.pose(0).linear().transpose() * world.pose(1).linear();
  EXPECT_NEAR(std::remainder(world.joint(1) - std::atan2(R(1, 0), R(0, 0)), 2 * M_PI), 0, 1e-4);
}

// A joint's friction and damping yield to the forces in it; otherwise each would wait for the
// other.
TEST(BodyJoints, AreFoundInFewSweeps) {
  for (const auto& [damping, friction] : {std::pair{0.0, 1e-3}, std::pair{1e-3, 0.0}}) {
    BodyWorld world(pendulum(0.5, damping, friction));
    int most = 0;
    for (int k = 0; k < 500; ++k) {
      run(world, 1);
      most = std::max(most, world.sweeps());
    }
    EXPECT_LE(most, 12) << damping << " " << friction;
  }
}

// A joint's force goes on under outside changes. The change, of which damping takes its share, is
// all that acts on both halves, and the next sweep finds the same forces again.
TEST(BodyJoints, KeepAccountOfAllThatTheyPushWith) {
  Random random(5);
  for (const Kind kind : {Kind::ball, Kind::hinge}) {
    HeldJoint held;
    held.joint.kind = kind;
    held.joint.damping = 0.02;
    held.joint.friction = 0.05;
    held.along = random.direction();
    const Mat3 R = random.rotation();
    const Mat3 answer = R * Vec3(20, 50, 90).asDiagonal() * R.transpose();
    held.start(answer);
    const Vec3 free = 3 * random.direction();
    Vec3 pushed = Vec3::Zero();
    const auto speed = [&] { return Vec3(free + answer * pushed); };
    const auto sweep = [&] {
      const Vec3 before = held.force();
      const double change = held.sweep(kTick, speed());
      pushed += held.force() - before;
      return change;
    };
    for (int i = 0; i < 50; ++i) sweep();
    const Vec3 found = held.force();
    EXPECT_GT(found.norm(), 0.01);
    EXPECT_LT(sweep(), 1e-12);
    pushed += held.add(kind == Kind::ball ? Vec3(0.01, -0.02, 0.015) : Vec3(0, 0, 0.015));
    EXPECT_LT((held.force() - pushed).norm(), 1e-15);
    for (int i = 0; i < 50; ++i) sweep();
    EXPECT_LT((held.force() - found).norm(), 1e-10);
    if (kind == Kind::ball) {
      EXPECT_LT((held.damping + 0.02 * speed()).norm(), 1e-12);
    } else {
      EXPECT_NEAR(held.damping.dot(held.along), -0.02 * speed().dot(held.along), 1e-12);
    }
  }
}

// A chain of two doors, one hinged on the other, both on springs and dampers, under their weight.
TEST(BodyJoints, AChainOfHingesMakesNoEnergy) {
  Scene scene;
  for (int i = 0; i < 3; ++i) {
    Object link =
        body("link " + std::to_string(i), Box{{0.01, 0.02, 0.06}}, 0.03, {0, 0, -0.03 - 0.06 * i});
    BodyJoint& joint = link.body->joint.emplace();
    joint.kind = Kind::hinge;
    joint.axis = Vec3::UnitY();
    joint.point = {0, 0, 0.03};
    if (i > 0) joint.to = "link " + std::to_string(i - 1);
    joint.friction = i == 1 ? 1e-4 : 0;
    joint.damping = i == 2 ? 1e-5 : 0;
    joint.low = -1;
    joint.force.spring = i == 2 ? 0.01 : 0;
    scene.add(link);
  }
  BodyWorld world(scene);
  std::vector<double> numbers = state(world);
  numbers[10 + 19] = 12;  // first door's speed about its hinge [rad/s]
  ASSERT_TRUE(world.read(numbers));
  EXPECT_LT(run(world, 8000), 1e-9);
  for (int i = 1; i < 3; ++i) EXPECT_GT(world.joint(i), -1.02) << i;
  for (int i = 1; i < 3; ++i) {
    const Vec3 one = world.pose(i - 1) * Vec3(0, 0, -0.03), two = world.pose(i) * Vec3(0, 0, 0.03);
    EXPECT_LT((one - two).norm(), 1e-4) << i;
  }
}

TEST(BodyJoints, GoOnFromTheirNumbersBitForBit) {
  BodyJoint between;
  between.force.spring = 20;
  between.friction = 0.01;
  between.damping = 0.1;
  Scene scene = drawer(between);
  for (Object& o : pendulum(0.2, 1e-4, 1e-3).objects) {
    o.pose.translation() += Vec3(0.5, 0, 0);
    scene.add(o);
  }
  BodyWorld one(scene), other(scene);
  set_moving(one, 1, {0.5, 0, 0}, Vec3::Zero());
  run(one, 300);
  ASSERT_TRUE(other.read(state(one)));
  run(one, 300);
  run(other, 300);
  EXPECT_EQ(state(one), state(other));
}

// A scene is edited while the loop runs.
TEST(BodyJoints, StayWhereTheyAreInAnotherScene) {
  BodyJoint between;
  between.force.detent_force = 0.01;
  between.force.detent_period = 0.25;
  between.damping = 1e-5;
  BodyWorld before(two_on_an_axis(between));
  set_moving(before, 1, Vec3::Zero(), {0, 0, 60});
  run(before, 2000);
  ASSERT_GT(before.joint(1), 7);  // more than once around
  between.damping = 3e-5;
  BodyWorld after(two_on_an_axis(between));
  after.take_over(before);
  EXPECT_NEAR(after.joint(1), before.joint(1), 1e-4);
}

}  // namespace
}  // namespace limpid::test
