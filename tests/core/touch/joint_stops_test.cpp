// Stops of joints: what hits one leaves it with the restitution's part of its speed.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/dynamics/random.h"
#include "tests/support/body_worlds.h"

namespace limpid::test {
namespace {

using Kind = BodyJoint::Kind;

// The other side of a joint with a stop.
enum class Holds : std::uint8_t { world, body, body_on_ball, body_on_hinge };

struct StopCase {
  Kind kind = Kind::slider;
  Holds holds = Holds::world;
  double restitution = 0, stiffness = 20000;  // [-], [N/m] or [N m/rad]
  double mass = 0.05, other = 0.05;           // [kg]
  double speed = 1;                           // [m/s] or [rad/s]
  bool up = true;                             // the upper stop
  bool central = true;                        // the joint goes through both centres of mass
};

// A box that is thrown at a joint's stop some ticks away, without weight.
Scene thrown_at_a_stop(const StopCase& c, Random& random) {
  Scene scene;
  scene.gravity.setZero();
  const Vec3 axis = random.direction();
  const auto size = [&] { return random.between(0.03, 0.06); };
  const auto box = [&](const char* name, double mass, const Vec3& at) {
    Object object = body(name, Box{Vec3{size(), size(), size()}}, mass, at);
    object.pose.linear() = turned(random.between(-3, 3), random.direction());
    return object;
  };
  Object thrown = box("thrown", c.mass, {0.2, 0.1, 0.3});
  BodyJoint& joint = thrown.body->joint.emplace();
  joint.kind = c.kind;
  joint.axis = axis;
  joint.stop_stiffness = c.stiffness;
  joint.stop_restitution = c.restitution;
  if (!c.central) joint.point = 0.015 * random.direction();
  const double gap = c.speed * random.between(0.005, 0.009);
  joint.low = c.up ? -100 : -gap;
  joint.high = c.up ? gap : 100;
  const Vec3 point = thrown.pose * joint.point;
  if (c.holds != Holds::world) joint.to = "other";
  scene.add(thrown);
  if (c.holds == Holds::world) return scene;
  const Vec3 beside = c.central ? Vec3(0.2 * axis) : Vec3(0.1 * random.direction());
  Object other = box("other", c.other, point + beside);
  if (c.holds != Holds::body) {
    BodyJoint& own = other.body->joint.emplace();
    own.kind = c.holds == Holds::body_on_ball ? Kind::ball : Kind::hinge;
    own.axis = random.direction();
    own.point = 0.01 * random.direction();
  }
  scene.add(other);
  return scene;
}

struct Rebound {
  double kept = 0, gain = 0;  // part of the speed along the joint [-], and energy [J]
  bool came_back = false;
};

// The joint's speed is that of its place over two ticks, some ticks before and after it is on the
// stop.
Rebound rebound_of(const StopCase& c, unsigned seed) {
  Random random(seed);
  const Scene scene = thrown_at_a_stop(c, random);
  const BodyJoint& joint = *scene.objects[0].body->joint;
  BodyWorld world(scene);
  const double sign = c.up ? 1 : -1;
  const Vec3 moves = sign * c.speed * joint.axis;
  if (c.kind == Kind::slider) {
    world.set_speed(0, moves, Vec3::Zero());
  } else {
    const Vec3 arm = world.center(0) - scene.objects[0].pose * joint.point;
    world.set_speed(0, moves.cross(arm), moves);
  }
  const double stop = c.up ? joint.high : -joint.low;
  std::array<double, 3> places{};
  double before = 0;
  bool hit = false;
  Rebound rebound;
  for (int k = 0, off = 0; k < 3000 && off < 4; ++k) {
    rebound.gain = std::max(rebound.gain, run(world, 1));
    places = {places[1], places[2], sign * world.joint(0)};
    const double way = places[2] - places[1];
    if (k < 2) continue;
    hit = hit || places[2] + way >= stop;
    if (!hit) before = places[2] - places[0];
    off += hit && places[2] < stop && way < 0 ? 1 : 0;
    rebound.came_back = off == 4;
  }
  rebound.kept = (places[0] - places[2]) / before;
  return rebound;
}

StopCase any_stop(Random& random, double heaviest) {
  StopCase c;
  c.kind = random.between(0, 1) < 0.5 ? Kind::slider : Kind::hinge;
  c.restitution = random.between(0.02, 1);
  c.stiffness = random.log_between(200, 60000);
  c.mass = random.log_between(1e-6, heaviest);
  c.other = std::clamp(c.mass * random.log_between(0.03, 30), 1e-6, heaviest);
  c.speed = c.kind == Kind::slider ? random.between(0.1, 1) : random.between(3, 20);
  c.up = random.between(0, 1) < 0.5;
  return c;
}

// From 1 mg to 1 kg, sliders and hinges, stops of 200 to 60,000 N/m or N m/rad.
TEST(JointStops, OfTheWorldGiveBackWhatTheRestitutionSays) {
  Random random(1);
  for (unsigned seed = 0; seed < 400; ++seed) {
    StopCase c = any_stop(random, 1);
    c.central = seed % 2 == 0;
    if (seed % 8 == 0) c.restitution = 1;
    const Rebound found = rebound_of(c, seed);
    ASSERT_TRUE(found.came_back) << seed;
    EXPECT_NEAR(found.kept, c.restitution, 1e-3) << seed << " " << c.mass << " kg";
    EXPECT_LT(found.gain, 1e-12) << seed;
  }
}

TEST(JointStops, WithoutRestitutionLeaveNothing) {
  Random random(2);
  for (unsigned seed = 0; seed < 200; ++seed) {
    StopCase c = any_stop(random, 1);
    c.restitution = 0;
    EXPECT_LT(rebound_of(c, seed).kept, 0.02) << seed << " " << c.mass << " kg";
  }
}

// How many of 300 are off by more than 0.03; bodies up to 50 g, whose links are stiff.
int stops_that_are_off(Holds holds, bool central, unsigned seed) {
  Random random(seed);
  int off = 0;
  for (unsigned i = 0; i < 300; ++i) {
    StopCase c = any_stop(random, 0.05);
    c.holds = holds;
    c.central = central;
    if (!central) c.speed *= 0.3;  // so that it hardly turns the joint's axis in the meantime
    if (i % 6 == 0) c.restitution = 0;
    const Rebound found = rebound_of(c, seed + i);
    const bool right = found.kept <= c.restitution + (c.restitution == 0 ? 0.02 : 0.03) &&
                       found.kept >= c.restitution - 0.03;
    off += found.came_back && right ? 0 : 1;
    EXPECT_LT(found.gain, 1e-9) << i;
  }
  return off;
}

TEST(JointStops, BetweenTwoBodiesGiveBackWhatTheRestitutionSays) {
  for (const bool central : {true, false}) {
    for (const Holds holds : {Holds::body, Holds::body_on_ball, Holds::body_on_hinge}) {
      EXPECT_LE(stops_that_are_off(holds, central, 1000), 12)
          << static_cast<int>(holds) << " " << central;
    }
  }
}

// A weight of any mass that falls on its stop comes up again to the square of the restitution.
TEST(JointStops, LetAWeightBounceToTheSquareOfTheRestitution) {
  constexpr double kHeight = 0.2;
  for (const double mass : {1e-6, 1e-3, 0.05, 1.0}) {
    for (const double restitution : {0.0, 0.3, 0.7, 1.0}) {
      Scene scene;
      Object weight = body("weight", Sphere{0.01}, mass, {0, 0, 0.3});
      BodyJoint& joint = weight.body->joint.emplace();
      joint.low = -kHeight;
      joint.stop_restitution = restitution;
      scene.add(weight);
      BodyWorld world(scene);
      EXPECT_LT(run(world, static_cast<int>(std::sqrt(2 * kHeight / 9.81) / kTick) - 1), 1e-12);
      double highest = -kHeight, gain = 0;
      for (int k = 0; k < 420; ++k) {
        gain = std::max(gain, run(world, 1));
        if (k > 40) highest = std::max(highest, world.joint(0));
      }
      const double kept = std::sqrt(std::max(0.0, highest + kHeight) / kHeight);
      EXPECT_NEAR(kept, restitution, restitution == 0 ? 0.02 : 0.01) << mass << " kg";
      EXPECT_LT(gain, 1e-12) << mass;
    }
  }
}

// A key that flies at its stop and is pushed by a force, along the joint, or against it.
Scene key_that_is_pushed(double mass, double restitution, double force) {
  Scene scene;
  scene.gravity.setZero();
  Object key = body("key", Box{Vec3(0.02, 0.02, 0.02)}, mass, {0, 0, 0.3});
  BodyJoint& joint = key.body->joint.emplace();
  joint.axis = Vec3::UnitX();
  joint.high = 0.005;
  joint.stop_stiffness = 5000;
  joint.stop_restitution = restitution;
  joint.force.travel = {{-1, -force}, {1, -force}};
  scene.add(key);
  return scene;
}

TEST(JointStops, BearWhatPressesOnThemAndLetGoWhatIsPulledOff) {
  for (const double mass : {1e-3, 0.05}) {
    for (const double restitution : {0.0, 0.5}) {
      const double force = 10 * mass;  // [N]
      BodyWorld pressed(key_that_is_pushed(mass, restitution, force));
      pressed.set_speed(0, {0.5, 0, 0}, Vec3::Zero());
      EXPECT_LT(run(pressed, 3000), 1e-12);
      EXPECT_NEAR(pressed.joint(0) - 0.005, force / 5000, 0.01 * force / 5000) << mass;
      BodyWorld pulled(key_that_is_pushed(mass, restitution, -force));
      pulled.set_speed(0, {0.5, 0, 0}, Vec3::Zero());
      int on = 0;
      for (int k = 0; k < 100; ++k) {
        run(pulled, 1);
        on += pulled.joint(0) > 0.005 ? 1 : 0;
      }
      EXPECT_GT(on, 0);
      EXPECT_LT(on, 20) << mass;
      EXPECT_LT(pulled.joint(0), 0) << mass;
    }
  }
}

// A bead without friction between stops that keep all, for two seconds.
TEST(JointStops, KeepAllEnergyOverManyHits) {
  for (const double mass : {1e-6, 1e-3, 1.0}) {
    Scene scene;
    scene.gravity.setZero();
    Object bead = body("bead", Sphere{0.01}, mass, {0, 0, 0.3});
    BodyJoint& joint = bead.body->joint.emplace();
    joint.axis = Vec3::UnitX();
    joint.low = -0.01;
    joint.high = 0.013;
    joint.stop_restitution = 1;
    scene.add(bead);
    BodyWorld world(scene);
    world.set_speed(0, {1, 0, 0}, Vec3::Zero());
    double fastest = 0;
    for (int k = 0; k < 2000; ++k) {
      run(world, 1);
      fastest = k > 1900 ? std::max(fastest, world.speed(0).norm()) : 0;
    }
    EXPECT_NEAR(fastest, 1, 1e-6) << mass;
    EXPECT_LT(world.gain(), 1e-12);
  }
}

TEST(JointStops, GoOnTheSameFromTheMiddleOfAHit) {
  for (const Holds holds : {Holds::world, Holds::body}) {
    for (const double restitution : {0.0, 0.5}) {
      StopCase c;
      c.holds = holds;
      c.restitution = restitution;
      Random random(3);
      const Scene scene = thrown_at_a_stop(c, random);
      BodyWorld world(scene), again(scene);
      world.set_speed(0, scene.objects[0].body->joint->axis, Vec3::Zero());
      for (int k = 0; k < 40; ++k) {
        ASSERT_TRUE(again.read(state(world)));
        run(world, 1);
        run(again, 1);
        ASSERT_EQ(state(world), state(again)) << k;
      }
    }
  }
}

}  // namespace
}  // namespace limpid::test
