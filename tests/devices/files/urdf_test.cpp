#include <fmt/format.h>

#include <array>
#include <atomic>
#include <thread>

#include "devices/files/urdf_file.h"
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
using test::robot;
using testing::HasSubstr;

TEST(Urdf, ReadsEveryNumberOfAJoint) {
  const ArmDescription arm =
      parse(link("a") +
            joint("a", "b", "revolute",
                  "<origin xyz='1 2 3' rpy='0 0 1.5707963267948966'/><axis xyz='0 3 4'/>"
                  "<limit lower='-0.5' upper='1.5' effort='2' velocity='1'/>"
                  "<dynamics damping='0.1' friction='0.2'/>") +
            link("b"));
  ASSERT_EQ(arm.dof(), 1);
  const Joint& j = arm.joints[0];
  EXPECT_EQ(j.name, "a_b");
  EXPECT_EQ(j.lower, -0.5);
  EXPECT_EQ(j.upper, 1.5);
  EXPECT_EQ(j.effort, 2);
  EXPECT_EQ(j.damping, 0.1);
  EXPECT_EQ(j.friction, 0.2);
  EXPECT_LT((j.axis - Vec3(0, 0.6, 0.8)).norm(), 1e-15);
  EXPECT_LT((j.origin * Vec3(1, 0, 0) - Vec3(1, 3, 3)).norm(), 1e-15);
}

TEST(Urdf, TurnsRollPitchYawInThatOrderAboutFixedAxes) {
  const ArmDescription arm =
      parse(link("a") +
            joint("a", "b", "continuous",
                  "<origin rpy='0.3 -0.4 0.5'/><limit effort='1' velocity='1'/>") +
            link("b"));
  const Mat3 wanted =
      (Eigen::AngleAxisd(0.5, Vec3::UnitZ()) * Eigen::AngleAxisd(-0.4, Vec3::UnitY()) *
       Eigen::AngleAxisd(0.3, Vec3::UnitX()))
          .toRotationMatrix();
  EXPECT_LT((arm.joints[0].origin.linear() - wanted).norm(), 1e-15);
  EXPECT_EQ(arm.joints[0].upper, std::numeric_limits<double>::infinity());
}

// Two rods of mass m and length l, fixed end to end, are one rod of 2 m and 2 l.
TEST(Urdf, MergesLinksBehindFixedJoints) {
  const std::string rod =
      "<inertial><origin xyz='0.5 0 0'/><mass value='3'/>"
      "<inertia ixx='0' ixy='0' ixz='0' iyy='0.25' iyz='0' izz='0.25'/></inertial>";
  const ArmDescription arm = parse(
      link("world") + joint("world", "a", "fixed", "<origin xyz='0 0 7'/>") + link("a") +
      joint("a", "b", "revolute", std::string("<axis xyz='0 1 0'/>") + kLimit) + link("b", rod) +
      joint("b", "c", "fixed", "<origin xyz='1 0 0' rpy='0.7 0 0'/>") + link("c", rod) +
      joint("c", "d", "fixed", "<origin xyz='1 0 0' rpy='0 0 1'/>") + link("d", ""));
  ASSERT_EQ(arm.dof(), 1);
  EXPECT_LT((arm.joints[0].origin.translation() - Vec3(0, 0, 7)).norm(), 1e-15);
  EXPECT_NEAR(arm.links[0].mass, 6, 1e-15);
  EXPECT_LT((arm.links[0].com - Vec3(1, 0, 0)).norm(), 1e-15);
  const double about_com = 6 * 2 * 2 / 12.0;
  EXPECT_LT((arm.links[0].inertia - Mat3(Vec3(0, about_com, about_com).asDiagonal())).norm(),
            1e-14);
  EXPECT_LT((arm.tip.translation() - Vec3(2, 0, 0)).norm(), 1e-15);
  ASSERT_EQ(arm.frames.size(), 5u);
  EXPECT_EQ(arm.frames[1].name, "a");
  EXPECT_EQ(arm.frames[1].link, -1);
  EXPECT_EQ(arm.frames[3].name, "c");
  EXPECT_EQ(arm.frames[3].link, 0);
}

