// Arms that are described in full but do not move, or only in part.
#include "tests/devices/files/test_files.h"
#include "tests/devices/files/urdf_pieces.h"

namespace limpid {
namespace {

using test::at;
using test::joint;
using test::kInertial;
using test::kLimit;
using test::link;
using test::parse;
using test::refusal;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::string limit(const std::string& range, const std::string& effort) {
  return "<limit " + range + " effort='" + effort + "' velocity='1'/>";
}
// A link fixed a metre beside the axis x, the default of joints.
std::string hand(const std::string& on) {
  return joint(on, "hand", "fixed", at("0 1 0")) + link("hand", "");
}

TEST(UrdfMotion, EndsTheChainAtTheLastLinkThatHasMass) {
  const std::string box = "<visual><geometry><box size='1 1 1'/></geometry></visual>";
  const ArmDescription arm = parse(
      link("a") + joint("a", "b") + link("b") +
      joint("b", "c", "revolute",
            "<limit lower='0.5' upper='1' effort='2' velocity='1'/>" + at("0 0 2") +
                "<axis xyz='0 0 1'/>") +
      link("c", box) + joint("c", "d", "prismatic", "<axis xyz='1 0 0'/>" + std::string(kLimit)) +
      link("d", "") + joint("d", "tool", "fixed", at("3 0 0")) + link("tool", ""));
  ASSERT_EQ(arm.dof(), 1);
  EXPECT_EQ(arm.joints[0].name, "a_b");
  EXPECT_EQ(arm.tip_link, "tool") << "the tip stays the tip";
  // b_c is held at 0.5 rad, the limit nearest to 0; c_d at 0.
  const Vec3 there(3 * std::cos(0.5), 3 * std::sin(0.5), 2);
  EXPECT_LT((arm.tip.translation() - there).norm(), 1e-15);
  const auto tool = std::ranges::find(arm.frames, "tool", &NamedFrame::name);
  ASSERT_NE(tool, arm.frames.end());
  EXPECT_EQ(tool->link, 0);
  EXPECT_LT((tool->origin.translation() - there).norm(), 1e-15);
  ASSERT_EQ(arm.visuals.size(), 1u);
  EXPECT_EQ(arm.visuals[0].link, 0);
  EXPECT_LT((arm.visuals[0].origin * Vec3(1, 0, 0) - Vec3(std::cos(0.5), std::sin(0.5), 2)).norm(),
            1e-15);
  ASSERT_EQ(arm.warnings.size(), 1u);
  EXPECT_THAT(arm.warnings[0],
              AllOf(HasSubstr("x.urdf"), HasSubstr("'c', 'd'"), HasSubstr("'b_c', 'c_d'"),
                    HasSubstr("'a_b'"), HasSubstr("<inertial>")));
  EXPECT_EQ(parse_urdf(arm.urdf, "session", "").dof(), 1) << "its text gives the same arm";
}

// A mass without inertia on the axis of the last joint resists no motion, but has weight.
TEST(UrdfMotion, KeepsTheMassThatTheEndCarries) {
  const ArmDescription arm = parse(
      link("a") + joint("a", "b") + link("b") + joint("b", "c", "revolute", kLimit + at("0 1 0")) +
      link("c",
           "<inertial><mass value='3'/><inertia ixx='0' ixy='0' ixz='0' iyy='0' iyz='0' "
           "izz='0'/></inertial>"));
  ASSERT_EQ(arm.dof(), 1);
  EXPECT_NEAR(arm.links[0].mass, 4, 1e-15);
  EXPECT_LT((arm.links[0].com - Vec3(0, 0.75, 0)).norm(), 1e-15);
}

TEST(UrdfMotion, StillRefusesArmsWithoutAnyMass) {
  const std::string none =
      link("a") + joint("a", "b") + link("b", "") + joint("b", "c") + link("c", "");
  EXPECT_THAT(refusal([&] { parse(none); }), AllOf(HasSubstr("x.urdf"), HasSubstr("<inertial>")));
}

TEST(UrdfMotion, SaysWhichMotorsAreTooWeakForTheirFriction) {
  const auto arm = [](const std::string& friction, const std::string& kind) {
    return parse(link("a") +
                 joint("a", "b", kind,
                       limit("lower='-1' upper='1'", "2") + "<dynamics friction='" + friction +
                           "'/>") +
                 link("b") + hand("b"))
        .warnings;
  };
  EXPECT_THAT(arm("1.9", "revolute"), IsEmpty());
  EXPECT_THAT(
      arm("5", "revolute"),
      ElementsAre(AllOf(HasSubstr("x.urdf:3"), HasSubstr("'a_b'"), HasSubstr("friction 5 N m"),
                        HasSubstr("effort 2 N m"), HasSubstr("<dynamics>"))));
  EXPECT_THAT(arm("1.9", "prismatic"), IsEmpty());
  EXPECT_THAT(arm("5", "prismatic"),
              ElementsAre(AllOf(HasSubstr("friction 5 N,"), HasSubstr("effort 2 N:"))));
}

TEST(UrdfMotion, SaysWhichJointsHaveHardlyAnyRoom) {
  const auto arm = [](const std::string& range) {
    return parse(link("a") + joint("a", "b", "revolute", limit(range, "2")) + link("b") +
                 joint("b", "c") + link("c") + hand("c"))
        .warnings;
  };
  EXPECT_THAT(arm("lower='0.1' upper='0.15'"), IsEmpty());
  EXPECT_THAT(arm("lower='0.1' upper='0.10001'"),
              ElementsAre(AllOf(HasSubstr("'a_b'"), HasSubstr("0.1 to 0.10001 rad"),
                                HasSubstr("<limit>"))));
}

TEST(UrdfMotion, HoldsSlidesWithoutLimitsStill) {
  const ArmDescription arm = parse(link("a") + joint("a", "b", "prismatic", at("0 0 2")) +
                                   link("b") + joint("b", "c") + link("c") + hand("c"));
  ASSERT_EQ(arm.dof(), 1);
  EXPECT_EQ(arm.joints[0].name, "b_c");
  EXPECT_EQ(arm.joints[0].origin.translation(), Vec3(0, 0, 2));
  EXPECT_THAT(arm.warnings, ElementsAre(AllOf(HasSubstr("a_b"), HasSubstr("<limit>"))));
}

TEST(UrdfMotion, RefusesArmsWhoseLimitsLeaveNoRoomAtAll) {
  const std::string still =
      link("a") + joint("a", "b", "revolute", limit("lower='1' upper='1'", "2")) + link("b");
  EXPECT_THAT(
      refusal([&] { parse(still); }),
      AllOf(HasSubstr("x.urdf"), HasSubstr("no joint moves"), HasSubstr("lower below upper")));
}

TEST(UrdfMotion, AsksForATipWhereOnlyAGripperMoves) {
  const std::string gripper = link("hand") + joint("hand", "left", "prismatic") + link("left") +
                              joint("hand", "right", "prismatic") + link("right");
  EXPECT_THAT(refusal([&] { parse(gripper); }), AllOf(HasSubstr("--tip"), HasSubstr("'left'")));
  EXPECT_EQ(parse(gripper, "left").dof(), 1);
}

// The square of such a length overflows.
TEST(UrdfMotion, TakesAnAxisOfAnyLengthThatIsOne) {
  const auto axis_of = [](const std::string& xyz) {
    return parse(link("a") +
                 joint("a", "b", "revolute", std::string(kLimit) + "<axis xyz='" + xyz + "'/>") +
                 link("b") + joint("b", "end", "fixed", at("0.3 0 0")) + link("end", ""))
        .joints.at(0)
        .axis;
  };
  for (const char* xyz : {"0 0 1e308", "0 0 1.4e154", "0 0 3", "0 0 1e-8"}) {
    EXPECT_LT((axis_of(xyz) - Vec3::UnitZ()).norm(), 1e-12) << xyz;
  }
  EXPECT_LT((axis_of("0 3e200 4e200") - Vec3(0, 0.6, 0.8)).norm(), 1e-12);
  EXPECT_THROW(axis_of("0 0 0"), FileError);
}

TEST(UrdfMotion, SaysThatATipOnItsOnlyAxisCannotBeMoved) {
  const std::string shaft = link("a") + joint("a", "b") + link("b") +
                            joint("b", "end", "fixed", at("0.3 0 0")) + link("end", "");
  EXPECT_THAT(parse(shaft).warnings,
              ElementsAre(AllOf(HasSubstr("'end'"), HasSubstr("'a_b'"), HasSubstr("--tip"))));
  // Another joint about the same axis does not help; the error names a link beside it.
  const std::string two = shaft + joint("end", "c") + link("c") +
                          joint("c", "crank", "fixed", at("0 0.2 0")) + link("crank", "");
  EXPECT_THAT(parse(two, "c").warnings, ElementsAre(HasSubstr("'crank'")));
  EXPECT_THAT(parse(two, "crank").warnings, IsEmpty());
  // A slide moves its tip along its axis.
  EXPECT_THAT(parse(link("a") + joint("a", "b", "prismatic") + link("b")).warnings, IsEmpty());
  // The last joint of a wrist need not move the tip.
  const std::string wrist = link("a") + joint("a", "b") + link("b") +
                            joint("b", "c", "revolute", kLimit + at("0 1 0")) + link("c");
  EXPECT_THAT(parse(wrist).warnings, IsEmpty());
}

TEST(UrdfMotion, NamesAllTipsOfAnArmThatBranches) {
  std::string tree = link("base");
  for (const std::string finger : {"one", "two", "three", "four"}) {
    tree += joint("base", finger) + link(finger) + joint(finger, finger + "_tip") +
            link(finger + "_tip");
  }
  tree += joint("three_tip", "nail") + link("nail");
  const std::string said = refusal([&] { parse(tree); });
  EXPECT_THAT(said, AllOf(HasSubstr("--tip"), HasSubstr("'one_tip' (2)"),
                          HasSubstr("'two_tip' (2)"), HasSubstr("'four_tip' (2)")));
  EXPECT_LT(said.find("'nail' (3)"), said.find("'one_tip' (2)")) << "the longest first: " << said;
  EXPECT_EQ(said.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace limpid
