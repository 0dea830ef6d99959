#include "devices/files/scene/scene_file.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/objects.h"

namespace limpid {
namespace {

using test::refusal;
using testing::HasSubstr;

ArmDescription two_joints() {
  ArmDescription a;
  a.joints = {{"turn"}, {"lift"}};
  a.links = {{"one"}, {"two"}};
  a.frames = {{"base", -1, Pose::Identity()},
              {"one", 0, Pose::Identity()},
              {"two", 1, Pose::Identity()},
              {"tool", 1, Pose(Eigen::Translation3d(0.5, 0, 0))}};
  return a;
}

SceneDocument parse(const std::string& text) {
  return parse_scene(text, "x.toml", "/tmp", two_joints());
}

TEST(Scene, MayBeEmpty) {
  const Scene scene = parse("").scene;
  EXPECT_TRUE(scene.objects.empty());
  EXPECT_EQ(scene.tip_radius, 0);
}

TEST(Scene, ReadsEveryKindOfThing) {
  const SceneDocument document = parse(R"(
title = "T"
about = "A."
tip_radius = 0.003
[[plane]]
name = "p"
point = [0, 0, -0.1]
normal = [0, 3, 4]
stiffness = 100
[[sphere]]
name = "s"
center = [1, 2, 3]
radius = 0.5
stiffness = 200
[[box]]
name = "b"
center = [1, 0, 0]
size = [0.1, 0.2, 0.3]
rpy = [0, 0, 1.5707963267948966]
stiffness = 300
[[joint_contact]]
name = "j"
joint = "lift"
angle = 0.5
side = "above"
stiffness = 20
[[joint_contact]]
name = "k"
joint = 1
angle = -0.5
side = "below"
stiffness = 10
[[probe]]
name = "q"
link = "tool"
from = [0.1, 0, 0]
radius = 0.01
)");
  const Scene& s = document.scene;
  EXPECT_EQ(document.title, "T");
  EXPECT_EQ(document.about, "A.");
  EXPECT_EQ(s.tip_radius, 0.003);
  EXPECT_LT((test::shape<Plane>(s).normal - Vec3(0, 0.6, 0.8)).norm(), 1e-15);
  EXPECT_EQ(test::object<Sphere>(s).pose.translation(), Vec3(1, 2, 3));
  EXPECT_LT((test::object<Box>(s).pose * Vec3(0.05, 0, 0) - Vec3(1, 0.05, 0)).norm(), 1e-15);
  EXPECT_EQ(test::shape<JointStop>(s, 0).joint, 1);
  EXPECT_EQ(test::shape<JointStop>(s, 0).direction, 1);
  EXPECT_EQ(test::shape<JointStop>(s, 1).joint, 0);
  EXPECT_EQ(test::shape<JointStop>(s, 1).direction, -1);
  EXPECT_EQ(s.probes.at(0).link, 1);
  EXPECT_EQ(s.probes.at(0).from, Vec3(0.6, 0, 0)) << "moved with the link it is fixed to";
  EXPECT_EQ(s.probes.at(0).to, s.probes.at(0).from);
}

TEST(Scene, RefusesWithFileLineKeyFoundAndAllowed) {
  struct Case {
    std::string text;
    std::vector<std::string> said;
  };
  const auto plane = [](const std::string& rest) {
    return "[[plane]]\nname = \"p\"\npoint = [0, 0, 0]\n" + rest;
  };
  const Case cases[] = {
      {"tipradius = 1\n", {"x.toml:1:", "tipradius", "tip_radius"}},
      {"title = 3\n", {"x.toml:1:", "title", "3", "text"}},
      {"tip_radius = -1\n", {"x.toml:1:", "tip_radius", "-1"}},
      {"plane = 3\n", {"x.toml:1:", "plane", "[[plane]]"}},
      {"[plane]\nname = \"p\"\n", {"x.toml:1:", "plane", "[[plane]]"}},
      {plane("normal = [0, 0, 0]\nstiffness = 1\n"), {"x.toml:4:", "plane.normal", "zero"}},
      {plane("normal = [0, 1]\nstiffness = 1\n"), {"x.toml:4:", "plane.normal", "[0, 1]", "3"}},
      {plane("normal = [0, 1, nan]\nstiffness = 1\n"), {"x.toml:4:", "plane.normal", "nan"}},
      {plane("normal = [0, 1, \"z\"]\nstiffness = 1\n"), {"x.toml:4:", "plane.normal"}},
      {plane("normal = [0, 0, 1]\nstiffness = 0\n"), {"x.toml:5:", "plane.stiffness", "0"}},
      {plane("normal = [0, 0, 1]\nstiffness = 2e6\n"), {"x.toml:5:", "stiffness", "1000000"}},
      {plane("normal = [0, 0, 1]\nstiffness = inf\n"), {"x.toml:5:", "stiffness", "inf"}},
      {plane("normal = [0, 0, 1]\n"), {"x.toml:1:", "plane.stiffness", "missing"}},
      {plane("normal = [0, 0, 1]\nstiffness = 1\ncolor = 1\n"), {"x.toml:6:", "plane.color"}},
      {"[[sphere]]\nname = \"s\"\ncenter = [0, 0, 0]\nradius = 0\nstiffness = 1\n",
       {"x.toml:4:", "sphere.radius", "0"}},
      {"[[box]]\nname = \"s\"\ncenter = [0, 0, 0]\nsize = [1, -1, 1]\nstiffness = 1\n",
       {"x.toml:4:", "box.size", "-1"}},
      {"[[joint_contact]]\nname = \"j\"\njoint = \"knee\"\nangle = 0\nside = \"above\"\n"
       "stiffness = 1\n",
       {"x.toml:3:", "joint_contact.joint", "knee", "turn, lift"}},
      {"[[joint_contact]]\nname = \"j\"\njoint = 3\nangle = 0\nside = \"above\"\nstiffness = 1\n",
       {"x.toml:3:", "joint_contact.joint", "3", "1 to 2"}},
      {"[[joint_contact]]\nname = \"j\"\njoint = 1\nangle = 0\nside = \"left\"\nstiffness = 1\n",
       {"x.toml:5:", "joint_contact.side", "left", "above"}},
      {"[[probe]]\nname = \"q\"\nlink = \"base\"\nfrom = [0, 0, 0]\nradius = 0.1\n",
       {"x.toml:3:", "probe.link", "base", "one, two, tool"}},
      {"[[visual]]\nfile = \"nothing.glb\"\n", {"x.toml:2:", "visual.file", "nothing.glb"}},
      {"[[visual]]\nscale = 1\n", {"x.toml:1:", "visual.file", "missing"}},
      {"[[plane\n", {"x.toml:1:", "not TOML"}},
      {" c_ =f\n", {"x.toml:1:", "not TOML"}},
  };
  for (const Case& c : cases) {
    const std::string said = refusal([&] { parse(c.text); });
    for (const std::string& part : c.said) EXPECT_THAT(said, HasSubstr(part)) << c.text;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  }
}

TEST(Scene, GivesAllThatHasASurfaceAMaterialOfTheSameKeys) {
  const std::string objects[] = {"[[plane]]\nname = \"a\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n",
                                 "[[sphere]]\nname = \"a\"\ncenter = [0, 0, 0]\nradius = 1\n",
                                 "[[box]]\nname = \"a\"\ncenter = [0, 0, 0]\nsize = [1, 1, 1]\n"};
  for (const std::string& object : objects) {
    const Scene scene = parse(object + "stiffness = 1e6\n").scene;
    EXPECT_EQ(scene.objects.at(0).material.stiffness, 1e6);
    EXPECT_THAT(refusal([&] { parse(object); }), HasSubstr(".stiffness: missing")) << object;
    for (const char* wrong : {"0", "1.1e6", "nan", "true"}) {
      EXPECT_THAT(refusal([&] { parse(object + "stiffness = " + wrong + "\n"); }),
                  HasSubstr(".stiffness"))
          << object << wrong;
    }
    EXPECT_THAT(refusal([&] { parse(object + "stiffness = 1\nhardness = 1\n"); }),
                HasSubstr(", stiffness"))
        << object;
  }
}

TEST(Scene, HoldsAtMost64ContactsAnd63ProbesBesidesTheTip) {
  const auto spheres = [](int count) {
    std::string text;
    for (int i = 0; i < count; ++i) {
      text += "[[sphere]]\nname = \"s\"\ncenter = [0, 0, 0]\nradius = 1\nstiffness = 1\n";
    }
    return text;
  };
  const auto probes = [](int count) {
    std::string text;
    for (int i = 0; i < count; ++i) {
      text += "[[probe]]\nname = \"q\"\nlink = \"one\"\nfrom = [0, 0, 0]\nradius = 1\n";
    }
    return text;
  };
  EXPECT_EQ(parse(spheres(64) + probes(63)).scene.objects.size(), 64u);
  EXPECT_THAT(refusal([&] { parse(spheres(65)); }), HasSubstr("65"));
  EXPECT_THAT(refusal([&] { parse(probes(64)); }), HasSubstr("64"));
}

TEST(Scene, ReadsCylindersAndCapsulesThatStandStill) {
  for (const std::string kind : {"cylinder", "capsule"}) {
    const std::string text = "[[" + kind +
                             "]]\nname = \"c\"\nradius = 0.02\nlength = 0.06\n"
                             "position = [1, 2, 3]\nrotation = [0, 1.5707963267948966, 0]\n"
                             "stiffness = 300\n";
    const Scene scene = parse(text).scene;
    const Object& found = scene.objects.at(0);
    EXPECT_EQ(has_shape<Cylinder>(found), kind == "cylinder");
    EXPECT_TRUE(found.shape == Shape(Cylinder{0.02, 0.06}) ||
                found.shape == Shape(Capsule{0.02, 0.06}));
    EXPECT_LT((found.pose * Vec3(0, 0, 0.03) - Vec3(1.03, 2, 3)).norm(), 1e-15);
    EXPECT_EQ(found.material.stiffness, 300);
    const SceneDocument again = parse(scene_text(parse(text), two_joints()));
    test::expect_same(again.scene.objects.at(0), found);
    for (const char* key : {"radius", "length"}) {
      std::string wrong = text;
      wrong.insert(wrong.find(key) + std::string(key).size() + 3, "-");
      EXPECT_THAT(refusal([&] { parse(wrong); }), HasSubstr(kind + "." + key));
    }
  }
}

TEST(Scene, LeavesOutRelativeFilesOfATextWithoutAFolder) {
  EXPECT_TRUE(
      parse_scene("[[visual]]\nfile = \"a.glb\"\n", "session", "", two_joints()).visuals.empty());
}

std::string mesh(const std::string& file) {
  return "[[mesh]]\nname = \"m\"\nfile = \"" + file + "\"\nstiffness = 1\n";
}

TEST(Scene, HasTheModelsOfItsMeshesEachOnce) {
  const test::TempDir dir;
  test::write_file(dir / "a.glb", "bytes of a");
  test::write_file(dir / "b.glb", "bytes of b");
  const SceneDocument read =
      parse_scene(mesh("a.glb") + mesh("b.glb") + mesh("a.glb"), "x.toml", dir / "", two_joints());
  ASSERT_EQ(read.scene.objects.size(), 3u);
  EXPECT_EQ(test::shape<Mesh>(read.scene, 2).model, "a.glb");
  ASSERT_EQ(read.models.size(), 2u);
  EXPECT_EQ(read.models.at("b.glb").path, (dir / "b.glb").string());
  const SceneFiles files = files_of(read);
  EXPECT_EQ(files.at("b.glb"), read.models.at("b.glb").bytes);

  // Files handed in take precedence over those in the folder, and only named ones are kept.
  const SceneDocument again = parse_scene(mesh("b.glb"), "x.toml", dir / "", two_joints(), files);
  ASSERT_EQ(again.models.size(), 1u);
  EXPECT_EQ(again.models.at("b.glb").path, "");
  EXPECT_EQ(again.models.at("b.glb").bytes, files.at("b.glb"));
}

}  // namespace
}  // namespace limpid