// A point mass m at r has the inertia m (r^2 1 - r r^T). Three of them, given in a frame tilted
// against the link's, must have the inertia about their own centre, turned and moved.
TEST(Urdf, TurnsAnInertiaThatIsGivenInAFrameAskew) {
  const std::array<double, 3> masses{0.2, 0.5, 0.3};
  const std::array<Vec3, 3> points{Vec3(0.3, -0.1, 0.2), Vec3(-0.2, 0.4, 0.1),
                                   Vec3(0.1, 0.2, -0.5)};
  const auto inertia_of = [&](const std::array<Vec3, 3>& at, const Vec3& about) {
    Mat3 sum = Mat3::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 r = at[i] - about;
      sum += masses[i] * (r.dot(r) * Mat3::Identity() - r * r.transpose());
    }
    return sum;
  };
  const auto centre_of = [&](const std::array<Vec3, 3>& at) {
    return Vec3(0.2 * at[0] + 0.5 * at[1] + 0.3 * at[2]);
  };
  const Vec3 centre = centre_of(points);
  const Mat3 own = inertia_of(points, centre);
  const std::string inertial = fmt::format(
      "<inertial><origin xyz='0.1 0.2 0.3' rpy='0.4 -0.7 1.1'/><mass value='1'/>"
      "<inertia ixx='{:.17g}' ixy='{:.17g}' ixz='{:.17g}' iyy='{:.17g}' iyz='{:.17g}' "
      "izz='{:.17g}'/></inertial>",
      own(0, 0), own(0, 1), own(0, 2), own(1, 1), own(1, 2), own(2, 2));
  const ArmDescription arm = parse(link("a") + joint("a", "b") + link("b", inertial));
  Pose placed = Pose::Identity();
  placed.translation() = Vec3(0.1, 0.2, 0.3);
  placed.linear() = (Eigen::AngleAxisd(1.1, Vec3::UnitZ()) *
                     Eigen::AngleAxisd(-0.7, Vec3::UnitY()) * Eigen::AngleAxisd(0.4, Vec3::UnitX()))
                        .toRotationMatrix();
  std::array<Vec3, 3> there;
  for (std::size_t i = 0; i < 3; ++i) there[i] = placed * Vec3(points[i] - centre);
  EXPECT_NEAR(arm.links[0].mass, 1, 1e-15);
  EXPECT_LT((arm.links[0].com - centre_of(there)).norm(), 1e-15);
  EXPECT_LT((arm.links[0].inertia - inertia_of(there, centre_of(there))).norm(), 1e-15);
}

