// Arms in larger trees, with grippers, brackets and other arms, and left out numbers.
#include <fmt/format.h>

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
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string range_limit(double lower, double upper) {
  return fmt::format("<limit lower='{}' upper='{}' effort='2' velocity='1'/>", lower, upper);
}
const std::string kBall =
    "<inertial><mass value='2'/><inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/>"
    "</inertial>";

std::vector<std::string> joints_of(const ArmDescription& arm) {
  std::vector<std::string> names;
  for (const Joint& each : arm.joints) names.push_back(each.name);
  return names;
}

// A hand that turns, with two fingers that slide, limited to 0.01 m and more.
std::string hand_with_fingers(const std::string& second) {
  return link("a") + joint("a", "b", "revolute", kLimit + at("0 0 1") + "<axis xyz='0 0 1'/>") +
         link("b") + joint("b", "hand", "fixed", at("1 0 0")) + link("hand", kBall) +
         joint("hand", "left", "prismatic", "<axis xyz='0 1 0'/>" + range_limit(0.01, 0.04)) +
         link("left", kBall) + joint("hand", "right", "prismatic", second) + link("right", kBall);
}

TEST(UrdfTree, HoldsGrippersStillAtTheLimitNextToZero) {
  const std::string opposite = "<axis xyz='0 -1 0'/>" + range_limit(0.01, 0.04);
  for (const std::string& second :
       {opposite, opposite + "<mimic joint='hand_left' multiplier='1'/>"}) {
    const ArmDescription arm = parse(hand_with_fingers(second));
    EXPECT_THAT(joints_of(arm), ElementsAre("a_b"));
    EXPECT_EQ(arm.tip_link, "hand");
    EXPECT_LT((arm.tip.translation() - Vec3(1, 0, 0)).norm(), 1e-15);
    // 1 kg at the joint, 2 kg at the hand, 2 kg each 1 cm beside it.
    EXPECT_NEAR(arm.links[0].mass, 7, 1e-12);
    EXPECT_LT((arm.links[0].com - Vec3(6.0 / 7, 0, 0)).norm(), 1e-12);
    const double about_joint =
        arm.links[0].inertia(2, 2) + 7 * arm.links[0].com.squaredNorm();  // about z
    EXPECT_NEAR(about_joint, 1 + 0.3 + 2 + 4 * (1 + 1e-4), 1e-12);
    ASSERT_EQ(arm.warnings.size(), 1u);
    EXPECT_THAT(arm.warnings[0], testing::AllOf(HasSubstr("held still"), HasSubstr("hand_left"),
                                                HasSubstr("hand_right")));
  }
}

TEST(UrdfTree, TakesASlideAtTheEndOfTheChainForAJoint) {
  const ArmDescription arm = parse(link("a") + joint("a", "b") + link("b") +
                                   joint("b", "c", "prismatic",
                                         "<axis xyz='0 0 -1'/>" + range_limit(-0.05, 0.2) +
                                             "<dynamics damping='3' friction='1'/>") +
                                   link("c"));
  ASSERT_THAT(joints_of(arm), ElementsAre("a_b", "b_c"));
  EXPECT_TRUE(arm.warnings.empty());
  // Units of (5): 1 unit of travel is 0.1 m, power is kept.
  const Joint& slide = arm.joints[1];
  EXPECT_EQ(slide.kind, Joint::Kind::prismatic);
  EXPECT_NEAR(slide.lower, -0.5, 1e-15);
  EXPECT_NEAR(slide.upper, 2, 1e-15);
  EXPECT_NEAR(slide.effort, 2 * 0.1, 1e-15);
  EXPECT_NEAR(slide.friction, 1 * 0.1, 1e-15);
  EXPECT_NEAR(slide.damping, 3 * 0.1 * 0.1, 1e-15);
}

TEST(UrdfTree, GoesToTheTipThatIsNamedAndHoldsTheOtherBranchStill) {
  const std::string two_arms = link("base") + joint("base", "l1") + link("l1") +
                               joint("l1", "l2", "revolute", kLimit + at("1 0 0")) + link("l2") +
                               joint("base", "r1") + link("r1") + joint("r1", "r2") + link("r2") +
                               joint("r2", "r3") + link("r3");
  EXPECT_THAT(refusal([&] { parse(two_arms); }),
              testing::AllOf(HasSubstr("'l2'"), HasSubstr("'r3'"), HasSubstr("--tip")));
  EXPECT_THAT(joints_of(parse(two_arms, "l2")), ElementsAre("base_l1", "l1_l2"));
  EXPECT_THAT(joints_of(parse(two_arms, "r2")), ElementsAre("base_r1", "r1_r2"));
  // The last joint carries r3 along.
  EXPECT_NEAR(parse(two_arms, "r2").links[1].mass, 2, 1e-15);
  EXPECT_THAT(refusal([&] { parse(two_arms, "r9"); }),
              testing::AllOf(HasSubstr("'r9'"), HasSubstr("l2, r3")));
  EXPECT_THAT(refusal([&] { parse(two_arms, "base"); }), HasSubstr("no joint moves this link"));
}

