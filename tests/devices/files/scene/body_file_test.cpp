// Objects that move, in files: reading, refusals, and reading of what was written.
#include "devices/files/scene/body_file.h"

#include <fmt/format.h>

#include <array>

#include "core/touch/mass_properties.h"
#include "devices/files/rpy.h"
#include "devices/files/scene/scene_file.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/meshes.h"
#include "tests/support/objects.h"

namespace limpid {
namespace {

using test::Random;
using test::refusal;
using testing::HasSubstr;

ArmDescription one_joint() {
  ArmDescription a;
  a.joints = {{"turn"}};
  a.links = {{"one"}};
  a.frames = {{"one", 0, Pose::Identity()}};
  return a;
}

SceneDocument parse_bodies(const std::string& text, const std::filesystem::path& folder = "/tmp",
                           const SceneFiles& files = {}) {
  return parse_scene(text, "x.toml", folder, one_joint(), files);
}

std::string body(const std::string& rest, const std::string& name = "a") {
  return "[[body]]\nname = \"" + name + "\"\nbox = [0.1, 0.2, 0.3]\nmass = 0.5\n" +
         "position = [0, 0, 1]\n" + rest;
}
std::string joint(const std::string& rest, const std::string& kind = "slider") {
  return body("[body.joint]\nkind = \"" + kind + "\"\n" + rest);
}

void expect_same_scene(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.gravity, b.gravity);
  EXPECT_EQ(a.springs, b.springs);
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (std::size_t i = 0; i < a.objects.size(); ++i) test::expect_same(a.objects[i], b.objects[i]);
}

void expect_kept(const SceneDocument& document) {
  const std::string text = scene_text(document, one_joint());
  SCOPED_TRACE(text);
  const SceneDocument again = parse_bodies(text, "", files_of(document));
  expect_same_scene(again.scene, document.scene);
  EXPECT_EQ(scene_text(again, one_joint()), text);
}

TEST(BodyFile, ReadsADieAndAKeyAsTheSheetHasThem) {
  const SceneDocument document = parse_bodies(R"(
gravity = [0, 0, -1.62]
[[body]]
name = "die"
box = [0.03, 0.03, 0.03]
mass = 0.05
position = [0.18, 0, -0.025]
rotation = [0, 0, 1.5707963267948966]
stiffness = 2000
friction_static = 0.5
friction_kinetic = 0.4
restitution = 0.25
contact_stiffness = 30000
magnet = true
color = [0.8, 0.25, 0]
[[body]]
name = "key"
box = [0.012, 0.012, 0.006]
mass = 0.002
center = [0, 0, 0.001]
inertia = [1e-6, 2e-6, 3e-6]
position = [0.2, 0, -0.03]
[[body.part]]
sphere = 0.004
position = [0, 0, 0.003]
color = [1, 1, 1]
[body.joint]
kind = "slider"
axis = [0, 0, -2]
limits = [0, 0.0096]
damping = 0.5
friction = 0.25
detent = { force = 0.4, period = 0.008 }
travel = [[0, 0.5], [0.002, 0.9], [0.006, 0.1]]
[[spring]]
between = ["die", "key"]
points = [[0, 0, 0.015], [0, 0, 0]]
length = 0.01
stiffness = 100
damping = 0.1
breaks_at = 20
)");
  const Scene& scene = document.scene;
  EXPECT_EQ(scene.gravity, Vec3(0, 0, -1.62));
  ASSERT_EQ(count_bodies(scene), 2);
  const Object &die = scene.objects[0], &key = scene.objects[1];
  EXPECT_TRUE(die.shape == Shape(Box{Vec3::Constant(0.03)}));
  EXPECT_LT((die.pose * Vec3(0.01, 0, 0) - Vec3(0.18, 0.01, -0.025)).norm(), 1e-15);
  EXPECT_EQ(die.material.stiffness, 2000);
  EXPECT_EQ(die.material.friction_kinetic, 0.4);
  EXPECT_EQ(die.body->mass, 0.05);
  EXPECT_EQ(die.body->restitution, 0.25);
  EXPECT_EQ(die.body->contact_stiffness, 30000);
  EXPECT_TRUE(die.body->magnet);
  EXPECT_FALSE(key.body->magnet);
  EXPECT_EQ(die.color, Vec3(0.8, 0.25, 0));
  EXPECT_FALSE(key.color);
  EXPECT_EQ(key.material.stiffness, Material{}.stiffness);
  EXPECT_EQ(key.body->center, Vec3(0, 0, 0.001));
  EXPECT_EQ(key.body->inertia, Vec3(1e-6, 2e-6, 3e-6));
  ASSERT_EQ(key.parts.size(), 1u);
  EXPECT_EQ(key.parts[0].pose.translation(), Vec3(0, 0, 0.003));
  EXPECT_EQ(key.parts[0].color, Vec3(1, 1, 1));
  ASSERT_TRUE(key.body->joint);
  const BodyJoint& slide = *key.body->joint;
  EXPECT_EQ(slide.kind, BodyJoint::Kind::slider);
  EXPECT_EQ(slide.axis, Vec3(0, 0, -1));
  EXPECT_EQ(slide.high, 0.0096);
  EXPECT_EQ(slide.force.detent_force, 0.4);
  EXPECT_EQ(slide.force.detent_period, 0.008);
  ASSERT_EQ(slide.force.travel.size(), 3u);
  EXPECT_EQ(slide.force.travel[1][1], 0.9);
  ASSERT_EQ(scene.springs.size(), 1u);
  EXPECT_EQ(scene.springs[0].between[1], "key");
  EXPECT_EQ(scene.springs[0].points[0], Vec3(0, 0, 0.015));
  EXPECT_EQ(scene.springs[0].breaks_at, 20);
  expect_kept(document);
}

TEST(BodyFile, ReadsEveryShape) {
  const auto shape = [](const std::string& key) {
    return parse_bodies("[[body]]\nname = \"a\"\n" + key + "\nmass = 1\nposition = [0, 0, 0]\n")
        .scene.objects.at(0)
        .shape;
  };
  EXPECT_TRUE(shape("sphere = 0.02") == Shape(Sphere{0.02}));
  EXPECT_TRUE(shape("cylinder = [0.02, 0.05]") == Shape(Cylinder{0.02, 0.05}));
  EXPECT_TRUE(shape("capsule = [0.02, 0.05]") == Shape(Capsule{0.02, 0.05}));
  EXPECT_TRUE(shape("box = [1, 2, 3]") == Shape(Box{Vec3(1, 2, 3)}));
}

TEST(BodyFile, TurnsDensityIntoMass) {
  const Scene scene =
      parse_bodies(
          "[[body]]\nname = \"a\"\nbox = [0.1, 0.1, 0.1]\ndensity = 500\nposition = [0, 0, 0]\n"
          "[[body.part]]\nbox = [0.1, 0.1, 0.2]\n")
          .scene;
  EXPECT_NEAR(scene.objects.at(0).body->mass, 1.5, 1e-12);
}

TEST(BodyFile, GivesAMeshItsMassWhenItIsBuilt) {
  const test::TempDir dir;
  test::write_file(dir / "a.stl", "bytes");
  const std::string text =
      "[[body]]\nname = \"a\"\nfile = \"a.stl\"\ndensity = 500\nposition = [0, 0, 0]\n";
  SceneDocument document = parse_bodies(text, dir / "");
  EXPECT_EQ(document.models.size(), 1u);
  EXPECT_THAT(scene_text(document, one_joint()), HasSubstr("density = 500"));
  Mesh& mesh = std::get<Mesh>(document.scene.objects.at(0).shape);
  mesh.triangles = test::icosphere(3).mapped([](const Vec3& p) { return Vec3(100 * p); }).mesh();
  settle_masses(document);
  const double found = document.scene.objects[0].body->mass;
  EXPECT_NEAR(found, 500 * 4.18879e-3, 0.02 * found);
  EXPECT_EQ(scene_text(document, one_joint()).find("density"), std::string::npos);

  SceneDocument heavy = parse_bodies(text, dir / "");
  mesh = std::get<Mesh>(document.scene.objects[0].shape);
  std::get<Mesh>(heavy.scene.objects[0].shape) = mesh;
  std::get<Mesh>(heavy.scene.objects[0].shape).unit = 1;
  EXPECT_THAT(refusal([&] { settle_masses(heavy); }), HasSubstr("body a: density: 500"));
}

TEST(BodyFile, KeepsTheirOrderBehindWhatStandsStill) {
  const SceneDocument document = parse_bodies(
      "[[body]]\nname = \"b\"\nsphere = 0.1\nmass = 1\nposition = [0, 0, 0]\n" + body("") +
      "[[sphere]]\nname = \"s\"\ncenter = [0, 0, 0]\nradius = 1\nstiffness = 1\n"
      "[[cylinder]]\nname = \"c\"\nposition = [0, 0, 0]\nradius = 1\nlength = 1\n"
      "stiffness = 1\n");
  std::string names;
  for (const Object& object : document.scene.objects) names += object.name;
  EXPECT_EQ(names, "scba");
  expect_kept(document);
}

struct Case {
  std::string text;
  std::vector<std::string> said;
};

void expect_refused(const std::vector<Case>& cases) {
  for (const Case& c : cases) {
    const std::string said = refusal([&] { parse_bodies(c.text); });
    for (const std::string& part : c.said) EXPECT_THAT(said, HasSubstr(part)) << c.text;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  }
}

TEST(BodyFile, RefusesWhatABodyCannotBe) {
  const std::string start = "[[body]]\nname = \"a\"\nposition = [0, 0, 0]\n";
  expect_refused({
      {"gravity = 9.81\n", {"x.toml:1: gravity", "9.81", "a list of 3"}},
      {body("colour = 1\n"),
       {"x.toml:6: body.colour", "no such key; did you mean color?", "contact_stiffness"}},
      {body("scale = 2\n"), {"x.toml:6: body.scale", "no such key"}},
      {body("rpy = [0, 0, 0]\n"), {"no such key; did you mean rotation?"}},
      {start + "mass = 1\n", {"x.toml:1: body.shape", "missing", "box, sphere"}},
      {start + "mass = 1\nbox = [1, 1, 1]\nsphere = 1\n",
       {"x.toml:6: body.sphere", "sphere beside box", "one of"}},
      {start + "mass = 1\ncylinder = [0.1]\n", {"x.toml:5: body.cylinder", "[0.1]", "a list of 2"}},
      {start + "mass = 1\ncapsule = [0.1, 0]\n", {"body.capsule", "above 0"}},
      {start + "mass = 1\nfile = \"x.png\"\n", {"x.toml:5: body.file", "x.png", ".glb"}},
      {start + "mass = 1\nfile = \"x.glb\"\nup = \"x\"\n", {"body.up", "\"y\", \"z\""}},
      {start + "box = [1, 1, 1]\n", {"x.toml:1: body.mass (or density): missing"}},
      {start + "sphere = 0.1\nmass = 1e-7\n", {"body.mass", "1e-07", "1e-06 up to 100 kg"}},
      {start + "sphere = 0.1\nmass = 101\n", {"body.mass", "101"}},
      {start + "sphere = 0.1\nmass = 1\ndensity = 1\n",
       {"body.density", "mass or density, not both"}},
      {start + "sphere = 1\ndensity = 1000\n", {"body.density", "1000", "to 100 kg"}},
      {start + "sphere = 1\ndensity = 0\n", {"body.density", "0", "above 0"}},
      {body("inertia = [1, 0, 1]\n"), {"x.toml:6: body.inertia", "[1, 0, 1]", "above 0"}},
      {body("center = [1, 0]\n"), {"x.toml:6: body.center", "[1, 0]"}},
      {body("rotation = 1\n"), {"x.toml:6: body.rotation", "a list of 3"}},
      {body("rotation = [0, 0, 0, 1]\n"), {"body.rotation", "a list of 3"}},
      {body("restitution = 1.5\n"), {"x.toml:6: body.restitution", "1.5", "0 up to 1"}},
      {body("color = [0.5, 2, 0]\n"), {"x.toml:6: body.color", "2", "0 up to 1"}},
      {body("contact_stiffness = 0\n"), {"body.contact_stiffness", "above 0"}},
      {body("magnet = 1\n"), {"x.toml:6: body.magnet", "1", "true, false"}},
      {body("[[body.part]]\nfile = \"x.glb\"\n"), {"body.part.file", "no such key"}},
      {body("[[body.part]]\nposition = [0, 0, 0]\n"), {"x.toml:6: body.part.shape", "missing"}},
      {body("[body.part]\nsphere = 1\n"), {"body.part", "[[body.part]]"}},
      {body("") + body(""), {"x.toml:7: body.name", "\"a\"", "no other body"}},
      {body("", ""), {"x.toml:2: body.name", "not empty"}},
      {"body = 3\n", {"x.toml:1: body", "[[body]]"}},
  });
}

TEST(BodyFile, RefusesWhatAJointCannotBe) {
  const std::string axis = "axis = [0, 0, 1]\n";
  expect_refused({
      {body("joint = 3\n"), {"x.toml:6: body.joint", "3", "[body.joint]"}},
      {body("[body.joint]\naxis = [0, 0, 1]\n"), {"x.toml:6: body.joint.kind", "missing"}},
      {joint("", "screw"), {"x.toml:7: body.joint.kind", "screw", "hinge"}},
      {joint(""), {"x.toml:6: body.joint.axis", "missing"}},
      {joint("axis = [0, 0, 0]\n"), {"x.toml:8: body.joint.axis", "not zero"}},
      {joint(axis + "point = [0, 0, 0]\n"), {"x.toml:9: body.joint.point", "no such key"}},
      {joint(axis, "ball"), {"x.toml:8: body.joint.axis", "no such key"}},
      {joint(axis + "limits = [1, 0]\n"), {"x.toml:9: body.joint.limits", "[1, 0]", "less"}},
      {joint(axis + "limits = [0, 0]\n"), {"body.joint.limits"}},
      {joint(axis + "limits = [nan, 0]\n"), {"body.joint.limits", "nan"}},
      {joint(axis + "limits = 1\n"), {"body.joint.limits", "a list of 2"}},
      {joint(axis + "stop_stiffness = 0\n"), {"body.joint.stop_stiffness", "above 0"}},
      {joint(axis + "stop_restitution = 2\n"), {"body.joint.stop_restitution", "2"}},
      {joint(axis + "damping = -1\n"), {"body.joint.damping", "-1"}},
      {joint(axis + "friction = -1\n"), {"body.joint.friction", "-1"}},
      {joint(axis + "spring = -1\n"), {"body.joint.spring", "-1"}},
      {joint(axis + "rest = inf\n"), {"body.joint.rest", "inf"}},
      {joint(axis + "detent = 1\n"), {"x.toml:9: body.joint.detent", "1"}},
      {joint(axis + "detent = { force = 1 }\n"), {"body.joint.detent.period", "missing"}},
      {joint(axis + "detent = { force = 1, period = 0 }\n"), {"body.joint.detent.period", "0"}},
      {joint(axis + "detent = { force = 1, period = 1, phase = 1 }\n"), {"phase", "force, period"}},
      {joint(axis + "travel = [[0, 1], [0, 2]]\n"),
       {"x.toml:9: body.joint.travel", "[[0, 1], [0, 2]]", "larger"}},
      {joint(axis + "travel = []\n"), {"body.joint.travel", "at least one"}},
      {joint(axis + "travel = [0, 1]\n"), {"body.joint.travel", "lists of 2"}},
      {joint(axis + "to = \"b\"\n"), {"x.toml:9: body.joint.to", "\"b\"", "one of the bodies a"}},
      {joint(axis + "to = \"a\"\n"), {"x.toml:9: body.joint.to", "whose joints do not lead to"}},
      {joint(axis + "to = \"b\"\n") + body("[body.joint]\nkind = \"ball\"\nto = \"a\"\n", "b"),
       {"x.toml:9: body.joint.to", "\"b\"", "whose joints do not lead to"}},
  });
}

TEST(BodyFile, RefusesWhatASpringCannotBe) {
  const std::string two = body("") + body("", "b"), spring = two + "[[spring]]\n";
  expect_refused({
      {spring, {"x.toml:11: spring.between", "missing"}},
      {spring + "between = []\n", {"x.toml:12: spring.between", "one or two"}},
      {spring + "between = [\"a\", \"b\", \"a\"]\n", {"spring.between", "one or two"}},
      {spring + "between = [\"a\", \"c\"]\n", {"spring.between", "one of the bodies a, b"}},
      {spring + "between = [\"\", \"a\"]\n", {"spring.between", "one of the bodies"}},
      {spring + "between = [\"a\", \"a\"]\n", {"spring.between", "two different bodies"}},
      {spring + "between = [\"a\"]\npoints = [[0, 0, 0]]\n", {"x.toml:13: spring.points", "of 2"}},
      {spring + "between = [\"a\"]\npoints = [[0, 0], [0, 0]]\n", {"spring.points", "of 3"}},
      {spring + "between = [\"a\"]\nlength = -1\n", {"spring.length", "-1"}},
      {spring + "between = [\"a\"]\nstiffness = -1\n", {"spring.stiffness", "-1"}},
      {spring + "between = [\"a\"]\ndamping = -1\n", {"spring.damping", "-1"}},
      {spring + "between = [\"a\"]\nbreaks_at = 0\n", {"spring.breaks_at", "above 0"}},
      {spring + "between = [\"a\"]\nrest = 0\n", {"spring.rest", "no such key"}},
      {"[[spring]]\nbetween = [\"a\"]\n", {"x.toml:2: spring.between", "the file has no bodies"}},
  });
}

TEST(BodyFile, HoldsAtMost64Bodies) {
  std::string text;
  for (int i = 0; i < 64; ++i) text += body("", fmt::format("b{}", i));
  EXPECT_EQ(count_bodies(parse_bodies(text).scene), 64);
  EXPECT_THAT(refusal([&] { parse_bodies(text + body("")); }),
              testing::AllOf(HasSubstr("x.toml:1: body: 65 bodies"), HasSubstr("at most 64")));
}

Pose random_pose(Random& random) {
  Pose pose = Pose::Identity();
  pose.linear() = settled(random.rotation());
  pose.translation() = random.point(0.5);
  return pose;
}

Shape random_shape(Random& random) {
  const auto length = [&] { return random.between(0.01, 0.1); };
  switch (static_cast<int>(random.between(0, 3.999))) {
    case 0: return Sphere{length()};
    case 1: return Box{Vec3(length(), length(), length())};
    case 2: return Cylinder{length(), length()};
    default: return Capsule{length(), length()};
  }
}

BodyJoint random_joint(Random& random, int kind) {
  BodyJoint joint;
  joint.kind = static_cast<BodyJoint::Kind>(kind);
  joint.axis = random.direction();
  joint.point = random.point(0.1);
  joint.damping = random.between(0, 1);
  joint.friction = random.between(0, 1);
  joint.low = random.between(-1, 0);
  joint.high = kind == 1 ? joint.high : random.between(0, 1);
  joint.stop_stiffness = random.between(1, 1e5);
  joint.stop_restitution = random.between(0, 1);
  joint.force = {random.between(0, 100),
                 random.between(-0.1, 0.1),
                 random.between(0, 1),
                 random.between(0.01, 0.1),
                 {}};
  for (int i = 0; i < 3; ++i) joint.force.travel.push_back({i + random.between(0, 1), -1.0 * i});
  return joint;
}

Object random_body(Random& random, int i) {
  Object object{.name = fmt::format("body \"{}\"", i), .shape = random_shape(random)};
  object.pose = random_pose(random);
  object.material = {random.between(1, 1e4), random.between(0, 1), random.between(0, 1), 0.25};
  object.body = Body{};
  Body& body = *object.body;
  body.mass = random.between(0.001, 1);
  if (i % 2 == 0) body.center = random.point(0.1);
  if (i % 3 == 0) body.inertia = random.point(0.1).cwiseAbs() + Vec3::Constant(0.1);
  body.contact_stiffness = random.between(1, 1e5);
  body.restitution = random.between(0, 1);
  body.magnet = i % 2 == 1;
  for (int k = 0; k < i % 3; ++k) {
    object.parts.push_back({random_pose(random), random_shape(random)});
  }
  if (i % 4 != 3) body.joint = random_joint(random, i % 4);
  if (body.joint && i > 4) body.joint->to = fmt::format("body \"{}\"", i - 4);
  return object;
}

TEST(BodyFile, WritesWhatItReadsBackToTheLastBit) {
  Random random(8);
  for (int round = 0; round < 20; ++round) {
    SceneDocument document;
    Scene& scene = document.scene;
    scene.gravity = random.point(10);
    for (int i = 0; i < 12; ++i) {
      Object object = random_body(random, i);
      hold(object);
      scene.add(std::move(object));
    }
    scene.springs.push_back({{"body \"1\"", ""}, {random.point(1), random.point(1)}});
    scene.springs.push_back({{"body \"1\"", "body \"2\""}, {}, 0.1, 20, 0.5, 10});
    expect_kept(document);
  }
}

TEST(BodyFile, HoldsWhatAFileCannotSay) {
  Object object{.name = "a", .shape = Box{}, .body = Body{}};
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  Body& body = *object.body;
  body.mass = -1;
  body.restitution = 7;
  body.contact_stiffness = kNone;
  body.inertia = Vec3(-1, kNone, 1);
  body.joint = BodyJoint{};
  body.joint->axis.setZero();
  body.joint->low = 2;
  body.joint->high = 1;
  body.joint->force.travel = {{1, 5}, {0, 4}, {1, 3}};
  object.parts.push_back({pose_at(Vec3(kNone, 1e9, 0)), Sphere{-1}});
  object.color = Vec3(-1, 0.25, 3);
  hold(object);
  EXPECT_EQ(object.color, Vec3(0, 0.25, 1));
  EXPECT_EQ(object.body->mass, 1e-6);
  EXPECT_EQ(object.body->restitution, 1);
  EXPECT_EQ(object.body->joint->axis, Vec3(Vec3::UnitZ()));
  const std::vector<std::array<double, 2>> increasing{{0, 4}, {1, 5}};
  EXPECT_EQ(object.body->joint->force.travel, increasing);
  SceneDocument document;
  document.scene.add(object);
  expect_kept(document);
}

}  // namespace
}  // namespace limpid