TEST(Urdf, RefusesWhatIsNoArm) {
  struct Case {
    std::string inside;
    std::vector<std::string> said;
  };
  const std::string two = link("a") + link("b");
  std::string long_chain = link("l0");
  for (int i = 0; i < 33; ++i) {
    const std::string from = "l" + std::to_string(i);
    const std::string to = "l" + std::to_string(i + 1);
    long_chain += joint(from, to) + link(to);
  }
  const Case cases[] = {
      {"", {"x.urdf"}},
      {link("a"), {"x.urdf", "no joint"}},
      {two + joint("a", "b", "fixed", ""), {"x.urdf", "no joint"}},
      {two + joint("a", "b", "floating", ""), {"x.urdf:4", "a_b", "revolute"}},
      {two + joint("a", "b", "wobbly", ""), {"x.urdf", "wobbly"}},
      {two + link("c") + joint("a", "b") + joint("a", "c"),
       {"x.urdf:2", "'a'", "'b'", "'c'", "--tip"}},
      {two + link("c") + joint("a", "b") +
           "<joint name='again' type='fixed'><parent link='c'/><child link='b'/></joint>" +
           joint("a", "c"),
       {"'b'", "two joints"}},
      {two + link("c") + joint("a", "b"), {"x.urdf", "root"}},
      {two + joint("a", "b") + joint("b", "a"), {"x.urdf"}},
      {two + joint("a", "nobody"), {"x.urdf", "nobody"}},
      {two + joint("a", "b", "revolute", ""), {"x.urdf", "a_b", "limits"}},
      {two + joint("a", "b", "revolute", std::string("<axis xyz='0 0 0'/>") + kLimit),
       {"x.urdf:4", "a_b", "axis"}},
      {two + joint("a", "b", "revolute", std::string("<axis xyz='0 nan 0'/>") + kLimit),
       {"x.urdf"}},
      {two + joint("a", "b", "revolute", std::string("<axis xyz='0 1'/>") + kLimit), {"x.urdf"}},
      {two + joint("a", "b", "revolute", std::string("<origin xyz='0 inf 0'/>") + kLimit),
       {"x.urdf"}},
      {two + joint("a", "b", "revolute", at("1e300 1e300 0") + kLimit),
       {"x.urdf:4", "a_b", "origin xyz \"1e+300 1e+300 0\"; allowed: -1000000 to 1000000 m"}},
      {two + joint("a", "b") + joint("b", "c", "fixed", at("0 -1e7 0")) + link("c", ""),
       {"x.urdf:5", "b_c", "origin xyz \"0 -10000000 0\"; allowed"}},
      {two + joint("a", "b", "revolute", "<limit lower='1' upper='-1' effort='1' velocity='1'/>"),
       {"x.urdf:4", "a_b", "limits from 1 to -1"}},
      {two + joint("a", "b", "revolute", "<limit lower='-1' upper='1' effort='-2' velocity='1'/>"),
       {"x.urdf:4", "a_b", "effort -2"}},
      {two + joint("a", "b", "revolute", std::string("<dynamics damping='-1'/>") + kLimit),
       {"x.urdf:4", "a_b", "damping -1"}},
      {two + joint("a", "b", "revolute", std::string("<dynamics friction='-1'/>") + kLimit),
       {"x.urdf:4", "a_b", "friction -1"}},
      {link("a") + joint("a", "b") + link("b", ""), {"x.urdf", "<inertial>"}},
      {link("a") + joint("a", "b") + link("b", "") + joint("b", "c") + link("c", ""),
       {"x.urdf", "<inertial>"}},
      {two + link("c") + joint("a", "b", "revolute", std::string(kLimit) + "<mimic joint='b_c'/>") +
           joint("b", "c"),
       {"a_b", "mimics", "--tip"}},
      {link("a") + joint("a", "b") +
           link("b",
                "<inertial><mass value='-1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' "
                "iyz='0' izz='1'/></inertial>"),
       {"x.urdf:4", "'b'", "mass -1"}},
      {link("a") + joint("a", "b") +
           link("b", "<inertial>" + at("1e160 0 0") +
                         "<mass value='1'/><inertia ixx='1' ixy='0' "
                         "ixz='0' iyy='1' iyz='0' izz='1'/></inertial>"),
       {"x.urdf:4", "'b'", "inertial: origin xyz \"1e+160 0 0\"; allowed"}},
      {link("a") + joint("a", "b") +
           link("b",
                "<inertial><mass value='1e308'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' "
                "iyz='0' izz='1'/></inertial>"),
       {"x.urdf:4", "'b'", "mass 1e+308 kg; allowed: 0 to 1000000 kg"}},
      {link("a") + joint("a", "b") +
           link("b",
                "<inertial><mass value='1'/><inertia ixx='1' ixy='2' ixz='0' iyy='1' "
                "iyz='0' izz='1'/></inertial>"),
       {"x.urdf:4", "'b'", "negative moment"}},
      {link("a") + joint("a", "b") + link("b", "<inertial><mass value='1'/></inertial>"),
       {"x.urdf"}},
      {long_chain, {"x.urdf", "l32_l33", "at most 32"}},
      {two + two, {"x.urdf", "unique"}},
  };
  for (const Case& c : cases) {
    testing::internal::CaptureStderr();
    const std::string said = refusal([&] { parse(c.inside); });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << c.inside;
    for (const std::string& part : c.said) EXPECT_THAT(said, HasSubstr(part)) << c.inside;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  }
}

TEST(Urdf, RefusesWhatIsNotXml) {
  const auto said = [](const std::string& text) {
    return refusal([&] { parse_urdf(text, "x.urdf", ""); });
  };
  EXPECT_THAT(said(""), HasSubstr("x.urdf"));
  EXPECT_THAT(said("hello"), HasSubstr("x.urdf:1"));
  EXPECT_THAT(said("<robot>\n<link name=>\n</robot>"), HasSubstr("x.urdf:3"));
  EXPECT_THAT(said("<sdf/>"), HasSubstr("<robot>"));
  EXPECT_THAT(said("<robot>\n<link name='a'>"), HasSubstr("x.urdf:"));
  std::string deep;
  for (int i = 0; i < 1000000; ++i) deep += "<a>";
  EXPECT_THAT(said(deep), HasSubstr("nested"));
  EXPECT_THAT(refusal([] { read_urdf("/nowhere.urdf"); }), HasSubstr("/nowhere.urdf"));
}

std::string often(int times, const std::string& text) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

