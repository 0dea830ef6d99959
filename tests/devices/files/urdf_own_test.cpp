// Elements that Limpid reads beyond URDF.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/devices/files/test_files.h"
#include "tests/devices/files/urdf_pieces.h"

namespace limpid::test {
namespace {

using testing::HasSubstr;

const std::string kChain =
    link("a") + joint("a", "b") + link("b") + joint("b", "c", "prismatic") + link("c");

TEST(UrdfOwn, SaysNothingWhereThereIsNone) {
  const ArmDescription arm = parse(kChain);
  EXPECT_EQ(arm.gravity, Vec3(0, 0, -9.81));
  EXPECT_FALSE(arm.delay);
  EXPECT_EQ(arm.joints[0].spring, 0);
}

TEST(UrdfOwn, HasGravityDelayAndSprings) {
  const ArmDescription arm =
      parse(kChain +
            "<limpid gravity='0 9.81 0' delay='0.002'><spring joint='a_b' stiffness='0.2' "
            "offset='-0.01'/><spring joint='b_c' stiffness='30' offset='2'/></limpid>");
  EXPECT_EQ(arm.gravity, Vec3(0, 9.81, 0));
  EXPECT_EQ(arm.delay, 0.002);
  EXPECT_EQ(arm.joints[0].spring, 0.2);
  EXPECT_EQ(arm.joints[0].offset, -0.01);
  // For a slide 10 cm stand for 1 rad of a joint: 30 N/m are 0.3 N m/rad, 2 N are 0.2 N m.
  EXPECT_DOUBLE_EQ(arm.joints[1].spring, 0.3);
  EXPECT_DOUBLE_EQ(arm.joints[1].offset, 0.2);
}

TEST(UrdfOwn, RefusesWhatIsNoNumberOrOutOfRangeAndSaysWhere) {
  const auto said = [](const std::string& own) { return refusal([&] { parse(kChain + own); }); };
  EXPECT_THAT(said("<limpid gravity='0 0'/>"), HasSubstr("x.urdf:"));
  EXPECT_THAT(said("<limpid gravity='0 0'/>"), HasSubstr("needed: X Y Z"));
  EXPECT_THAT(said("<limpid gravity='0 0 -98'/>"), HasSubstr("gravity"));
  EXPECT_THAT(said("<limpid gravity='0 0 nan'/>"), HasSubstr("gravity"));
  EXPECT_THAT(said("<limpid delay='-1'/>"), HasSubstr("allowed: 0 to 1 s"));
  EXPECT_THAT(said("<limpid delay='soon'/>"), HasSubstr("\"soon\""));
  EXPECT_THAT(said("<limpid><spring joint='x' stiffness='1'/></limpid>"),
              HasSubstr("a joint of this robot"));
  EXPECT_THAT(said("<limpid><spring stiffness='1'/></limpid>"), HasSubstr("<spring>"));
  EXPECT_THAT(said("<limpid><spring joint='a_b' stiffness='1e9'/></limpid>"),
              HasSubstr("stiffness"));
}

}  // namespace
}  // namespace limpid::test
