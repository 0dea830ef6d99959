#include "core/dynamics/farthest_tip.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/dynamics/arm.h"
#include "core/dynamics/inverse_kinematics.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;
using test::random_arm;

double distance_at(const ArmDescription& arm, const Eigen::VectorXd& x) {
  const Vec3 tip = Arm<kAnyDof>(arm).tip_at(Vec<kAnyDof>(x));
  return (tip - arm.joints.front().origin.translation()).norm();
}

Joint turning(const Vec3& at, const Vec3& axis, double lower = -INFINITY, double upper = INFINITY) {
  Joint joint;
  joint.origin.translation() = at;
  joint.axis = axis;
  joint.lower = lower;
  joint.upper = upper;
  return joint;
}

ArmDescription of(std::vector<Joint> joints, const Vec3& tip) {
  ArmDescription arm;
  arm.joints = std::move(joints);
  arm.links.resize(arm.joints.size());
  arm.tip.translation() = tip;
  return arm;
}

// By the law of cosines: |tip|^2 = a^2 + b^2 + 2 a b cos x2, largest where x2 is nearest to 0.
TEST(FarthestTip, OfTwoLinksInAPlaneFollowsTheLawOfCosines) {
  const double a = 0.3, b = 0.2;
  for (const auto& [lower, upper] : {std::pair{-1.0, 1.0}, {0.7, 2.5}, {-3.0, -1.2}, {1.5, 5.5}}) {
    const ArmDescription arm = of({turning({0.4, 0.1, 0.2}, Vec3::UnitZ(), -0.5, 0.5),
                                   turning({a, 0, 0}, Vec3::UnitZ(), lower, upper)},
                                  {b, 0, 0});
    const double best =
        std::max({std::cos(lower), std::cos(upper), lower < 0 && upper > 0 ? 1 : -1.0});
    const FarthestTip found = farthest_tip(arm);
    EXPECT_NEAR(found.distance, std::sqrt(a * a + b * b + 2 * a * b * best), 1e-12) << lower;
    EXPECT_NEAR(distance_at(arm, found.at), found.distance, 1e-15);
    for (int i = 0; i < 2; ++i) {
      EXPECT_GE(found.at[i], arm.joints[static_cast<std::size_t>(i)].lower);
      EXPECT_LE(found.at[i], arm.joints[static_cast<std::size_t>(i)].upper);
    }
  }
}

// Joints of many turns: the nearest stretched pose may be turns away from the middle.
TEST(FarthestTip, FindsTheStretchedPoseSeveralTurnsAway) {
  const ArmDescription arm =
      of({turning(Vec3::Zero(), Vec3::UnitZ()), turning({0.3, 0, 0}, Vec3::UnitZ(), 6.5, 12.7)},
         {0.2, 0, 0});
  EXPECT_NEAR(farthest_tip(arm).distance, 0.5, 1e-12);
}

// Shoulder, elbow and a wrist with offsets, as arms of six joints have them. a2, a3 and d5 lie in
// the arm's plane and d4 across it; joint 5 turns d6 about d5, by q5 out of the direction of d4.
// Stretched out, |tip|^2 = (a2 + a3 + |(d5, d6 sin q5)|)^2 + (d4 + d6 cos q5)^2.
TEST(FarthestTip, OfAnArmWithOffsetWristsIsFarBelowTheSumOfItsLinks) {
  const double a2 = 0.244, a3 = 0.213, d4 = 0.131, d5 = 0.085, d6 = 0.092;
  const ArmDescription arm =
      of({turning({0, 0, 0.15}, Vec3::UnitZ()), turning({0, 0, 0}, Vec3::UnitY()),
          turning({0, 0, a2}, Vec3::UnitY()), turning({0, d4, a3}, Vec3::UnitY()),
          turning({0, 0, d5}, Vec3::UnitZ()), turning({0, 0, 0}, Vec3::UnitY())},
         {0, d6, 0});
  double best = 0;
  for (double q5 = -M_PI; q5 <= M_PI; q5 += 1e-4) {
    const double along = a2 + a3 + std::hypot(d5, d6 * std::sin(q5));
    best = std::max(best, std::hypot(along, d4 + d6 * std::cos(q5)));
  }
  EXPECT_NEAR(farthest_tip(arm).distance, best, 1e-8);
  EXPECT_LT(farthest_tip(arm).distance, 0.9 * reach(arm));
}

// Slides across each other reach the farthest corner of the box that they span.
TEST(FarthestTip, OfSlidesIsTheFarthestCornerOfTheirBox) {
  ArmDescription arm;
  for (int i = 0; i < 3; ++i) {
    Joint joint;
    joint.kind = Joint::Kind::prismatic;
    joint.axis = Vec3::Unit(i);
    joint.lower = -1 - 2 * i;
    joint.upper = 2;
    arm.joints.push_back(joint);
  }
  arm.links.resize(3);
  EXPECT_NEAR(farthest_tip(arm).distance, Vec3(0.2, 0.3, 0.5).norm(), 1e-15);
  arm.joints[1].upper = INFINITY;  // an unlimited travel is not counted
  EXPECT_NEAR(farthest_tip(arm).distance, Vec3(0.2, 0, 0.5).norm(), 1e-15);
}

TEST(FarthestTip, IsNeverBelowWhatRandomPosesGiveNorAboveTheBound) {
  Random random(7);
  for (const int n : {1, 2, 3, 6, 7, 32}) {
    ArmDescription arm = random_arm(n, static_cast<unsigned>(n));
    for (Joint& joint : arm.joints) {
      joint.lower = random.between(-3, 0);
      joint.upper = joint.lower + random.between(0.1, 3);
    }
    const FarthestTip found = farthest_tip(arm);
    EXPECT_LE(found.distance, reach(arm) * (1 + 1e-12));
    double most = 0;
    for (int round = 0; round < 5000; ++round) {
      Eigen::VectorXd x(n);
      for (int i = 0; i < n; ++i) {
        const Joint& joint = arm.joints[static_cast<std::size_t>(i)];
        x[i] = random.between(joint.lower, joint.upper);
      }
      most = std::max(most, distance_at(arm, x));
    }
    EXPECT_GE(found.distance, most * (1 - 1e-12)) << n;  // with one joint all poses are equally far
    EXPECT_EQ(farthest_tip(arm).at, found.at) << "the same answer every time";
  }
}

}  // namespace
}  // namespace limpid
