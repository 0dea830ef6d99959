#include "app/run/energy_shares.h"

#include <gtest/gtest.h>

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
  shares.take(0, -1, false);
  expect(-1, 0, 0, 0);
  shares.take(0.1, 2, false);
  expect(2, 0, 0, 0);
  shares.change(0.1);
  expect(0, 0, 0, 2);
  shares.take(0.2, 1, false);
  expect(-1, 0, 0, 2);
  shares.take(0.3, 3, false);
  expect(0, 1, 0, 2);
  shares.take(0.4, 5, true);
  expect(0, 3, 0, 2);
  shares.take(0.401, 6, true);
  expect(0, 3, 1, 2);
  shares.take(0.5, 4, false);
  expect(-2, 3, 1, 2);
  shares.take(0.6, 5, true);
  expect(-2, 3, 2, 2);
  shares.forget();
  shares.take(0.7, 0.25, false);
  expect(0.25, 0, 0, 0);
}

}  // namespace
}  // namespace limpid
