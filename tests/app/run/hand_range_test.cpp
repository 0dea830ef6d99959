// Stability in hands of a range, beside every hand: bounds of the literature and the laws' own.
#include "app/run/hand_range.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/run/analysis.h"
#include "app/run/wall_tap.h"
#include "core/dynamics/arm.h"
#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

InHands judged(const Parameters& p, double from, double to) {
  const ArmDescription arm = test::omni();
  const Eigen::VectorXd x = rest_pose(arm);
  return in_hands(arm, x, p, analyze(arm, x, p, std::nullopt), tip_limits(arm, x, p, {}),
                  {from, to});
}
const LawInHands& law(const InHands& all, CouplingKind kind) {
  return all.laws[static_cast<std::size_t>(kind)];
}
TipAlong tip_at_rest(const Parameters& p) {
  const ArmDescription arm = test::omni();
  return tip_limits(arm, rest_pose(arm), p, {}).tip;
}

TEST(HandRange, NamesTheBoundsOfTheLiterature) {
  Parameters p;
  const TipAlong tip = tip_at_rest(p);
  const double b = tip.damping, q = 4e-4 * std::sqrt(tip.lever2);
  InHands all = judged(p, 300, 3000);
  EXPECT_NEAR(*all.sampled.wall, 2 * b / 1e-3, 1e-9);
  EXPECT_NEAR(*all.stepped.wall, 2 * b / 1e-3, 1e-9) << "exact encoders ask for no friction";
  p.encoder_step = 4e-4;
  EXPECT_EQ(*judged(p, 300, 3000).stepped.wall, 0) << "the built-in arm has no friction";
  p.friction = 1e-3;
  const ArmDescription arm = test::omni();
  const Eigen::MatrixXd J = arm_at(arm, rest_pose(arm)).J;
  double f_c = 1e9;
  for (int i = 0; i < 3; ++i) f_c = std::min(f_c, p.friction / J.col(i).norm());
  all = judged(p, 300, 3000);
  EXPECT_NEAR(*all.stepped.wall, std::min(2 * b / 1e-3, 2 * f_c / q), 1e-9);
  EXPECT_LT(*all.stepped.wall, *all.sampled.wall);
  EXPECT_NEAR(*law(all, CouplingKind::direct).in_any_hand.up_to, 2 * f_c / q, 1e-9);
  p.friction_share = 0.25;
  EXPECT_NEAR(*judged(p, 300, 3000).stepped.wall, 0.75 * 2 * f_c / q, 1e-9)
      << "the motors take a share of the friction off";
  p.delay = p.device_delay = 2;
  all = judged(p, 300, 3000);
  EXPECT_NEAR(*all.sampled.wall, b / 2.5e-3, 1e-9);
  EXPECT_FALSE(all.stepped.wall) << "the bound is not known with a delay";
  EXPECT_FALSE(law(all, CouplingKind::direct).in_any_hand.up_to);
  p.encoder_step = 0;
  EXPECT_NEAR(*law(judged(p, 300, 3000), CouplingKind::direct).in_any_hand.up_to, b / 2.5e-3, 1e-9);
}

// The damping of arm and hand over the lag, in every hand of the range; no hand of it is worse.
TEST(HandRange, OfADirectWallIsTheDampingOfArmAndHandOverTheLag) {
  for (const int delay : {0, 1, 3}) {
    Parameters p;
    p.hand_damping = 2;
    p.hand_mass_at_tip = 0.2;  // heavy against what is light in the closed form
    p.delay = p.device_delay = delay;
    const double theory = (tip_at_rest(p).damping + 2) / (0.0005 + 0.001 * delay);
    const SafeWalls wall = law(judged(p, 10, 100), CouplingKind::direct).in_range;
    EXPECT_NEAR(*wall.up_to, theory, 0.05 * theory) << delay;
    EXPECT_GT(*wall.up_to, *law(judged(p, 10, 100), CouplingKind::direct).in_any_hand.up_to);
  }
}

TEST(HandRange, IsAsGoodAsItsWorstHand) {
  Parameters p;
  p.hand_damping = 0.5;
  const auto direct = [&](double from, double to) {
    return law(judged(p, from, to), CouplingKind::direct).in_range;
  };
  const SafeWalls wide = direct(50, 5000);
  double worst = 1e9;
  for (const double hand : {50.0, 500.0, 5000.0})
    worst = std::min(worst, *direct(hand, hand).up_to);
  EXPECT_LE(*wide.up_to, worst);
  EXPECT_NEAR(*direct(*wide.hand, *wide.hand).up_to, *wide.up_to, 1e-3 * *wide.up_to);
}

// Gains beyond condition (3): passive in no account, and yet stable in hands that damp.
TEST(HandRange, OfTheStandardLawGoesBeyondConditionThree) {
  Parameters p;
  p.hand_damping = 4;
  EXPECT_TRUE(std::isinf(*law(judged(p, 300, 3000), CouplingKind::standard).in_any_hand.up_to));
  p.k_vc = 20;
  const LawInHands standard = law(judged(p, 300, 3000), CouplingKind::standard);
  EXPECT_EQ(*standard.in_any_hand.up_to, 0);
  EXPECT_TRUE(std::isinf(*standard.in_range.up_to));
  EXPECT_TRUE(standard.two_port->fails_from);
  p.link_delay = 3;
  EXPECT_FALSE(law(judged(p, 300, 3000), CouplingKind::standard).in_range.up_to);
}