TEST(UrdfTree, NamesTheEndsToChooseFrom) {
  const std::string hand =
      link("base") + joint("base", "l1") + link("l1") + joint("base", "r1") + link("r1") +
      joint("r1", "palm") + link("palm") + joint("palm", "thumb") + link("thumb") +
      joint("thumb", "nail", "fixed") + link("nail", "") + joint("palm", "finger") +
      link("finger") + joint("palm", "light", "fixed") + link("light", "");
  std::vector<ArmTip> tips;
  try {
    parse(hand);
    FAIL() << "two arms";
  } catch (const TipsToChoose& choice) {
    tips = choice.tips;
  }
  EXPECT_THAT(tips, testing::UnorderedElementsAre(ArmTip{"nail", 3}, ArmTip{"finger", 3},
                                                  ArmTip{"palm", 2}, ArmTip{"l1", 1}));
  EXPECT_TRUE(std::ranges::is_sorted(tips, std::ranges::greater{}, &ArmTip::joints));
  for (const ArmTip& tip : tips) {
    const ArmDescription arm = parse(hand, tip.link);
    EXPECT_EQ(arm.dof(), tip.joints) << tip.link;
    EXPECT_EQ(arm.tip_link, tip.link);
  }
}

TEST(UrdfTree, TellsItsTextWhichTipWasNamed) {
  const std::string tool = link("a") + joint("a", "b") + link("b") + joint("b", "c") + link("c");
  const ArmDescription arm = parse(tool, "b");
  ASSERT_EQ(arm.dof(), 1);
  const ArmDescription again = parse_urdf(arm.urdf, "session", "");
  EXPECT_EQ(again.dof(), 1);
  EXPECT_EQ(again.tip_link, "b");
  EXPECT_EQ(parse_urdf(arm.urdf, "session", "", "c").dof(), 2);
  EXPECT_EQ(parse_urdf(parse_urdf(arm.urdf, "x", "", "c").urdf, "session", "").dof(), 2);
  EXPECT_EQ(parse(tool).urdf, test::robot(tool)) << "without a name it is as it was";
}

TEST(UrdfTree, TakesTheToolFarthestOutForTheTip) {
  const ArmDescription arm =
      parse(link("a") + joint("a", "b") + link("b") + joint("b", "camera", "fixed", at("0.1 0 0")) +
            link("camera", "") + joint("b", "flange", "fixed", at("0 0 0.2")) + link("flange", "") +
            joint("flange", "tool0", "fixed", at("0 0 0.1")) + link("tool0", ""));
  EXPECT_EQ(arm.tip_link, "tool0");
  EXPECT_LT((arm.tip.translation() - Vec3(0, 0, 0.3)).norm(), 1e-15);
  EXPECT_TRUE(arm.warnings.empty());
}

TEST(UrdfTree, PassesByWhatMovesWithoutAMass) {
  const std::string arm = link("a") + joint("a", "b") + link("b") + joint("b", "c") + link("c");
  const ArmDescription beside = parse(arm + joint("a", "dial") + link("dial", ""));
  EXPECT_THAT(joints_of(beside), ElementsAre("a_b", "b_c"));
  const ArmDescription fingers =
      parse(arm + joint("c", "left") + link("left", "") + joint("c", "right") + link("right", ""));
  EXPECT_THAT(joints_of(fingers), ElementsAre("a_b", "b_c"));
}

// A frame without mass between two joints, as in wrists: M would not be positive definite where the
// two axes coincide.
TEST(UrdfTree, GivesAFrameWithoutInertiaAThousandthOfWhatHangsOnIt) {
  const ArmDescription arm =
      parse(link("a") + joint("a", "b") + link("b", "") +
            joint("b", "c", "revolute", kLimit + at("0 0 0")) + link("c", kBall) +
            joint("c", "hand", "fixed", at("0 0 0.1")) + link("hand", ""));
  EXPECT_NEAR(arm.links[0].inertia(2, 2), 1e-4, 1e-18);
  EXPECT_EQ(arm.links[0].mass, 0);
  ASSERT_EQ(arm.warnings.size(), 1u);
  EXPECT_THAT(arm.warnings[0], testing::AllOf(HasSubstr("'b'"), HasSubstr("<inertial>")));
  // A slide needs mass: it gets a thousandth as well.
  const ArmDescription slide = parse(link("a") + joint("a", "b", "prismatic") + link("b", "") +
                                     joint("b", "c") + link("c", kBall));
  EXPECT_NEAR(slide.links[0].mass, 2e-3, 1e-18);
}

