// Each law's promise in a thousand random runs: arms, walls, hands, links and late motors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/coupling/walls.h"
#include "core/dynamics/arm.h"
#include "tests/support/tapping.h"

namespace limpid {
namespace {

using test::Random;
using test::Rows;
using test::Tapping;

constexpr unsigned kRuns = 1000;

std::string text(const Tapping& t, unsigned seed) {
  return fmt::format(
      "seed {}: {} joints, wall {} N/m, press {} N at {} rad/s, hand {} N/m {} N s/m {} kg, {} "
      "ticks late, link {} + {} loss {}, encoders {}, limit {} N m",
      seed, t.arm.dof(), t.wall, t.press, t.shaking, t.p.hand_stiffness, t.p.hand_damping,
      t.p.hand_mass_at_tip, t.p.device_delay, t.p.link_delay, t.p.link_jitter, t.p.link_loss,
      t.p.encoder_step, t.p.torque_limit);
}

bool touches(const Rows& rows) {
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (!rows.vec(k, Column::contact_torque).isZero(0)) return true;
  }
  return false;
}

// Expects of every run that `draw` makes of a seed that a column is never above `most`, and that a
// quarter of them touch the wall at least.
template <class Draw>
void expect_in_all_runs(Column column, double most, const Draw& draw) {
  unsigned touched = 0;
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    Tapping t = draw(seed);
    t.seconds = 1.2;
    const Rows rows = t.run();
    EXPECT_LE(test::highest(rows, column), most) << text(t, seed);
    touched += touches(rows) ? 1 : 0;
  }
  EXPECT_GT(touched, kRuns / 4);
}

// A random run without a link: the laws on the device itself know none. Its motors never meet their
// limit.
Tapping on_the_device(unsigned seed, CouplingKind kind) {
  Tapping t = test::at_random(seed, kind);
  Random random(seed + 1'000'000);
  t.p.link_delay = t.p.link_jitter = 0;
  t.p.link_loss = 0;
  t.p.device_delay = t.p.delay = static_cast<int>(random.one_of({0.0, 0.0, 1.0, 3.0}));
  t.p.hand_mass_at_tip = random.one_of({0.0, 0.0, 0.1});
  t.p.torque_limit = 100;
  return t;
}

Eigen::VectorXd own_damping(const ArmDescription& arm) {
  Eigen::VectorXd b_d(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) b_d[i] = arm.joints[static_cast<std::size_t>(i)].damping;
  return b_d;
}

// Nothing is given, as far as b_d is right, with steps of the encoders and weak motors as well.
TEST(PromisesAtRandom, EnergyBoundingGivesNothing) {
  expect_in_all_runs(Column::energy_port, 1e-12, [](unsigned seed) {
    Tapping t = on_the_device(seed, CouplingKind::eba);
    Random random(seed + 2'000'000);
    t.p.encoder_step = random.one_of({0.0, 0.0, 1e-4, 4e-4});
    if (seed % 3 == 0) t.p.torque_limit = random.log_between(0.05, 2);
    return t;
  });
}

// Walls up to b_n/(T/2 + delay) give nothing (Colgate and Schenkel 1997), b_n the damping along the
// direction in which it is least; as the arm turns, a tenth less. Motors at their limit are apart:
// clipped joint by joint, a wall's force turns, and a way around it gives energy.
TEST(PromisesAtRandom, DirectWallsGiveNothingToTheBoundForEveryHand) {
  expect_in_all_runs(Column::energy_port, 1e-9, [](unsigned seed) {
    Tapping t = on_the_device(seed, CouplingKind::direct);
    const Arm<kAnyDof> arm(t.arm);
    Arm<kAnyDof>::Frames frames;
    arm.frames(rest_pose(t.arm), frames);
    Jacobian<kAnyDof> J;
    arm.point_jacobian(frames, arm.dof() - 1, arm.tip(frames), J);
    const Eigen::VectorXd b_d = own_damping(t.arm);
    const TipAlong tip =
        tip_along(J, Eigen::MatrixXd::Identity(arm.dof(), arm.dof()), b_d, least_damped(J, b_d));
    t.wall = 0.9 * every_hands_wall(tip, t.p.tick, t.p.tick * t.p.delay);
    t.press = std::min(t.press, 0.01 * t.wall);  // a centimetre at most
    return t;
  });
}

