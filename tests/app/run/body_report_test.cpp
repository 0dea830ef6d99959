// Reports on moving objects, against calculations by hand.
#include "app/run/body_report.h"

#include <gmock/gmock.h>

#include <numbers>

#include "core/dynamics/farthest_tip.h"
#include "core/touch/mass_properties.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

constexpr double kG = 9.81;

ArmDescription arm() { return test::random_arm(3, 4); }

Object body(const std::string& name, Shape shape, const Vec3& at, double mass = 0.1) {
  Object out{.name = name, .pose = pose_at(at), .shape = std::move(shape), .body = Body{}};
  out.body->mass = mass;
  return out;
}

Scene on_a_floor(std::vector<Object> bodies, double height = -0.1) {
  Scene scene;
  scene.add({.name = "floor", .pose = pose_at(Vec3(0, 0, height)), .shape = Plane{}});
  scene.add({.name = "roof", .pose = pose_at(Vec3(0, 0, 1)), .shape = Plane{-Vec3::UnitZ()}});
  for (Object& each : bodies) scene.add(std::move(each));
  return scene;
}

double energy(const Object& object) { return most_weight_energy(on_a_floor({object}), arm()); }

TEST(BodyReport, WeighsHowFarABodyFallsToTheFloor) {
  EXPECT_NEAR(energy(body("a", Sphere{0.02}, Vec3(0, 0, 0.1))), 0.1 * kG * 0.18, 1e-12);
  EXPECT_NEAR(energy(body("a", Box{Vec3::Constant(0.04)}, Vec3(0, 0, -0.08))), 0, 1e-12);
  EXPECT_EQ(most_weight_energy(on_a_floor({}), arm()), 0);
  Scene scene = on_a_floor({body("a", Sphere{0.02}, Vec3(0, 0, 0.1))});
  scene.gravity.setZero();
  EXPECT_EQ(most_weight_energy(scene, arm()), 0);
}

// Flat on its plate the body's centre is nearer to the floor than the ball, its first part, is
// wide.
TEST(BodyReport, WeighsNoLessThanABodyOfPartsCanGive) {
  constexpr double kPlate = 0.002, kUp = 0.06;
  Object object = body("a", Sphere{0.05}, Vec3(0, 0, 0.3));
  object.parts.push_back({pose_at(Vec3(0, 0, -kUp)), Box{Vec3(0.4, 0.4, kPlate)}});
  const double center = mass_properties(object).center.z();  // from the ball's middle
  ASSERT_LT(kUp + center, 0.05);
  const double lying = kUp + kPlate / 2 + center;
  EXPECT_GE(energy(object), 0.1 * kG * (0.3 + center + 0.1 - lying));
}

TEST(BodyReport, WithoutAFloorItFallsAsFarAsTheTipGets) {
  Scene scene;
  scene.add(body("a", Sphere{0.02}, Vec3(0, 0, 0.1)));
  const double lowest = arm().joints[0].origin.translation().z() - farthest_tip(arm()).distance;
  EXPECT_NEAR(most_weight_energy(scene, arm()), 0.1 * kG * (0.1 - lowest - 0.02), 1e-12);
}

TEST(BodyReport, KnowsHowFarAJointLetsItSink) {
  Object object = body("a", Sphere{0.01}, Vec3(0, 0, 0.5));
  object.body->joint = BodyJoint{};
  BodyJoint& joint = *object.body->joint;
  joint.axis = Vec3(0, 0.6, -0.8);
  joint.low = -0.5;
  joint.high = 0.02;
  EXPECT_NEAR(energy(object), 0.1 * kG * 0.8 * 0.02, 1e-12);
  joint.axis = Vec3(1, 0, 0);
  EXPECT_NEAR(energy(object), 0, 1e-12);
  joint.kind = BodyJoint::Kind::hinge;
  joint.point = Vec3(0.05, 0, 0.03);
  EXPECT_NEAR(energy(object), 0, 1e-12) << "hangs below its hinge";
  joint.axis = Vec3(0, 1, 0);
  const double lever = std::sqrt(0.05 * 0.05 + 0.03 * 0.03);
  EXPECT_NEAR(energy(object), 0.1 * kG * (lever - 0.03), 1e-12);
  joint.kind = BodyJoint::Kind::ball;
  joint.point = Vec3(0, 0, -0.03);
  EXPECT_NEAR(energy(object), 0.1 * kG * 0.06, 1e-12);
}

// Compared with a search over the whole turn.
TEST(BodyReport, AHingeOfAnyAxisSinksToItsLowestPlace) {
  test::Random random(6);
  for (int round = 0; round < 30; ++round) {
    Object object = body("a", Sphere{0.01}, Vec3(0, 0, 3));
    BodyJoint& joint = object.body->joint.emplace();
    joint.kind = BodyJoint::Kind::hinge;
    joint.axis = random.direction();
    joint.point = random.point(0.1);
    double lowest = 0;
    for (int i = 0; i < 3600; ++i) {
      const Eigen::AngleAxisd turn(i * std::numbers::pi / 1800, joint.axis);
      lowest = std::max(lowest, -joint.point.z() - (turn * Vec3(-joint.point)).z());
    }
    EXPECT_NEAR(energy(object), 0.1 * kG * lowest, 1e-6);
  }
}

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

