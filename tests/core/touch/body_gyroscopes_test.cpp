// Mechanisms whose bodies turn by far in a tick.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/body_worlds.h"

namespace limpid::test {
namespace {

using Kind = BodyJoint::Kind;

constexpr double kArm = 0.1;  // from the ball joint to the rotor [m]
constexpr double kRotor = 0.2, kRim = 0.04;
constexpr double kAlongAxle = 0.5 * kRotor * kRim * kRim;  // the rotor's inertia [kg m^2]

// A rotor of 200 g, on a hinge at the end of a frame that a ball joint holds at the origin; the
// axle is x. Body 0 is the frame, 1 the rotor.
Scene gyroscope(double frame_mass, double frame_radius) {
  Scene scene;
  Object frame = body("frame", Capsule{frame_radius, 0.08}, frame_mass, {kArm / 2, 0, 0});
  frame.pose.linear() = turned(M_PI / 2, Vec3::UnitY());
  BodyJoint& ball = frame.body->joint.emplace();
  ball.kind = Kind::ball;
  ball.point = {0, 0, -kArm / 2};
  scene.add(frame);
  Object rotor = body("rotor", Cylinder{kRim, 0.01}, kRotor, {kArm, 0, 0});
  rotor.pose.linear() = turned(M_PI / 2, Vec3::UnitY());
  BodyJoint& hinge = rotor.body->joint.emplace();
  hinge.kind = Kind::hinge;
  hinge.to = "frame";
  hinge.axis = Vec3::UnitX();
  scene.add(rotor);
  return scene;
}

// How far the hinge has come apart [m].
double opened(const BodyWorld& world) {
  return (world.center(1) - world.pose(0) * Vec3(0, 0, kArm / 2)).norm();
}

// A level axle goes round with the torque of the weight over the rotor's spin, and stays level.
TEST(BodyGyroscopes, PrecessByTheirWeightOverTheirSpin) {
  for (const double spin : {100.0, 300.0, 600.0, 1000.0}) {
    for (const double frame_mass : {0.002, 0.02, 0.2}) {
      SCOPED_TRACE(testing::Message() << spin << " rad/s, " << frame_mass << " kg");
      const Scene scene = gyroscope(frame_mass, 0.02);
      BodyWorld world(scene);
      const double torque = 9.81 * kArm * (kRotor + frame_mass / 2);
      const double rate = torque / (kAlongAxle * spin);
      world.set_speed(0, Vec3::Zero(), {0, 0, rate});
      world.set_speed(1, {0, rate * kArm, 0}, {spin, 0, rate});
      double most = 0, highest = 0;
      for (int k = 0; k < 1000; ++k) {
        EXPECT_LT(run(world, 1), 1e-10);
        most = std::max(most, opened(world));
        highest = std::max(highest, std::abs(world.center(1).z()));
      }
      const double held = 0.5 * kAlongAxle * spin * spin;
      EXPECT_LT(-world.gain(), 1e-3 * held);
      EXPECT_LT(most, 3e-5);
      EXPECT_LT(highest, 0.03 * kArm);
      const double around = std::atan2(world.center(1).y(), world.center(1).x());
      EXPECT_NEAR(std::remainder(around - rate, 2 * M_PI), 0, 0.02 * rate);
    }
  }
}

// A spring of 3.6 J between the rotor and a thin frame of 2 g, whose inertia about the axle is 9e-9
// kg m^2: by itself it would turn the frame by 28 rad in a tick.
TEST(BodyGyroscopes, TurnAtMostByARadianInATickAndHold) {
  for (const double rest : {2.0, 8.0, 30.0, 60.0}) {
    Scene scene = gyroscope(0.002, 0.003);
    scene.objects[1].body->joint->force.spring = 0.002;
    scene.objects[1].body->joint->force.rest = rest;
    BodyWorld world(scene);
    double most = 0, fastest = 0, gain = 0;
    for (int k = 0; k < 3000; ++k) {
      gain = std::max(gain, run(world, 1));
      most = std::max(most, opened(world));
      fastest = std::max({fastest, world.spin(0).norm(), world.spin(1).norm()});
    }
    EXPECT_LT(gain, 1e-12) << rest;
    EXPECT_LT(most, 1.5e-4) << rest;
    EXPECT_LE(fastest, 1 / kTick * (1 + 1e-12)) << rest;
    EXPECT_EQ(world.stood_still(), 0) << rest;
    const double turn = kTick * rest * std::sqrt(0.002 / 9e-9);  // all energy in the frame's spin
    EXPECT_EQ(world.turned_less() > 0, turn > 1) << rest;
  }
}

}  // namespace
}  // namespace limpid::test
