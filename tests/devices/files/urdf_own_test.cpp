// Elements that Limpid reads beyond URDF.
#include <fmt/format.h>
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

TEST(UrdfOwn, WarnsOfWhatItDoesNotKnow) {
  const ArmDescription arm = parse(
      kChain +
      "<limpid dealy='0.002'><sprnig joint='a_b'/><spring joint='a_b' stifness='2'/></limpid>");
  EXPECT_FALSE(arm.delay);
  const auto says = [](const char* what) { return testing::Contains(HasSubstr(what)); };
  EXPECT_THAT(arm.warnings, says("<limpid> has the attribute 'dealy'"));
  EXPECT_THAT(arm.warnings, says("<limpid> has the element 'sprnig'"));
  EXPECT_THAT(arm.warnings, says("<spring> has the attribute 'stifness'"));
  EXPECT_THAT(parse(kChain + "<limpid tip='c' gravity='0 0 -9' delay='0'/>").warnings,
              testing::Not(says("does not know")));
}

TEST(UrdfOwn, HasTheTorqueThatMotorsBearForHours) {
  const ArmDescription plain = parse(kChain);
  EXPECT_EQ(plain.joints[0].continuous, 0);
  const double effort = plain.joints[0].effort, force = plain.joints[1].effort / 0.1;
  const ArmDescription arm =
      parse(kChain + "<limpid><warmth joint='a_b' continuous='" + std::to_string(effort / 4) +
            "' time='60'/><warmth joint='b_c' continuous='" + std::to_string(force / 2) +
            "' time='0.5'/></limpid>");
  EXPECT_NEAR(arm.joints[0].continuous, effort / 4, 1e-6);
  EXPECT_EQ(arm.joints[0].warming, 60);
  // 10 N of a slide are 1 N m.
  EXPECT_NEAR(arm.joints[1].continuous, 0.1 * force / 2, 1e-6);
  EXPECT_EQ(arm.joints[1].warming, 0.5);
}

TEST(UrdfOwn, HasTheStepAndTheDelayOfItsDevicesReadings) {
  const std::string kReadings = "<limpid><readings step='4e-4' delay='0.001'/></limpid>";
  const ArmDescription arm = parse(kChain + kReadings);
  EXPECT_EQ(arm.encoder_step, 4e-4);
  EXPECT_EQ(arm.assumed_delay, 0.001);
  EXPECT_FALSE(arm.delay) << "nobody identified it";
  EXPECT_EQ(parse(kChain).encoder_step, 0);
  // 4e-4 m of a slide are 4e-3 rad.
  const std::string slide = link("a") + joint("a", "b", "prismatic") + link("b");
  EXPECT_DOUBLE_EQ(parse(slide + kReadings).encoder_step, 4e-3);
  const auto said = [](const std::string& readings) {
    return refusal([&] { parse(kChain + "<limpid>\n<readings " + readings + "/></limpid>"); });
  };
  EXPECT_THAT(said("step='0.2'"),
              HasSubstr("x.urdf:8: <readings> step \"0.2\"; allowed: 0 to 0.1"));
  EXPECT_THAT(said("delay='-1'"), HasSubstr("allowed: 0 to 1 s"));
}

TEST(UrdfOwn, RefusesWarmthThatNoMotorHas) {
  const auto said = [](const std::string& warmth) {
    return refusal([&] { parse(kChain + "<limpid>\n<warmth " + warmth + "/></limpid>"); });
  };
  const ArmDescription arm = parse(kChain);
  const std::string good = std::to_string(arm.joints[0].effort / 2);
  EXPECT_THAT(said("joint='a_b' continuous='-1' time='60'"), HasSubstr("allowed: "));
  EXPECT_THAT(said("joint='a_b' continuous='0' time='60'"), HasSubstr("continuous \"0\""));
  std::string weak = kChain;
  weak.replace(weak.find("effort='2'"), 10, "effort='0.45'");
  const std::string range = refusal(
      [&] { parse(weak + "<limpid><warmth joint='a_b' continuous='9' time='60'/></limpid>"); });
  EXPECT_THAT(range, HasSubstr("allowed: 0.00045 to 0.45 N m"));
  EXPECT_THAT(said("joint='a_b' continuous='1e6' time='60'"),
              HasSubstr(fmt::format("to {} N m", arm.joints[0].effort)));
  EXPECT_THAT(said("joint='b_c' continuous='1e6' time='60'"),
              HasSubstr(fmt::format("to {} N", arm.joints[1].effort / 0.1)));
  EXPECT_THAT(said("joint='a_b' continuous='nan' time='60'"), HasSubstr("continuous"));
  EXPECT_THAT(said("joint='a_b' continuous='" + good + "' time='0'"),
              HasSubstr("time \"0\"; allowed: 0.1 to 100000 s"));
  EXPECT_THAT(said("joint='a_b' continuous='" + good + "'"), HasSubstr("needed: both"));
  EXPECT_THAT(said("joint='a_b' time='60'"), HasSubstr("needed: both"));
  EXPECT_THAT(said("joint='x' continuous='1' time='60'"), HasSubstr("a joint of this robot"));
  EXPECT_THAT(said("continuous='1' time='60'"), HasSubstr("x.urdf:8: <warmth>"));
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