Pairs pairs(const Object& a, const Object& b) {
  Scene scene;
  scene.objects = {a, b};
  return overlapping(scene);
}

TEST(BodyReport, NamesThoseThatAreInEachOther) {
  const Object ball = body("ball", Sphere{0.02}, Vec3::Zero());
  const auto box = [](const Vec3& at) { return body("box", Box{Vec3::Constant(0.04)}, at); };
  EXPECT_THAT(pairs(ball, box(Vec3(0.038, 0, 0))), ElementsAre(Pair(0, 1)));
  EXPECT_TRUE(pairs(ball, box(Vec3(0.04, 0, 0))).empty()) << "touches";
  EXPECT_TRUE(pairs(ball, box(Vec3(0.039, 0.039, 0.039))).empty()) << "off its corner";
  EXPECT_THAT(pairs(box(Vec3::Zero()), box(Vec3(0, 0.03, 0.03))), ElementsAre(Pair(0, 1)));
  EXPECT_TRUE(pairs(box(Vec3::Zero()), box(Vec3(0, 0, 0.04))).empty()) << "stands on it";
}

// Each shape in each other one: with coinciding middles, and well apart.
TEST(BodyReport, SeesEveryShapeInEveryOther) {
  const std::vector<Shape> shapes{Sphere{0.03}, Box{Vec3(0.02, 0.06, 0.05)}, Cylinder{0.02, 0.08},
                                  Capsule{0.02, 0.05}};
  test::Random random(7);
  for (const Shape& a : shapes) {
    for (const Shape& b : shapes) {
      for (const double apart : {0.0, 0.02, 0.2}) {
        Object first = body("a", a, Vec3::Zero()), second = body("b", b, Vec3::Zero());
        first.pose.linear() = random.rotation();
        second.pose.linear() = random.rotation();
        second.pose.translation() = apart * random.direction();
        EXPECT_EQ(pairs(first, second).empty(), apart > 0.1) << a.index() << b.index() << apart;
      }
    }
  }
}

// A plank through another has no corner in it.
TEST(BodyReport, SeesPlanksThatCross) {
  const Object a = body("a", Box{Vec3(0.2, 0.02, 0.02)}, Vec3::Zero());
  const Object b = body("b", Box{Vec3(0.02, 0.2, 0.02)}, Vec3(0, 0, 0.01));
  EXPECT_EQ(pairs(a, b).size(), 1u);
}

TEST(BodyReport, LeavesAloneWhatHangsTogetherOrStandsStill) {
  Object lid = body("lid", Sphere{0.02}, Vec3::Zero());
  Object pot = body("pot", Sphere{0.02}, Vec3(0.01, 0, 0));
  EXPECT_EQ(pairs(lid, pot).size(), 1u);
  lid.body->joint = BodyJoint{};
  lid.body->joint->to = "pot";
  EXPECT_TRUE(pairs(lid, pot).empty());
  lid.body.reset();
  pot.body.reset();
  EXPECT_TRUE(pairs(lid, pot).empty());
}

TEST(BodyReport, SeesPartsInAFloor) {
  Object pin = body("pin", Sphere{0.01}, Vec3(0, 0, -0.09));
  EXPECT_TRUE(overlapping(on_a_floor({pin})).empty());
  pin.parts.push_back({pose_at(Vec3(0, 0, -0.005)), Sphere{0.01}});
  EXPECT_THAT(overlapping(on_a_floor({pin})), ElementsAre(Pair(0, 2)));
}

// 400 N/m stretched by 0.25 m: 400 * 0.25^2 / 2 = 12.5 J.
TEST(BodyReport, CountsWhatSpringsHoldAtTheStart) {
  Scene scene = on_a_floor({body("a", Sphere{0.02}, Vec3(0.3, 0, -0.08)),
                            body("b", Sphere{0.02}, Vec3(0.3, 0.2, -0.08))});
  scene.springs.push_back(
      {.between = {"a", ""}, .points = {Vec3::Zero(), Vec3(0.05, 0, -0.08)}, .stiffness = 400});
  EXPECT_NEAR(spring_energy(scene), 12.5, 1e-12);
  scene.springs.push_back({.between = {"a", "b"},
                           .points = {Vec3::Zero(), Vec3(0.01, 0, 0)},
                           .length = 0.1,
                           .stiffness = 50});
  const double drawn = std::hypot(0.2, 0.01) - 0.1;
  EXPECT_NEAR(spring_energy(scene), 12.5 + 25 * drawn * drawn, 1e-12);
  BodyJoint joint;
  joint.force.spring = 100;
  joint.force.rest = 0.02;  // 100 * 0.02^2 / 2 = 20 mJ
  scene.objects.back().body->joint = joint;
  EXPECT_NEAR(spring_energy(scene), 12.52 + 25 * drawn * drawn, 1e-12);
  const BodyReport report = report_on_bodies(scene, arm());
  EXPECT_THAT(report.warnings, testing::Contains(HasSubstr("springs that are stretched")));
}

