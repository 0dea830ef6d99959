#include "devices/files/urdf_visuals.h"

#include <fmt/format.h>

#include "tests/devices/files/test_files.h"
#include "tests/devices/files/urdf_pieces.h"

namespace limpid {
namespace {

using test::joint;
using test::kInertial;
using test::link;
using test::parse;
using test::robot;
using testing::AllOf;
using testing::HasSubstr;

std::string visual(const std::string& geometry, const std::string& more = {}) {
  return "<visual>" + more + "<geometry>" + geometry + "</geometry></visual>";
}
// A fixed link beside the axis of the joint that moves it.
const std::string kHand = joint("b", "hand", "fixed", "<origin xyz='0 1 0'/>") + link("hand", "");

ArmDescription showing(const std::string& visuals, const std::string& more = {}) {
  return parse(link("a") + joint("a", "b") + link("b", kInertial + visuals) + kHand + more);
}

TEST(UrdfVisuals, AreShapesAndMeshes) {
  const test::TempDir dir;
  test::write_file(dir / "m.glb", "");
  const std::string text =
      robot(link("a", visual("<box size='1 2 3'/>",
                             "<origin xyz='0 0 1' rpy='0 0 1.5707963267948966'/>")) +
            joint("a", "b") +
            link("b", std::string(kInertial) + visual("<cylinder radius='1' length='2'/>") +
                          visual("<sphere radius='3'/>") +
                          visual("<mesh filename='m.glb' scale='1 -1 2e0'/>")) +
            kHand);
  test::write_file(dir / "x.urdf", text);
  const ArmDescription arm = read_urdf(dir / "x.urdf");
  ASSERT_EQ(arm.visuals.size(), 4u);
  EXPECT_EQ(arm.visuals[0].link, -1);
  EXPECT_EQ(arm.visuals[0].size, Vec3(1, 2, 3));
  EXPECT_LT((arm.visuals[0].origin * Vec3(1, 0, 0) - Vec3(0, 1, 1)).norm(), 1e-15);
  EXPECT_EQ(arm.visuals[1].size.head<2>(), Eigen::Vector2d(1, 2));
  EXPECT_EQ(arm.visuals[2].size[0], 3);
  EXPECT_EQ(arm.visuals[3].mesh, (dir / "m.glb").string());
  EXPECT_EQ(arm.visuals[3].size, Vec3(1, -1, 2));
  EXPECT_EQ(arm.urdf, text);
  EXPECT_TRUE(arm.warnings.empty());
  const ArmDescription alone = parse_urdf(text, "session", "");
  ASSERT_EQ(alone.visuals.size(), 4u) << "a text without a folder";
  EXPECT_EQ(alone.visuals[3].shape, Visual::Shape::stand_in);
}

TEST(UrdfVisuals, HaveTheColoursOfTheirMaterials) {
  const std::string red = "<material name='red'><color rgba='1 0 0 0.5'/></material>";
  const ArmDescription arm = showing(
      visual("<sphere radius='1'/>", "<material name='blue'/>") +
          visual("<sphere radius='1'/>", red) +
          visual("<sphere radius='1'/>", "<material name='red'/>") +
          visual("<sphere radius='1'/>", "<material name='unknown'/>") +
          visual("<sphere radius='1'/>", "<material name='x'><color rgba='1 nan'/></material>"),
      "<material name='blue'><color rgba='0 0 2 1'/></material>");
  ASSERT_EQ(arm.visuals.size(), 5u);
  EXPECT_EQ(arm.visuals[0].color, Eigen::Vector4f(0, 0, 1, 1));
  EXPECT_EQ(arm.visuals[1].color, Eigen::Vector4f(1, 0, 0, 0.5f));
  EXPECT_EQ(arm.visuals[2].color, Eigen::Vector4f(1, 0, 0, 0.5f)) << "described at another link";
  EXPECT_FALSE(arm.visuals[3].color);
  EXPECT_FALSE(arm.visuals[4].color);
  EXPECT_TRUE(arm.warnings.empty());
}

// With any fault of a picture, the arm is read, and one line names the fault.
TEST(UrdfVisuals, ThatCannotBeShownAreAWarningAndAPlainShape) {
  const std::pair<std::string, std::string> cases[] = {
      {visual("<mesh filename='missing.glb'/>"), "missing.glb"},
      {visual("<mesh filename='package://arm/a.stl'/>"), "AMENT_PREFIX_PATH"},
      {visual("<mesh/>"), "filename"},
      {visual("<mesh filename='x' scale='0 1 1'/>"), "scale"},
      {visual("<mesh filename='x' scale='1 1'/>"), "scale"},
      {visual("<box size='1 2'/>"), "box size"},
      {visual("<box size='1 2 3 4'/>"), "box size"},
      {visual("<box size='1 -2 3'/>"), "no size"},
      {visual("<sphere radius='0'/>"), "no size"},
      {visual("<sphere/>"), "radius"},
      {visual("<cylinder radius='inf' length='1'/>"), "radius"},
      {visual("<blob/>"), "blob"},
      {visual(""), "geometry"},
      {"<visual/>", "geometry"},
      {visual("<sphere radius='1'/>", "<origin xyz='0 0 up'/>"), "origin"},
      {visual("<sphere radius='1'/>", "<origin xyz='0 0 1e300'/>"), "allowed: -1000000 to"},
      {visual("<mesh filename='a&#10;b.stl'/>"), "not found"},
  };
  for (const auto& [text, said] : cases) {
    const ArmDescription arm = showing(text);
    ASSERT_EQ(arm.warnings.size(), 1u) << text;
    EXPECT_THAT(arm.warnings[0], AllOf(HasSubstr("x.urdf:"), HasSubstr("'b'"), HasSubstr(said)));
    EXPECT_EQ(arm.warnings[0].find('\n'), std::string::npos);
    ASSERT_EQ(arm.visuals.size(), 1u);
    EXPECT_EQ(arm.visuals[0].shape, Visual::Shape::stand_in);
    EXPECT_EQ(arm.visuals[0].link, 0);
  }
}

// A link that is fixed beside another moves with it, in its own place.
TEST(UrdfVisuals, HaveShapesOfCollisionBesideThemInTheSamePlaces) {
  const test::TempDir dir;
  const std::string ball = "<geometry><sphere radius='2'/></geometry>";
  const std::string text =
      robot(link("a") + joint("a", "b") + link("b", kInertial) +
            joint("b", "hand", "fixed", "<origin xyz='0 1 0'/>") +
            link("hand", "<visual><origin xyz='0 0 3'/>" + ball + "</visual>" +
                             "<collision><origin xyz='0 0 3'/>" + ball + "</collision>" +
                             "<collision><geometry><blob/></geometry></collision>"));
  test::write_file(dir / "x.urdf", text);
  const ArmDescription arm = read_urdf(dir / "x.urdf");
  ASSERT_EQ(arm.visuals.size(), 1u);
  const std::vector<Visual> shapes = read_collisions(arm, dir / "x.urdf");
  ASSERT_EQ(shapes.size(), 1u) << "one that cannot be read is left out";
  EXPECT_EQ(shapes[0].link, 0);
  EXPECT_EQ(shapes[0].size[0], 2);
  EXPECT_EQ(shapes[0].origin.matrix(), arm.visuals[0].origin.matrix());
  EXPECT_LT((shapes[0].origin.translation() - Vec3(0, 1, 3)).norm(), 1e-15);
  ArmDescription untold = arm;
  untold.urdf.clear();
  EXPECT_TRUE(read_collisions(untold, dir / "x.urdf").empty()) << "an arm without a text";
}

}  // namespace
}  // namespace limpid
