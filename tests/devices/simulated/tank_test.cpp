// Energy tanks on both sides of a link, and their promises under any behaviour of the link.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/tapping.h"

namespace limpid {
namespace {

using test::highest;
using test::Rows;
using test::Tapping;

Tapping at_random(unsigned seed) { return test::at_random(seed, CouplingKind::tank); }

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

// A reading with steps leaves a joint anywhere in its cell, so beyond the tanks' energy at most q
// sum |dtau| of the motors' torque may be given.
TEST(Tanks, GiveNoMoreThanTheEncodersCellsBesides) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    Tapping t = at_random(seed);
    t.p.encoder_step = 1e-4;
    const Rows rows = t.run();
    double cells = 0;  // [J]
    for (std::size_t k = 1; k < rows.size(); ++k) {
      const Eigen::VectorXd now = rows.vec(k, Column::motor_torque);
      cells +=
          t.p.encoder_step * (now - rows.vec(k - 1, Column::motor_torque)).template lpNorm<1>();
    }
    EXPECT_LE(highest(rows), t.p.tank_energy + cells) << "seed " << seed;
  }
}

// Tanks with enough energy change nothing: a slow hand in free space, and a press.
TEST(Tanks, ThatAreFullLeaveTheStandardCouplingAsItIs) {
  Tapping t{.arm = test::omni()};
  t.p.kind = CouplingKind::tank;
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