// A spring of 3.6 J turns 9e-9 kg m^2 by sqrt(2 3.6/9e-9) = 28,284 rad/s: 28.3 rad in a
// millisecond.
TEST(BodyReport, WarnsOfMechanismsThatSpringsTurnByFarInATick) {
  Object frame = body("frame", Sphere{0.02}, Vec3(0.3, 0, 0));
  frame.body->inertia = Vec3(1e-6, 1e-6, 9e-9);
  Object rotor = body("rotor", Sphere{0.02}, Vec3(0.3, 0, 0.1));
  rotor.body->inertia = Vec3(1e-4, 1e-4, 1e-4);
  BodyJoint& joint = rotor.body->joint.emplace();
  joint.kind = BodyJoint::Kind::hinge;
  joint.force.spring = 0.002;
  joint.force.rest = 60;
  EXPECT_THAT(quick_mechanisms(on_a_floor({frame, rotor}), 1e-3), ElementsAre()) << "on the world";
  joint.to = "frame";
  EXPECT_THAT(quick_mechanisms(on_a_floor({frame, rotor}), 1e-3),
              ElementsAre(AllOf(HasSubstr("'frame': its springs store 3.6 J"),
                                HasSubstr("by 28.3 rad"), HasSubstr("at most 1 rad"))));
  EXPECT_THAT(quick_mechanisms(on_a_floor({frame, rotor}), 3e-5), ElementsAre());
  joint.force.spring = 0;
  Scene scene = on_a_floor({frame, rotor});
  scene.springs.push_back({.between = {"frame", ""},
                           .points = {Vec3::Zero(), Vec3(0.3, 0, 0.12)},
                           .stiffness = 500});  // 3.6 J
  EXPECT_THAT(quick_mechanisms(scene, 1e-3), ElementsAre(HasSubstr("by 28.3 rad")));
}

TEST(BodyReport, KnowsWhichInertiaThereIs) {
  EXPECT_TRUE(possible_inertia(Vec3(1, 1, 1)));
  EXPECT_TRUE(possible_inertia(Vec3(1, 2, 3))) << "a flat one";
  EXPECT_FALSE(possible_inertia(Vec3(1, 3.1, 2)));
  EXPECT_FALSE(possible_inertia(Vec3(1e-6, 1e-6, 2.1e-6)));
}

// A cube of 100 g and 20 mm has m a^2 / 6, 6.7e-6 kg m^2 or 6.7 g mm^2 times a million.
TEST(BodyReport, WarnsOfMomentsInOtherUnits) {
  const auto warned = [](double moment) {
    Object cube = body("cube", Box{{0.02, 0.02, 0.02}}, Vec3(0, 0, 0.1), 0.1);
    cube.body->inertia = Vec3::Constant(moment);
    const BodyReport report = report_on_bodies(on_a_floor({cube}), arm());
    return std::ranges::count_if(report.warnings, [](const std::string& warning) {
      return warning.find("in kg m^2?") != std::string::npos;
    });
  };
  EXPECT_EQ(warned(6.7e-6), 0);
  EXPECT_EQ(warned(2e-5), 0) << "all of it in the corners";
  EXPECT_EQ(warned(6700), 1);
}

TEST(BodyReport, WarnsOfAllThat) {
  const Vec3 root = arm().joints[0].origin.translation();
  Object heavy = body("heavy", Sphere{0.02}, root, 1);
  heavy.body->inertia = Vec3(1, 1, 3);
  const Vec3 beside = root + Vec3(0, 0, 0.01), far = root + Vec3(0, 9, 0);
  const BodyReport report = report_on_bodies(
      on_a_floor({heavy, body("inside", Sphere{0.02}, beside), body("far", Sphere{0.02}, far)},
                 root.z() - 0.3),
      arm());
  ASSERT_EQ(report.facts.size(), 4u);
  EXPECT_THAT(report.facts[0], HasSubstr("3 objects, 0 springs"));
  EXPECT_THAT(report.facts[1], HasSubstr("1 kg"));
  ASSERT_EQ(report.warnings.size(), 4u);
  EXPECT_THAT(report.warnings[0], HasSubstr("[1, 1, 3]"));
  EXPECT_THAT(report.warnings[1], HasSubstr("'far'"));
  EXPECT_THAT(report.warnings[2], HasSubstr("0.2 J: falling objects may hurt the hand"));
  EXPECT_THAT(report.warnings[3], HasSubstr("'heavy' and 'inside'"));
  EXPECT_TRUE(report_on_bodies(on_a_floor({}), arm()).facts.empty());
}

}  // namespace
}  // namespace limpid