TEST(UrdfTree, TakesAnEffortOfZeroForNotSaid) {
  const std::string none = "<limit lower='-1' upper='1' effort='0' velocity='1'/>";
  const ArmDescription arm =
      parse(link("a") + joint("a", "b", "revolute", none) + link("b") +
            joint("b", "c", "revolute", none + at("0.3 0.4 0")) + link("c", kBall) +
            joint("c", "d", "continuous", at("0 0 0.2")) + link("d"));
  ASSERT_EQ(arm.dof(), 3);
  // Stretched out: 2 kg at 0.5 m, 1 kg at 0.7 m from the first joint.
  EXPECT_NEAR(arm.joints[0].effort, 2 * 9.81 * (2 * 0.5 + 1 * 0.7), 1e-12);
  EXPECT_NEAR(arm.joints[1].effort, 2 * 9.81 * (1 * 0.2), 1e-12);
  EXPECT_GT(arm.joints[2].effort, 0);
  ASSERT_EQ(arm.warnings.size(), 1u);
  for (const char* name : {"a_b", "b_c", "c_d"}) EXPECT_THAT(arm.warnings[0], HasSubstr(name));
}

TEST(UrdfTree, TakesLimitsOfNothingButZerosForNone) {
  const std::string zeros = "<limit lower='0' upper='0.0' effort='0' velocity='0'/>";
  const ArmDescription arm = parse(link("a") + joint("a", "b", "revolute", zeros) + link("b") +
                                   joint("b", "hand", "fixed", at("0 0.1 0")) + link("hand", ""));
  EXPECT_EQ(arm.joints.at(0).lower, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(arm.warnings.size(), 2u) << "limits, and effort";
}

TEST(UrdfTree, HoldsAJointWithoutRoomStillWhereItIs) {
  const ArmDescription arm =
      parse(link("a") + joint("a", "b") + link("b") +
            joint("b", "c", "revolute",
                  "<axis xyz='0 0 1'/>" + at("1 0 0") +
                      range_limit(1.5707963267948966, 1.5707963267948966)) +
            link("c") + joint("c", "d", "revolute", kLimit + at("1 0 0")) + link("d"));
  ASSERT_THAT(joints_of(arm), ElementsAre("a_b", "c_d"));
  EXPECT_LT((arm.joints[1].origin.translation() - Vec3(1, 1, 0)).norm(), 1e-12);
}

TEST(UrdfTree, ReadsJointsWhoseLimitAndDynamicsAreHalfThere) {
  const ArmDescription arm = parse(
      link("a") +
      joint("a", "b", "revolute",
            "<limit lower='-1' upper='1'/><dynamics friction='0.5'/><safety_controller k='no'/>"
            "<calibration rising='x'/>") +
      link("b") + "<transmission name='t'/><gazebo reference='b'><mu>1</mu></gazebo>");
  EXPECT_EQ(arm.joints.at(0).upper, 1);
  EXPECT_EQ(arm.joints[0].friction, 0.5);
  EXPECT_THAT(joints_of(arm), ElementsAre("a_b"));
}

TEST(UrdfTree, RefusesTreesTooDeepToFollow) {
  std::string chain = link("l0");
  for (int i = 0; i < 2000; ++i) {
    const std::string from = "l" + std::to_string(i), to = "l" + std::to_string(i + 1);
    chain += joint(from, to, "fixed", "") + link(to, "");
  }
  EXPECT_THAT(refusal([&] { parse(chain); }), HasSubstr("too many links"));
}

// The finger's axis is given in its joint's turned frame: x there points down.
TEST(UrdfTree, HoldsASlideStillAlongItsOwnAxis) {
  const ArmDescription arm =
      parse(link("a") + joint("a", "b", "revolute", kLimit + at("0 0 1")) + link("b") +
                joint("b", "hand", "fixed", at("1 0 0")) + link("hand", kBall) +
                joint("hand", "left", "prismatic",
                      "<origin xyz='0 0.5 0' rpy='0 1.5707963267948966 0'/><axis xyz='1 0 0'/>" +
                          range_limit(0.25, 0.5)) +
                link("left", kBall),
            "hand");
  EXPECT_THAT(joints_of(arm), ElementsAre("a_b"));
  // 1 kg at the joint, 2 kg at (1, 0, 0), 2 kg at (1, 0.5, -0.25).
  EXPECT_NEAR(arm.links[0].mass, 5, 1e-12);
  EXPECT_LT((5 * arm.links[0].com - Vec3(4, 1, -0.5)).norm(), 1e-12)
      << 5 * arm.links[0].com.transpose();
}

}  // namespace
}  // namespace limpid
