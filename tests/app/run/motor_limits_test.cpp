#include "app/run/motor_limits.h"

#include <gtest/gtest.h>

#include <cmath>

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
    layout_.in(std::span(row), Column::motor_warmth)[1] = warmth_;
    EXPECT_EQ(any_at_limit(layout_, row, limits_), at_limit(layout_, row, limits_, 1));
    return at_limit(layout_, row, limits_, joint);
  }

  const RowLayout layout_{3};
  double warmth_ = 0;
  std::vector<MotorLimit> limits_{{0.1}, {0.5}, {2}};
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

// At a warmth of 0.75 half of what is between the squares is left: 0.5 and 0.1 N m leave
// sqrt((0.25 + 0.01) / 2) N m.
TEST_F(MotorsAtTheirLimit, GiveLessWhereTheyAreWarm) {
  const double left = std::sqrt(0.13);
  limits_[1].continuous = 0.1;
  EXPECT_FALSE(at(1, left, left)) << "cold";
  warmth_ = 0.75;
  EXPECT_TRUE(at(1, left, left));
  EXPECT_FALSE(at(1, 0.99 * left, 0.99 * left));
  limits_[1].continuous = 0;
  EXPECT_FALSE(at(1, left, left)) << "nobody knows what the motor bears";
}

TEST_F(MotorsAtTheirLimit, AreNoneWithoutLimits) {
  limits_.clear();
  EXPECT_FALSE(at(1, 0.5, 0.7));
}

TEST(MotorLimits, AreTheArmsOwnUnlessOthersAreSet) {
  const ArmDescription arm = test::omni();
  Parameters p;
  const std::vector<MotorLimit> own = motor_limits(arm, p);
  ASSERT_EQ(own.size(), arm.joints.size());
  for (std::size_t i = 0; i < own.size(); ++i) EXPECT_EQ(own[i].peak, arm.joints[i].effort);
  p.torque_limit = 0.25;
  EXPECT_EQ(motor_limits(arm, p), std::vector<MotorLimit>(arm.joints.size(), {0.25}));
}

TEST(WarmMotors, AreSaidWithTheTorqueThatTheyAreLeft) {
  ArmDescription arm = test::omni();
  arm.joints[1].effort = 0.5;
  arm.joints[1].continuous = 0.1;
  const RowLayout layout(3);
  std::vector<double> row(static_cast<std::size_t>(layout.stride()));
  const auto warmth = layout.in(std::span(row), Column::motor_warmth);
  EXPECT_EQ(warm_text(arm, {}, layout, row), "");
  warmth[1] = 0.75;
  EXPECT_EQ(warm_text(arm, {}, layout, row),
            "The motors are warm: joint " + arm.joints[1].name + " gives at most 0.36 of 0.5 N m.");
  arm.joints[1].kind = Joint::Kind::prismatic;
  EXPECT_EQ(warm_text(arm, {}, layout, row),
            "The motors are warm: joint " + arm.joints[1].name + " gives at most 3.6 of 5 N.");
  warmth[1] = 0.5;
  EXPECT_EQ(warm_text(arm, {}, layout, row), "");
  warmth[0] = 1;
  EXPECT_EQ(warm_text(arm, {}, layout, row), "") << "no model of this motor";
}

}  // namespace
}  // namespace limpid
