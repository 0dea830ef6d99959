#include "app/run/energy_shares.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

namespace limpid {
namespace {

// The gain of E_c within 0.3 s after a change is the person's, and that while a motor is at its
// limit is the limit's; a fall is nobody's.
TEST(EnergySharesOfARun, AddUpToItsEnergy) {
  EnergyShares shares;
  const auto expect = [&](double own, double changes, double limits, double forgiven) {
    EXPECT_NEAR(shares.own(), own, 1e-12);
    EXPECT_NEAR(shares.by_changes(), changes, 1e-12);
    EXPECT_NEAR(shares.by_limits(), limits, 1e-12);
    EXPECT_NEAR(shares.forgiven(), forgiven, 1e-12);
    EXPECT_NEAR(shares.own() + shares.by_changes() + shares.by_limits() + shares.forgiven(),
                shares.total(), 1e-12);
    EXPECT_NEAR(shares.without_limits(), shares.own() + shares.by_limits(), 1e-12);
  };
  shares.take(0, -1, 0, false);
  expect(-1, 0, 0, 0);
  shares.take(0.1, 2, 0, false);
  expect(2, 0, 0, 0);
  shares.change(0.1);
  expect(0, 0, 0, 2);
  shares.take(0.2, 1, 0, false);
  expect(-1, 0, 0, 2);
  shares.take(0.3, 3, 0, false);
  expect(0, 1, 0, 2);
  shares.take(0.4, 5, 0, true);
  expect(0, 3, 0, 2);
  shares.take(0.401, 6, 0, true);
  expect(0, 3, 1, 2);
  shares.take(0.5, 4, 0, false);
  expect(-2, 3, 1, 2);
  shares.take(0.6, 5, 0, true);
  expect(-2, 3, 2, 2);
  shares.begin(0);
  shares.take(0.7, 0.25, 0, false);
  expect(0.25, 0, 0, 0);
}

// The work of torque that the motors do not give is apart, whenever it is done, and of either sign.
TEST(EnergySharesOfARun, LeaveOutWhatTheMotorsWithhold) {
  EnergyShares shares;
  shares.begin(0);
  shares.take(1, 0.3, 0.35, false);
  EXPECT_NEAR(shares.own(), -0.05, 1e-12);
  EXPECT_NEAR(shares.by_limits(), 0.35, 1e-12);
  shares.take(2, 0.1, -0.1, false);
  EXPECT_NEAR(shares.own(), 0.2, 1e-12);
  shares.change(2);
  shares.take(2.1, 0.5, 0.1, false);
  EXPECT_NEAR(shares.by_changes(), 0.2, 1e-12) << "of 0.4, the motors withheld 0.2";
  EXPECT_NEAR(shares.own(), 0, 1e-12);
}

// Torque is held over the tick after its row.
TEST(EnergySharesOfARun, KnowTheWorkThatMotorsWithhold) {
  const RowLayout layout(3);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  WithheldEnergy withheld;
  std::vector<double> row(static_cast<std::size_t>(layout.stride()), 0.0), before = row;
  double sum = 0;
  for (int k = 0; k < 50; ++k) {
    before = row;
    for (const Column each : {Column::device_position, Column::motor_torque,
                              Column::commanded_torque, Column::compensation_torque}) {
      for (double& x : layout.in(std::span(row), each)) x = any(random);
    }
    for (std::size_t j = 0; k > 0 && j < 3; ++j) {
      const auto was = [&](Column each) { return layout.in(std::span(before), each)[j]; };
      const double moved =
          layout.in(std::span(row), Column::device_position)[j] - was(Column::device_position);
      sum += (was(Column::motor_torque) - was(Column::commanded_torque) -
              was(Column::compensation_torque)) *
             moved;
    }
    EXPECT_NEAR(withheld.add(layout, row), sum, 1e-13) << k;
  }
  withheld.begin();
  EXPECT_EQ(withheld.add(layout, row), 0);
}

// A run that begins with a stretched spring may give back what the spring holds, and no more.
TEST(EnergySharesOfARun, LetTheSpringGiveBackWhatItHeldAtTheStart) {
  EnergyShares shares;
  shares.begin(0.02);
  shares.take(0, 0, 0, false);
  EXPECT_NEAR(shares.own(), -0.02, 1e-12);
  shares.take(1, 0.02, 0, false);
  EXPECT_NEAR(shares.own(), 0, 1e-12);
  shares.take(2, 0.03, 0, false);
  EXPECT_NEAR(shares.own(), 0.01, 1e-12);
  EXPECT_NEAR(shares.without_limits(), 0.01, 1e-12);
  EXPECT_EQ(shares.stored(), 0.02);
}

// The spring of both sides: k x_E pulls the device back, with the energy k x_E^2 / 2.
TEST(EnergySharesOfARun, KnowWhatTheSpringHolds) {
  const RowLayout layout(3);
  std::vector<double> row(static_cast<std::size_t>(layout.stride()), 0.0);
  constexpr double kSpring = 17;
  const std::array<double, 3> x1{0.3, -0.2, 1.1}, x2{0.25, 0.1, 1.05};
  double held = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    layout.in(std::span(row), Column::device_position)[j] = x1[j];
    layout.in(std::span(row), Column::proxy_position)[j] = x2[j];
    layout.in(std::span(row), Column::commanded_torque)[j] = -kSpring * (x1[j] - x2[j]);
    held += 0.5 * kSpring * (x1[j] - x2[j]) * (x1[j] - x2[j]);
  }
  EXPECT_NEAR(spring_energy(layout, row), held, 1e-15);
}

}  // namespace
}  // namespace limpid
