#include "app/run/fitted_gains.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/run/analysis.h"
#include "core/dynamics/arm.h"
#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

// An arm as heavy and long as in a factory; every joint has `damping`.
ArmDescription large_arm(double damping) {
  ArmDescription arm = test::random_arm(6, 3);
  for (Joint& joint : arm.joints) {
    joint.origin.translation() *= 4;
    joint.effort = 200;
    joint.damping = damping;
  }
  for (Link& link : arm.links) {
    link.mass *= 100;
    link.com *= 4;
    link.inertia *= 1600;
  }
  return arm;
}

TEST(FittedGains, AreThePapersForArmsThatTheySuit) {
  EXPECT_EQ(fitted(test::omni()), Parameters{});
  EXPECT_EQ(fitted(test::random_arm(3, 1)), Parameters{});
  Parameters tick;
  tick.tick = 0.002;
  EXPECT_EQ(fitted(test::omni(), tick), Parameters{}) << "whatever is chosen";
}

TEST(FittedGains, SayHowReadingsDifferFromTheFiles) {
  ArmDescription arm = test::omni();
  EXPECT_EQ(readings_text(arm, {}), "") << "a file that says nothing";
  arm.encoder_step = 4.19e-4;
  arm.assumed_delay = 1e-3;
  EXPECT_EQ(readings_text(arm, {}),
            "the arm's file says encoder steps of 0.419 mrad and a delay of 1 ms; the settings say "
            "exact encoders and no delay");
  EXPECT_EQ(readings_text(arm, with_readings_of(arm, {})), "");
  for (Joint& joint : arm.joints) joint.kind = Joint::Kind::prismatic;
  arm.encoder_step = 1e-4;  // of 0.1 m
  arm.assumed_delay = 0;
  EXPECT_THAT(readings_text(arm, {}), testing::HasSubstr("steps of 0.01 mm and no delay"));
}

TEST(FittedGains, KeepCondition3AndTheMarginOfEta) {
  for (const double damping : {0.0, 0.001, 0.5, 20.0}) {
    for (const double tick : {0.001, 0.00025, 0.004}) {
      const ArmDescription arm = large_arm(damping);
      Parameters chosen;
      chosen.tick = tick;
      Parameters p = fitted(arm, chosen);
      p.tick = tick;
      const Analysis a = analyze(arm, rest_pose(arm), p, std::nullopt);
      EXPECT_TRUE(a.condition3.holds) << damping << ' ' << tick;
      EXPECT_GE(a.condition3.proxy_margin, 0);
      EXPECT_LT(a.eta_min, 0.6);
      EXPECT_GT(a.eta_min, 0.5);
      // The margin left of the device's damping comes from rounding to two digits, except at the
      // stiffest possible spring.
      const double b_d = device_damping(arm, p).minCoeff();
      if (p.k_vc < find_parameter("coupling.k_vc")->maximum) {
        EXPECT_LT(a.condition3.device_margin, 0.1 * b_d) << damping << ' ' << tick;
      }
      EXPECT_EQ(std::isnan(p.damping), damping > 0) << "the file's own damping stays";
    }
  }
}

TEST(FittedGains, ReckonWithTheDelayThatWasMeasured) {
  for (const double damping : {0.004, 0.012, 0.5}) {
    ArmDescription arm = large_arm(damping);
    arm.delay = 0.0021;
    const Parameters p = fitted(arm, {}, *arm.delay);
    EXPECT_LT(p.k_vc, fitted(arm).k_vc) << "which is for none";
    const Analysis a = analyze(arm, rest_pose(arm), p, std::nullopt);
    EXPECT_EQ(a.delay, 0.0021);
    EXPECT_TRUE(a.condition3.holds) << damping;
    EXPECT_LT(a.condition3.device_margin, 0.1 * damping) << damping;
  }
}

// The arm is identified without damping.
TEST(FittedGains, GiveAnIdentifiedArmNoDampingOfItsOwn) {
  ArmDescription arm = large_arm(0);
  arm.delay = 0.001;
  EXPECT_TRUE(std::isnan(fitted(arm).damping));
}

TEST(SuggestedCompensation, IsOfWhatWasMeasuredAlone) {
  ArmDescription arm = large_arm(0.5);
  arm.joints[1].friction = 0.01;
  EXPECT_EQ(suggested_compensation(arm), CompensationSettings{}) << "it is its file's";
  arm.delay = 0.001;
  EXPECT_TRUE(suggested_compensation(arm).holds_weight);
  EXPECT_FALSE(suggested_compensation(arm).holds_springs);
  EXPECT_EQ(suggested_compensation(arm).friction_share, 0.7);
  arm.gravity.setZero();
  arm.joints[0].offset = -0.01;
  EXPECT_FALSE(suggested_compensation(arm).holds_weight);
  EXPECT_TRUE(suggested_compensation(arm).holds_springs);
}

// Rate of the dampers: b/m, the geometric mean over the modes; 50 per second on the built-in arm.
TEST(FittedGains, DampAnArmThatSaysNoDampingAsTheBuiltInOneIs) {
  const auto rate = [](const ArmDescription& arm, double b_d) {
    const Analysis a = analyze(arm, rest_pose(arm), Parameters{}, std::nullopt);
    double product = 1;
    for (const LockedMode& mode : a.modes) product *= b_d / mode.m;
    return std::pow(product, 1.0 / static_cast<double>(a.modes.size()));
  };
  const ArmDescription arm = large_arm(0);
  const double like_built_in = rate(test::omni(), 0.012);
  EXPECT_NEAR(rate(arm, fitted(arm).damping) / like_built_in, 1, 0.2);
}

TEST(FittedGains, TakeTheDampingThatIsChosen) {
  Parameters chosen;
  chosen.damping = 3;
  const Parameters p = fitted(large_arm(0), chosen);
  EXPECT_EQ(p.damping, 3);
  EXPECT_NEAR(p.b_v, 3, 1e-9);
  EXPECT_NEAR(p.k_vc, 2500, 51);
}

TEST(FittedGains, ComeAndGoWithTheArmAndLeaveWhatWasChosen) {
  const ArmDescription arm = large_arm(0.5);
  Parameters p;
  p.b_v = 0.07;
  p.eta = 0.8;
  refit(p, nullptr, &arm);
  EXPECT_EQ(p.k_vc, fitted(arm).k_vc);
  EXPECT_EQ(p.b_v, 0.07);
  EXPECT_EQ(p.eta, 0.8);
  const ArmDescription omni = test::omni();
  refit(p, &arm, &omni);
  Parameters own;
  own.b_v = 0.07;
  own.eta = 0.8;
  EXPECT_EQ(p, own);
}

TEST(FittedGains, SayWhatTheyAre) {
  EXPECT_EQ(fit_text(Parameters{}), "");
  EXPECT_THAT(fit_text(fitted(large_arm(0))),
              testing::AllOf(testing::HasSubstr("coupling.k_vc"), testing::HasSubstr("N m/rad"),
                             testing::HasSubstr("device.damping")));
}

}  // namespace
}  // namespace limpid