// Trembling in the last tenth of a second over that a second before, of a hand that jumps by 0.1 mm
// where the tip is pressed against a wall, which it never leaves; wall 0: in free space [-].
double lasts(const Parameters& p, double wall) {
  const ArmDescription arm = test::omni();
  const TapPlace place = tap_place(arm, rest_pose(arm), p);
  Scene scene;
  double press = 0;
  if (wall > 0) {
    scene.add({"", pose_at(place.point), Plane{place.out}, {wall}});
    press = 3 / wall + 3 / p.hand_stiffness;
  }
  Rig rig(arm, scene);
  rig.start(p, rest_at(arm, place.point));
  test::Rows rows(rig.layout());
  for (std::size_t k = 0; k < 1900 && !rig.diverged(); ++k) {
    const double in = std::min(1.0, static_cast<double>(k) / 200), jump = k < 300 ? 0 : 1e-4;
    rig.step(p, {{place.point - in * press * place.out + jump * Vec3(1, 1, 1), 1}}, rows.add());
  }
  if (rig.diverged()) return HUGE_VAL;
  const auto fastest = [&](std::size_t from) {
    double most = 0;
    for (std::size_t k = from; k < from + 100; ++k) {
      most = std::max(most, rows.vec(k, Column::device_velocity).norm());
    }
    return most;
  };
  return fastest(1800) / fastest(800);
}

// Walls under the proposed law, as the poles say and as the arm does.
TEST(HandRange, OfTheProposedLawEndsWhereTheArmBeginsToTremble) {
  for (const double eta : {1.0, 0.5}) {
    for (const int delay : {0, 2}) {
      Parameters p;
      p.kind = CouplingKind::proposed;
      p.torque_limit = 1000;
      p.eta = eta;
      p.hand_stiffness = 600;
      p.hand_damping = 3;
      p.delay = p.device_delay = delay;
      const double K = *law(judged(p, 600, 600), CouplingKind::proposed).in_range.up_to;
      ASSERT_GT(K, 100) << eta << " " << delay;
      EXPECT_LT(lasts(p, 0.93 * K), 0.5) << eta << " " << delay << " " << K;
      EXPECT_GT(lasts(p, 1.07 * K), 0.9) << eta << " " << delay << " " << K;
    }
  }
}

// The spring with which free motion is stable in a hand, as the poles say and as the arm does.
TEST(HandRange, OfTheStandardLawEndsWhereTheArmBeginsToTremble) {
  for (const int delay : {0, 1}) {
    Parameters p;
    p.kind = CouplingKind::standard;
    p.torque_limit = 1000;
    p.hand_stiffness = 300;
    p.delay = p.device_delay = delay;
    double low = 10, high = 1000;
    while (high / low > 1.001) {
      p.k_vc = std::sqrt(low * high);
      (*law(judged(p, 300, 300), CouplingKind::standard).in_range.up_to > 0 ? low : high) = p.k_vc;
    }
    p.k_vc = 0.95 * low;
    EXPECT_LT(lasts(p, 0), 0.5) << delay << " " << low;
    p.k_vc = 1.05 * low;
    EXPECT_GT(lasts(p, 0), 0.9) << delay << " " << low;
  }
}

// A range of one hand is that hand; a wider one is as bad as its worst, and none is above (25).
TEST(HandRange, OfEtaIsTheWorstGrips) {
  const ArmDescription arm = test::omni();
  Parameters p;
  p.hand_damping = 1;
  double worst = 0;
  for (const double hand : {200.0, 900.0, 4000.0}) {
    Parameters q = p;
    q.hand_stiffness = hand;
    const double one = analyze(arm, rest_pose(arm), q, std::nullopt).eta_min_compliant;
    EXPECT_NEAR(judged(p, hand, hand).eta_min, one, 1e-9);
    worst = std::max(worst, one);
  }
  const InHands wide = judged(p, 200, 4000);
  EXPECT_GE(wide.eta_min, worst);
  EXPECT_LE(wide.eta_min, wide.eta_min_any);
}

TEST(HandRange, SaysOfEveryLawWhatIsKnown) {
  const InHands all = judged({}, 300, 3000);
  for (const LawInHands& each : all.laws) {
    EXPECT_FALSE(each.in_range.why.empty());
    EXPECT_FALSE(each.in_any_hand.why.empty());
    EXPECT_FALSE(each.two_port_why.empty());
  }
  using enum CouplingKind;
  for (const CouplingKind passive : {standard, predictive, tank, eba}) {
    EXPECT_TRUE(std::isinf(*law(all, passive).in_range.up_to)) << name(passive);
  }
  Parameters soft_line;
  soft_line.wave_b = 0.0039;  // less than a third of the built-in arm's 0.012
  EXPECT_TRUE(std::isinf(*law(judged(soft_line, 300, 3000), wave).in_range.up_to));
  EXPECT_FALSE(law(all, proposed).in_any_hand.up_to) << "(25) is about free motion";
  EXPECT_GT(*law(all, proposed).in_range.up_to, 500);
  for (const CouplingKind open : {popc, tdpn, sfa, wave}) {
    EXPECT_FALSE(law(all, open).in_range.up_to) << name(open);
    EXPECT_FALSE(law(all, open).in_any_hand.up_to) << name(open);
    EXPECT_FALSE(law(all, open).two_port) << name(open);
  }
}

}  // namespace
}  // namespace limpid
