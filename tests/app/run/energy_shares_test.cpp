#include "app/run/energy_shares.h"

#include <gtest/gtest.h>

#include "tests/support/built_in.h"

namespace limpid {
namespace {

class MotorsAtTheirLimit : public testing::Test {
 protected:
  // A row whose middle motor gives `given` where law and compensation ask for two parts.
  bool at(int joint, double given, double commanded, double compensation = 0) {
    std::vector<double> row(static_cast<std::size_t>(layout_.stride()));
    layout_.in(std::span(row), Column::motor_torque)[1] = given;
    layout_.in(std::span(row), Column::commanded_torque)[1] = commanded;
    layout_.in(std::span(row), Column::compensation_torque)[1] = compensation;
    EXPECT_EQ(any_at_limit(layout_, row, limits_), at_limit(layout_, row, limits_, 1));
    return at_limit(layout_, row, limits_, joint);
  }

  const RowLayout layout_{3};
  std::vector<double> limits_{0.1, 0.5, 2};
};

TEST_F(MotorsAtTheirLimit, AreThoseThatGiveTheirLimitAndAreAskedForIt) {
  EXPECT_TRUE(at(1, 0.5, 0.7));
  EXPECT_TRUE(at(1, -0.5, -0.7)) << "either way";
  EXPECT_TRUE(at(1, 0.5, 0.5)) << "a law that knows the limit asks for no more";
  EXPECT_TRUE(at(1, 0.5, 0.3, 0.3)) << "with the compensation";
  EXPECT_FALSE(at(1, 0.49, 0.7));
  EXPECT_FALSE(at(1, 0.5, 0.3, -0.3));
  EXPECT_FALSE(at(0, 0.5, 0.7)) << "another joint";
  EXPECT_FALSE(at(2, 0.5, 0.7));
}

TEST_F(MotorsAtTheirLimit, AreNoneWithoutLimits) {
  limits_.clear();
  EXPECT_FALSE(at(1, 0.5, 0.7));
}

TEST(MotorLimits, AreTheArmsOwnUnlessOthersAreSet) {
  const ArmDescription arm = test::omni();
  Parameters p;
  const std::vector<double> own = motor_limits(arm, p);
  ASSERT_EQ(own.size(), arm.joints.size());
  for (std::size_t i = 0; i < own.size(); ++i) EXPECT_EQ(own[i], arm.joints[i].effort);
  p.torque_limit = 0.25;
  EXPECT_EQ(motor_limits(arm, p), std::vector<double>(arm.joints.size(), 0.25));
}

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
