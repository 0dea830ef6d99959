// Energy tanks on both sides of a link, and their promises under any behaviour of the link.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/dynamics/arm.h"
#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

using test::Random;
using test::Rows;

// A hand that shakes, taps and presses, on an arm above a wall.
struct Tapping {
  ArmDescription arm;
  Parameters p{};
  double wall = 600;   // 0: no wall [N/m]
  double press = 4;    // [N]
  double shaking = 5;  // [rad/s]
  double seconds = 2;

  Rows run() const {
    RigStart start;
    start.x1 = start.x2 = rest_pose(arm);
    start.v1 = start.v2 = start.f1_hat = Eigen::VectorXd::Zero(start.x1.size());
    const Vec3 home = Arm<kAnyDof>(arm).tip_at(start.x1);
    constexpr double kAbove = 0.01;
    Scene scene;
    if (wall > 0) {
      scene.add({"", pose_at(home - kAbove * Vec3::UnitZ()), Plane{Vec3::UnitZ()}, {wall}});
    }
    Parameters q = p;
    q.kind = CouplingKind::tank;
    start.target = home;
    Rig rig(arm, scene);
    rig.start(q, start);
    Rows rows(rig.layout());
    const auto ticks = static_cast<std::size_t>(seconds / p.tick);
    for (std::size_t k = 0; k < ticks && !rig.diverged(); ++k) {
      const double t = static_cast<double>(k) * p.tick;
      const double way = (kAbove + press / p.hand_stiffness) * (1 - std::cos(shaking * t)) / 2;
      const Vec3 aside(0.01 * std::sin(1.7 * shaking * t), 0.01 * std::sin(0.6 * shaking * t), 0);
      const bool rests = t > 0.7 * seconds;  // at its present place
      if (!rests) start.target = home + aside - way * Vec3::UnitZ();
      rig.step(q, {{start.target, 1}}, rows.add());
    }
    EXPECT_FALSE(rig.diverged());
    return rows;
  }
};

double highest(const Rows& rows) {
  double most = -HUGE_VAL;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    most = std::max(most, rows.at(k, Column::energy_total));
  }
  return most;
}

Tapping at_random(unsigned seed) {
  Random random(seed);
  Tapping t;
  const int dof = random.one_of({2, 3, 3, 5});
  t.arm = dof == 3 && random.between(0, 1) < 0.6 ? test::omni() : test::random_arm(dof, seed);
  t.p.link_delay = static_cast<int>(random.between(0, 1) < 0.2 ? 0 : random.log_between(1, 200.9));
  t.p.link_jitter = static_cast<int>(random.one_of({0.0, 1.0}) * random.between(0, 50.9));
  t.p.link_loss = random.one_of({0.0, 0.0, 0.3, 0.9});
  t.p.link_seed = static_cast<int>(seed);
  t.p.k_vc = random.log_between(1, 50);
  t.p.b_vc = random.one_of({0.0, 0.001, 0.02});
  t.p.b_v = random.log_between(1e-3, 0.1);
  t.p.hand_stiffness = random.log_between(50, 3000);
  t.p.hand_damping = random.one_of({0.0, 2.0});
  t.p.inertia_ratio = random.log_between(1e-4, 1);
  t.p.tank_share = random.log_between(1e-3, 1);
  t.wall = random.one_of({0.0, 1.0}) * random.log_between(100, 20000);
  t.press = random.between(0.5, 8);
  t.shaking = random.log_between(2, 60);
  return t;
}

TEST(Tanks, GiveNoMoreThanTheyHeldWhateverTheLinkDoes) {
  double most = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    const Tapping t = at_random(seed);
    const double given = highest(t.run());
    most = std::max(most, given);
    EXPECT_LE(given, t.p.tank_energy) << "seed " << seed;
  }
  EXPECT_GT(most, 1e-4) << "nothing was tried";
}

// The energy left in the tanks and between them is their initial one, less E_c, to round-off.
TEST(Tanks, HoldWhatTheEnergyBooksSay) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    Tapping t = at_random(seed);
    t.p.tank_most = 100;
    const Rows rows = t.run();
    double largest = 1e-3;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const double E = rows.at(k, Column::energy_total);
      largest = std::max(largest, std::abs(E));
      ASSERT_NEAR(rows.at(k, Column::energy_ledger), t.p.tank_energy - E, 1e-10 * largest)
          << "seed " << seed << ", row " << k;
    }
  }
}

// Readings do not show that a torque comes late; the largest account of all delays counts.
TEST(Tanks, KeepTheirPromiseWithLateMotors) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    Tapping t = at_random(seed);
    t.arm = test::omni();
    t.p.hand_damping = 2;
    t.p.device_delay = 1 + static_cast<int>(seed % 3);
    EXPECT_LE(highest(t.run()), t.p.tank_energy) << "seed " << seed;
  }
}

// Tanks with enough energy change nothing: a slow hand in free space, and a press.
TEST(Tanks, ThatAreFullLeaveTheStandardCouplingAsItIs) {
  Tapping t{.arm = test::omni()};
  t.p.tank_damping = 0;
  t.shaking = 3;
  t.press = 2;
  const Rows rows = t.run();
  std::size_t cut = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    cut += rows.at(k, Column::torque_governor) < 1 || rows.at(k, Column::governor) < 1 ? 1 : 0;
    const Eigen::VectorXd x1 = rows.vec(k, Column::device_position),
                          x2 = rows.vec(k, Column::proxy_position),
                          tau = rows.vec(k, Column::commanded_torque);
    if (rows.at(k, Column::torque_governor) < 1 || k == 0) continue;
    const Eigen::VectorXd v1 = (x1 - rows.vec(k - 1, Column::device_position)) / t.p.tick,
                          v2 = (x2 - rows.vec(k - 1, Column::proxy_position)) / t.p.tick;
    ASSERT_LT((tau + t.p.k_vc * (x1 - x2) + t.p.b_vc * (v1 - v2)).norm(), 1e-9) << k;
  }
  EXPECT_LT(cut, rows.size() / 100);
}

// The next part of a run starts with the energy left by the one before.
TEST(Tanks, AreNotFilledByStartingAnew) {
  Tapping t{.arm = test::omni()};
  RigStart start = rest_at(t.arm, Vec3(0.19, 0, 0));
  start.reserve = 1e-3;
  t.p.kind = CouplingKind::tank;
  Rig rig(t.arm, {});
  rig.start(t.p, start);
  const RigInput still{{start.target, 1}};
  Rows rows(rig.layout());
  rig.step(t.p, still, rows.add());
  EXPECT_EQ(rows.at(0, Column::energy_ledger), 1e-3);
  t.p.kind = CouplingKind::standard;
  for (int k = 0; k < 3; ++k) rig.step(t.p, still, rows.add());
  t.p.kind = CouplingKind::tank;
  rig.step(t.p, still, rows.add());
  EXPECT_LT(rows.at(4, Column::energy_ledger), 1.1e-3);
}

}  // namespace
}  // namespace limpid
