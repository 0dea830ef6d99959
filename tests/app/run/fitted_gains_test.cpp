#include "app/run/fitted_gains.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "app/run/analysis.h"
#include "app/run/tip_limits.h"
#include "core/dynamics/arm.h"
#include "devices/files/urdf_file.h"
#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"
#include "tests/support/taps.h"

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
    const double prompt = fitted(arm).k_vc;
    arm.delay = 0.0021;
    const Parameters p = fitted(arm);
    EXPECT_LT(p.k_vc, prompt);
    const Analysis a = analyze(arm, rest_pose(arm), p, std::nullopt);
    EXPECT_EQ(a.delay, 0.0021);
    EXPECT_TRUE(a.condition3.holds) << damping;
    EXPECT_LT(a.condition3.device_margin, 0.1 * damping) << damping;
  }
}

// A delay that is identified counts as one that the file assumes, and before it.
TEST(FittedGains, TakeTheDelayOfTheFilesReadings) {
  ArmDescription assumed = large_arm(0.5), identified = assumed;
  assumed.assumed_delay = 0.003;
  identified.delay = 0.003;
  identified.assumed_delay = 0.001;
  Parameters fast;
  fast.tick = 0.0005;
  for (const ArmDescription& arm : {assumed, identified}) {
    const Parameters p = fitted_with_readings(arm, fast);
    EXPECT_EQ(p.device_delay, 6) << "ticks of half a millisecond";
    EXPECT_EQ(p.delay, 6);
    const Analysis a = analyze(arm, rest_pose(arm), p, std::nullopt);
    EXPECT_EQ(a.delay, 0.003);
    EXPECT_TRUE(a.condition3.holds);
  }
  EXPECT_GT(fitted(assumed).k_vc, fitted(identified).k_vc) << "what is assumed has to be asked for";
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

TEST(FittedGains, GrowWithTheDampingOfTheJoints) {
  ArmDescription arm = large_arm(0.5);
  EXPECT_FALSE(fitted(arm).per_joint) << "all joints are alike";
  arm.joints[2].damping = 40;
  const Parameters p = fitted(arm);
  EXPECT_TRUE(p.per_joint);
  EXPECT_EQ(p.k_vc, fitted(large_arm(0.5)).k_vc) << "of the least damped joint";
  const Eigen::VectorXd springs = coupling_springs(arm, p);
  EXPECT_EQ(springs[0], p.k_vc);
  EXPECT_EQ(springs[2], 80 * p.k_vc);
  for (int i = 0; i < arm.dof(); ++i) {
    const Joint& joint = arm.joints[static_cast<std::size_t>(i)];
    EXPECT_TRUE(condition3({springs[i], p.b_vc * springs[i] / p.k_vc, p.b_v * springs[i] / p.k_vc},
                           p.tick, std::array{joint.damping})
                    .holds);
  }
  Parameters chosen;
  chosen.k_vc = 20;
  EXPECT_FALSE(fitted(arm, chosen).per_joint) << "20 N m/rad are meant for every joint";
  chosen = {};
  chosen.damping = 3;
  EXPECT_FALSE(fitted(arm, chosen).per_joint) << "of every joint";
  arm.delay = 0.001;
  arm.joints[1].damping = 0;
  EXPECT_FALSE(fitted(arm).per_joint) << "a joint was measured without damping";
  arm.delay.reset();
  arm.joints[1].damping = 1e-9;
  EXPECT_FALSE(fitted(arm).per_joint) << "no spring is so weak that it would suit";
  arm.joints[1].damping = 0.5;
  Parameters moved, own;
  refit(moved, nullptr, &arm);
  EXPECT_TRUE(moved.per_joint);
  own.k_vc = 20;
  refit(own, nullptr, &arm);
  EXPECT_FALSE(own.per_joint);
}

// A random arm whose last joint turns about its own link: light, hardly damped, with a faint motor.
// Gains of that joint alone let device and proxy drift apart: in a tap E_c rose to 0.28 J, and the
// wall that was named, 97 N/m, was felt as 71 N/m.
TEST(FittedGains, HoldTheWallThatIsNamedOnAnArmWithAFaintJoint) {
  struct Part {
    double at, mass, center, inertia_x, inertia, damping, effort;
    Vec3 axis;
  };
  const Part parts[] = {
      {0, 0.16043, 0.0520345, 8.96585e-06, 0.000237969, 0.3864, 5.079, Vec3::UnitZ()},
      {0.132153, 0.0384825, 0.0354764, 2.35324e-06, 2.17667e-05, 0.09835, 3.181, Vec3::UnitY()},
      {0.0801287, 0.148543, 0.0350196, 4.29856e-06, 0.000114091, 0.02568, 2.8, Vec3::UnitY()},
      {0.0950957, 0.0470043, 0.0203988, 1.36432e-06, 1.8845e-05, 3.719e-05, 0.002389,
       Vec3::UnitX()}};
  const std::array<std::pair<double, double>, 4> ranges{std::pair(-1.1842988, 0.815701197),
                                                        {-1.6732416, 0.326758396},
                                                        {-0.334622168, 1.66537783},
                                                        {-1.2644678, 0.7355322}};
  std::string urdf = "<robot name='r'><link name='l0'/>";
  for (std::size_t i = 0; i < 4; ++i) {
    const Part& p = parts[i];
    urdf += fmt::format(
        "<joint name='j{0}' type='revolute'><parent link='l{0}'/><child link='l{1}'/>"
        "<origin xyz='{2} 0 0'/><axis xyz='{3} {4} {5}'/>"
        "<limit lower='{6}' upper='{7}' effort='{8}' velocity='10'/><dynamics "
        "damping='{9}'/></joint>",
        i, i + 1, p.at, p.axis.x(), p.axis.y(), p.axis.z(), ranges[i].first, ranges[i].second,
        p.effort, p.damping);
    urdf += fmt::format(
        "<link name='l{}'><inertial><origin xyz='{} 0 0'/><mass value='{}'/><inertia ixx='{}' "
        "ixy='0' ixz='0' iyy='{}' iyz='0' izz='{}'/></inertial></link>",
        i + 1, p.center, p.mass, p.inertia_x, p.inertia, p.inertia);
  }
  urdf +=
      "<joint name='end' type='fixed'><parent link='l4'/><child link='tip'/><origin "
      "xyz='0.0680948 0 0'/></joint><link name='tip'/></robot>";
  const ArmDescription arm = parse_urdf(urdf, "arm", {});
  Parameters asked;
  asked.kind = CouplingKind::predictive;
  asked.torque_limit = 1000;
  asked.hand_damping = 2;
  asked.device_delay = asked.delay = 1;
  for (const double grip : {300.0, 2509.6}) {
    asked.hand_stiffness = grip;
    Parameters p = asked;
    refit(p, nullptr, &arm);
    EXPECT_TRUE(p.per_joint);
    const Eigen::VectorXd x = rest_pose(arm), zero = Eigen::VectorXd::Zero(arm.dof());
    test::Taps taps;
    const double named = tip_limits(arm, x, p, {}).wall(p.kind).stiffness;
    EXPECT_GT(named, 1000);
    const RigStart start{x, zero, x, zero, zero, Arm<kAnyDof>(arm).tip_at(x), true};
    const Vec3 out = Vec3(0.18325725607343066, 0.9830649917967978, 0);
    const test::Spot spot = test::flat_spot(start.target - taps.above * out, out);
    for (const double wall : {97.0, 500.0, named}) {
      SCOPED_TRACE(wall);
      taps.wall = wall;
      taps.press = std::min(4.0, 0.005 * wall);
      Scene scene;
      scene.add({"", pose_at(spot.place), Plane{out}, {wall}});
      const test::Felt felt = taps.felt(arm, scene, spot, p, start);
      EXPECT_LE(felt.energy, 1e-6);
      EXPECT_LE(felt.port, 1e-6);
      EXPECT_NEAR(felt.stiffness, 1, 0.05);
      EXPECT_LE(felt.chatter, 2e-3);
    }
  }
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

// At another tick other gains suit an arm: those that come with it are for the chosen tick.
TEST(FittedGains, ComeForTheChosenTick) {
  const ArmDescription arm = large_arm(0.5);
  for (const double tick : {0.001, 0.004}) {
    Parameters chosen;
    chosen.tick = tick;
    Parameters p = chosen;
    refit(p, nullptr, &arm);
    const Parameters wanted = fitted(arm, chosen);
    for (const char* key : kFittedKeys) {
      const ParameterInfo& info = *find_parameter(key);
      EXPECT_EQ(parameter_text(p, info), parameter_text(wanted, info)) << key;
    }
    EXPECT_EQ(p.tick, tick);
    refit(p, &arm, nullptr);
    EXPECT_EQ(p, chosen) << "the paper's again";
  }
}

// b_vc = b_d/12, k_vc = 10/12 b_d/T, b_v = b_d and alpha = 35/12 b_d, in two digits on the safe
// side.
TEST(FittedGains, AreNamedWithTheirUnits) {
  EXPECT_EQ(fit_text(fitted(large_arm(0.5))),
            "coupling.k_vc 410 N m/rad, coupling.b_vc 0.041 N m s/rad, coupling.b_v 0.5 N m s/rad, "
            "observer.alpha 1.4 N m s/rad");
  Parameters damped;
  damped.per_joint = true;
  damped.damping = 0.25;
  EXPECT_EQ(fit_text(damped),
            "gains that grow with each joint's damping, device.damping 0.25 N m s/rad");
}

TEST(FittedGains, TakeReadingsInWholeTicksUpToTheLongestDelay) {
  ArmDescription arm = test::omni();
  arm.encoder_step = 2e-4;
  arm.assumed_delay = 0.0026;
  Parameters p;
  p.eta = 0.3;
  const Parameters q = with_readings_of(arm, p);
  EXPECT_EQ(q.encoder_step, 2e-4);
  EXPECT_EQ(q.device_delay, 3);
  EXPECT_EQ(q.delay, 3) << "the law knows it";
  EXPECT_EQ(q.eta, 0.3);
  arm.assumed_delay = 1;
  EXPECT_EQ(with_readings_of(arm, p).device_delay, kMostDelay);
  p.tick = 0.01;
  arm.assumed_delay = 0.02;
  EXPECT_EQ(with_readings_of(arm, p).device_delay, 2);
  p.encoder_step = 2e-4;
  EXPECT_EQ(readings_text(arm, p),
            "the arm's file says encoder steps of 0.2 mrad and a delay of 20 ms; the settings say "
            "encoder steps of 0.2 mrad and no delay");
}

}  // namespace
}  // namespace limpid