// The parser recurses into each element, so every opened element must be counted as the parser sees
// it.
TEST(Urdf, RefusesNestingThatIsHiddenInQuotesCommentsAndOtherEncodings) {
  const auto said = [](const std::string& text) {
    return refusal([&] { parse_urdf(text, "x.urdf", ""); });
  };
  constexpr int kMany = 60000;
  EXPECT_THAT(said(often(kMany, "<a b=\"/>\">")), HasSubstr("nested"));
  EXPECT_THAT(said(often(kMany, "<a b='/>'>")), HasSubstr("nested"));
  EXPECT_THAT(said(often(kMany, "<a b='\"/>'>")), HasSubstr("nested"));
  EXPECT_THAT(said("<!--><a>--><!-- -->" + often(kMany, "<a>")), HasSubstr("nested"));
  EXPECT_THAT(said("<r><![CDATA[<!--]]>" + often(kMany, "<a>")), HasSubstr("nested"));
  EXPECT_THAT(said(often(kMany, "</a>") + often(kMany, "<a>")), HasSubstr("nested"));
  EXPECT_THAT(said("<!DOCTYPE a '<!--'>" + often(kMany, "<a>")), HasSubstr("nested"));
  // The parser does not end this declaration at '>' in quotes, so the comment is none.
  EXPECT_THAT(said("<?xml version='><!--' ?>" + often(kMany, "<a>")), HasSubstr("x.urdf:1"));
  // Read as UTF-8, the value's first byte would swallow the quote behind it.
  EXPECT_THAT(said("<?xml encoding='UTF-8'?><r a='\xF0' b='>" + often(kMany, "<a>") + "'"),
              HasSubstr("x.urdf"));
  std::string wide;
  for (const char c : often(kMany, "<a>")) wide += {c, '\0'};
  EXPECT_THAT(said("\xFF\xFE" + wide), HasSubstr("nested"));
}

TEST(Urdf, ReadsElementsSideBySideAndWhatOnlyLooksNested) {
  const std::string beside = often(3000, "<a b='<c>' d=\"'>\"/><e></e><!-- <f> --><g h='/'></g>");
  EXPECT_EQ(parse(beside + link("a") + joint("a", "b") + link("b")).dof(), 1);
}

TEST(Urdf, RefusesTextsThatTakeForEver) {
  const auto said = [](const std::string& text) {
    return refusal([&] { parse_urdf(text, "x.urdf", ""); });
  };
  std::string attributes = "<robot name='r'";
  for (int i = 0; i < 2000; ++i) attributes += fmt::format(" a{}=''", i);
  EXPECT_THAT(said(attributes + "/>"), HasSubstr("attributes"));
  EXPECT_THAT(said(std::string(17 << 20, ' ')), HasSubstr("at most 16777216"));
}

// urdfdom releases a chain link by link, each within the release of the one before.
TEST(Urdf, RefusesEndlessChains) {
  constexpr int kMany = 100000;
  std::string chain;
  for (int i = 0; i < kMany; ++i) {
    const std::string name = fmt::format("l{:06d}", kMany - i);
    chain += "<link name='" + name + "'/>";
    if (i > 0) chain += joint(fmt::format("l{:06d}", kMany - i + 1), name, "fixed", "");
  }
  EXPECT_THAT(refusal([&] { parse(chain); }), HasSubstr("100000 links"));
}

TEST(Urdf, IsReadInTheEncodingItHas) {
  const std::string text = test::robot(link("\xC3\xA9") + joint("\xC3\xA9", "b") + link("b"));
  const ArmDescription plain = parse_urdf(text, "x.urdf", "");
  std::string wide = "\xFF\xFE", latin;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i] == '\xC3' ? '\xE9' : text[i];
    if (text[i] == '\xC3') ++i;
    wide += {c, '\0'};
    latin += c;
  }
  for (const std::string& other : {wide, latin}) {
    const ArmDescription arm = parse_urdf(other, "x.urdf", "");
    EXPECT_EQ(arm.dof(), 1);
    EXPECT_EQ(arm.tip_link, plain.tip_link);
    EXPECT_EQ(arm.urdf, text);  // recordings hold the text as UTF-8
  }
}

// The parser reports errors through one place shared by the whole program.
TEST(Urdf, IsReadByManyAtOnce) {
  const std::string good = test::robot(link("a") + joint("a", "b") + link("b"));
  const std::string bad = test::robot(link("a") + joint("a", "nowhere") + link("b"));
  std::vector<std::thread> readers;
  std::atomic<int> wrong = 0;
  for (int i = 0; i < 8; ++i) {
    readers.emplace_back([&, i] {
      for (int k = 0; k < 300; ++k) {
        const std::string said = refusal([&] { parse_urdf(i % 2 ? good : bad, "x.urdf", ""); });
        wrong += i % 2 ? !said.empty() : said.find("nowhere") == std::string::npos;
      }
    });
  }
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(wrong, 0);
}

TEST(Urdf, TakesThirtyTwoJoints) {
  std::string chain = link("l0");
  for (int i = 0; i < 32; ++i) {
    const std::string to = "l" + std::to_string(i + 1);
    chain += joint("l" + std::to_string(i), to) + link(to);
  }
  EXPECT_EQ(parse(chain).dof(), 32);
}

}  // namespace
}  // namespace limpid