// On an arm of 70 g at the tip with exact encoders and prompt motors: what was given is taken back
// to a millijoule, also where motors meet their limit.
TEST(PromisesAtRandom, PassivityControllerTakesBackWhatWasGiven) {
  expect_in_all_runs(Column::energy_port, 1e-3, [](unsigned seed) {
    Tapping t = on_the_device(seed, CouplingKind::popc);
    t.arm = test::omni();
    for (Link& link : t.arm.links) {
      link.mass *= 7;
      link.inertia *= 7;
    }
    t.p.device_delay = t.p.delay = 0;
    t.wall = std::min(t.wall, 10'000.0);
    Random random(seed + 5'000'000);
    if (seed % 3 == 0) t.p.torque_limit = random.log_between(0.05, 2);
    return t;
  });
}

// Dampings of the joints over three decades, above the least that the arm has.
void damp_each_joint(ArmDescription& arm, Random& random) {
  const double least = own_damping(arm).minCoeff();
  for (Joint& joint : arm.joints) joint.damping = random.log_between(1, 1000) * least;
}

// On the edge of condition (3), at every joint by its own damping.
TEST(PromisesAtRandom, SpringsThatGrowWithTheDampingGiveNothing) {
  expect_in_all_runs(Column::energy_total, 1e-9, [](unsigned seed) {
    Tapping t = on_the_device(seed, CouplingKind::standard);
    Random random(seed + 6'000'000);
    damp_each_joint(t.arm, random);
    const double b_d = own_damping(t.arm).minCoeff(), delay = t.p.tick * t.p.delay;
    t.p.per_joint = true;
    t.p.b_vc = random.between(0, 0.4) * b_d;
    t.p.k_vc = (b_d - 2 * t.p.b_vc) / (t.p.tick + 1.5 * delay);
    t.p.b_v = t.p.k_vc * (t.p.tick + delay) / 2;
    t.p.torque_limit = 1e4;
    return t;
  });
}

// Device and proxy together are given nothing through any link, with a line up to b_d.
TEST(PromisesAtRandom, WavesGiveNothingThroughAnyLink) {
  expect_in_all_runs(Column::energy_total, 1e-9, [](unsigned seed) {
    Tapping t = test::at_random(seed, CouplingKind::wave);
    Random random(seed + 3'000'000);
    t.p.wave_b = random.log_between(0.1, 1) * own_damping(t.arm).minCoeff();
    return t;
  });
}

// Through links to 50 ms the hand is given at most 5 mJ, with the built-in arm and the paper's
// gains.
TEST(PromisesAtRandom, TwoPortsGiveLittleThroughLinksToFiftyMilliseconds) {
  expect_in_all_runs(Column::energy_port, 5e-3, [](unsigned seed) {
    Tapping t = test::at_random(seed, CouplingKind::tdpn);
    const Parameters drawn = t.p;
    Random random(seed + 4'000'000);
    t.arm = test::omni();
    t.p = {};
    t.p.kind = CouplingKind::tdpn;
    t.p.link_delay = std::min(drawn.link_delay, 50);
    t.p.link_jitter = std::min(drawn.link_jitter, 20);
    t.p.link_loss = random.one_of({0.0, 0.2});
    t.p.link_seed = drawn.link_seed;
    t.p.hand_stiffness = drawn.hand_stiffness;
    t.p.hand_damping = drawn.hand_damping;
    return t;
  });
}

}  // namespace
}  // namespace limpid
