// The predictive law in the tick: its ledger, computed from the rows alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/tick/tick.h"
#include "tests/support/random_arm.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

using test::random_arm;
using test::Rows;

// Path of a device that is led back and forth whatever its motors do, at times fast, at times
// slowly.
Eigen::VectorXd led(std::size_t k, double T) {
  const double t = static_cast<double>(k) * T;
  const double swing = 0.2 * std::sin(2 * t) + 0.02 * std::sin(40 * t) * std::sin(0.9 * t);
  return Vec3(0.4 + swing, 0.7 - 0.7 * swing + 0.01 * std::sin(70 * t), 1 + 0.4 * swing);
}

struct LedTick {
  int delay;     // known delay from command to motor [ticks]
  bool guarded;  // a real device, with a hand on it
};

class LedgerOf : public testing::TestWithParam<LedTick> {};
INSTANTIATE_TEST_SUITE_P(Devices, LedgerOf,
                         testing::Values(LedTick{0, false}, LedTick{3, false}, LedTick{0, true},
                                         LedTick{1, true}, LedTick{3, true}));

// H = E - stored. E begins with E0 and the stored energy. It loses the work of the acting torque,
// which is as old as the delay, and gains the work of the device's damping, which is not certain on
// a real device. At most 20 mJ are kept. At eta 1 only spring and proxy store energy.
TEST_P(LedgerOf, TheTickIsThatOfTheTorqueThatActedAndOfTheDampingThatIsSure) {
  constexpr double kDamping = 0.02, kCap = 0.02;
  const auto [delay, guarded] = GetParam();
  const ArmDescription arm = random_arm(3, 140);
  Parameters p;
  p.kind = CouplingKind::predictive;
  p.damping = kDamping;
  p.delay = delay;
  p.delay_most = delay;
  p.inertia_ratio = 0.05;
  Tick<3> tick(arm, Scene{});
  tick.start(p, Start<3>::at_rest(led(0, p.tick)));
  Rows rows(tick.layout());
  for (std::size_t k = 0; k < 4000; ++k) {
    const Vec<3> x = led(k, p.tick);
    tick.run(p, {x, x, Vec<3>::Zero(), {.guarded = guarded}}, ForceRequest::as_it_is, rows.add());
  }
  const auto stored = [&](std::size_t k) {
    const Eigen::VectorXd apart =
        rows.vec(k, Column::measured_position) - rows.vec(k, Column::proxy_position);
    double sum = rows.at(k, Column::proxy_kinetic);
    for (int i = 0; i < 3; ++i) {
      const double limit = arm.joints[static_cast<std::size_t>(i)].effort;
      const double a = std::abs(apart[i]), bend = std::min(a, limit / p.k_vc);
      sum += p.k_vc * bend * bend / 2 + limit * (a - bend);
    }
    return sum;
  };
  double E = p.energy + stored(0), least = 1, most = 0, worked = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (k > 0) {
      const Eigen::VectorXd dx = led(k, p.tick) - led(k - 1, p.tick);
      const auto sent = static_cast<std::size_t>(1 + delay);
      const Eigen::VectorXd acted = k >= sent ? rows.vec(k - sent, Column::motor_torque)
                                              : Eigen::VectorXd(Eigen::VectorXd::Zero(3));
      E -= acted.dot(dx);
      worked += std::abs(acted.dot(dx));
      if (!guarded) E += kDamping / p.tick * dx.squaredNorm();
    }
    E -= std::max(0.0, E - stored(k) - kCap);
    ASSERT_NEAR(rows.at(k, Column::energy_ledger), E - stored(k), 1e-9) << k;
    least = std::min(least, E - stored(k));
    most = std::max(most, E - stored(k));
  }
  EXPECT_GT(worked, 0.02);
  EXPECT_GT(most - least, 1e-3);
}

}  // namespace
}  // namespace limpid
