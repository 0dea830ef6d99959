// Motors at their limit while the tip is between walls: promises of the predictive law, in random
// runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "devices/simulated/random_corner.h"
#include "tests/support/built_in.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

using test::Rows;

LimitedCorner random_corner(unsigned seed, const CornerWidth& width) {
  return limited_corner(seed, width, test::omni());
}

struct CornerOutcome {
  double energy = 0;   // highest E_c, from torques and positions [J]
  double torque = 0;   // largest contact torque on a joint, over the motor's limit [-]
  double jump = 0;     // largest step of the proxy's joints in a tick [rad]
  double reserve = 1;  // lowest [J]
  double port = 0;     // most energy given to the hand [J]
  int limited = 0;     // ticks with a motor at its limit
  int unsettled = 0;   // ticks without a solution
  int ticks = 0;
};

CornerOutcome run_corner(const LimitedCorner& c) {
  Rig rig(c.arm, c.scene);
  rig.start(c.p, c.start);
  Rows rows(rig.layout());
  const auto count = static_cast<std::size_t>(std::llround(LimitedCorner::kLasts / c.p.tick));
  for (std::size_t k = 0; k <= count; ++k) {
    rig.step(c.p, {{c.hand(static_cast<double>(k) * c.p.tick), 1}}, rows.add());
  }
  CornerOutcome outcome;
  double energy = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::VectorXd dx1 =
        rows.vec(k + 1, Column::device_position) - rows.vec(k, Column::device_position);
    const Eigen::VectorXd dx2 =
        rows.vec(k + 1, Column::proxy_position) - rows.vec(k, Column::proxy_position);
    const Eigen::VectorXd tau1 = rows.vec(k, Column::motor_torque);
    energy += tau1.dot(dx1) + rows.vec(k, Column::proxy_torque).dot(dx2);
    for (Eigen::Index i = 0; i < dx1.size(); ++i) {
      energy -= c.arm.joints[static_cast<std::size_t>(i)].damping * dx1[i] * dx1[i] / c.p.tick;
    }
    outcome.energy = std::max(outcome.energy, energy);
    outcome.torque = std::max(outcome.torque,
                              rows.vec(k, Column::contact_torque).cwiseAbs().maxCoeff() / c.limit);
    outcome.jump = std::max(outcome.jump, dx2.cwiseAbs().maxCoeff());
    outcome.reserve = std::min(outcome.reserve, rows.at(k, Column::energy_ledger));
    outcome.port = std::max(outcome.port, rows.at(k, Column::energy_port));
    outcome.limited += (tau1.cwiseAbs().array() >= c.limit).any();
  }
  outcome.unsettled = static_cast<int>(rows.at(count, Column::unsettled));
  outcome.ticks = static_cast<int>(count);
  return outcome;
}

struct WorstCorner {
  CornerOutcome of;  // worst of each value
  int over_energy = 0, over_torque = 0, over_jump = 0, below = 0, limited_runs = 0;

  void add(unsigned seed, const CornerOutcome& o) {
    const auto tell = [&](const char* what, double value) {
      std::printf("seed %u: %s %.4g\n", seed, what, value);
    };
    if (o.energy > 0.05e-3) ++over_energy, tell("E_c [mJ]", 1e3 * o.energy);
    if (o.torque > 1.3) ++over_torque, tell("f2 over the limit", o.torque);
    if (o.jump > 0.01) ++over_jump, tell("proxy [mrad]", 1e3 * o.jump);
    if (o.reserve < 0) ++below, tell("reserve [mJ]", 1e3 * o.reserve);
    limited_runs += o.limited > 0;
    of.energy = std::max(of.energy, o.energy);
    of.torque = std::max(of.torque, o.torque);
    of.jump = std::max(of.jump, o.jump);
    of.reserve = std::min(of.reserve, o.reserve);
    of.port = std::max(of.port, o.port);
    of.limited += o.limited;
    of.unsettled += o.unsettled;
    of.ticks += o.ticks;
  }
  void print() const {
    std::printf(
        "E_c %.4f mJ, f2 %.3f limits, proxy %.2f mrad a tick, reserve %.2f mJ, port %.4f mJ; %d of "
        "%d ticks limited, %d without a solution\n",
        1e3 * of.energy, of.torque, 1e3 * of.jump, 1e3 * of.reserve, 1e3 * of.port, of.limited,
        of.ticks, of.unsettled);
  }
};

TEST(MotorsAtTheirLimit, BetweenWallsGiveNoEnergyAndLetTheProxyNotJump) {
  WorstCorner worst;
  for (unsigned seed = 0; seed < 300; ++seed) worst.add(seed, run_corner(random_corner(seed, {})));
  worst.print();
  EXPECT_GT(worst.limited_runs, 150);
  EXPECT_EQ(worst.over_energy, 0);
  EXPECT_EQ(worst.over_torque, 0);
  EXPECT_EQ(worst.over_jump, 0);
  EXPECT_EQ(worst.below, 0);
  EXPECT_LE(worst.of.port, 0.05e-3);
  EXPECT_LE(worst.of.unsettled, 1e-4 * worst.of.limited);
}

// Random arms, with more walls, more friction and other eta.
TEST(MotorsAtTheirLimit, OfOtherArmsInMoreWallsGiveNoEnergyEither) {
  WorstCorner worst;
  for (unsigned seed = 1000; seed < 1150; ++seed)
    worst.add(seed, run_corner(random_corner(seed, kWideCorners)));
  worst.print();
  EXPECT_GT(worst.limited_runs, 50);
  EXPECT_EQ(worst.over_energy, 0);
  EXPECT_LE(worst.of.torque, 1.6);
  EXPECT_EQ(worst.over_jump, 0);
  EXPECT_EQ(worst.below, 0);
  EXPECT_LE(worst.of.port, 0.05e-3);
}

}  // namespace
}  // namespace limpid
