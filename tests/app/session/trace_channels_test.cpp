#include "app/session/trace_channels.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/devices/files/session/sample_session.h"
#include "tests/support/built_in.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

class TraceChannelsOfJoints : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Arms, TraceChannelsOfJoints, testing::Values(1, 2, 3, 7, 32));

TEST_P(TraceChannelsOfJoints, AreTheQuantitiesOfTheRow) {
  const int n = GetParam();
  const RowLayout layout(n);
  const TraceChannels channels(layout);
  ASSERT_EQ(channels.count(), 8 + n);
  test::Rows rows(layout);
  rows.add(test::sample_rows(layout, 5, 1));
  std::vector<double> values(static_cast<std::size_t>(channels.count()));
  channels.values(rows.row(0), values);
  const auto value = [&](Channel c) { return values[static_cast<std::size_t>(c)]; };
  const Eigen::VectorXd x_E =
      rows.vec(0, Column::device_position) - rows.vec(0, Column::proxy_position);
  EXPECT_EQ(value(Channel::kind), rows.at(0, Column::kind));
  EXPECT_NEAR(value(Channel::error), x_E.norm(), 1e-12 * (1 + x_E.norm()));
  EXPECT_EQ(value(Channel::energy_total), rows.at(0, Column::energy_total));
  EXPECT_EQ(value(Channel::energy_commanded), rows.at(0, Column::energy_commanded));
  const auto expect_norm = [&](Channel c, Column column) {
    const double norm = rows.vec(0, column).norm();
    EXPECT_NEAR(value(c), norm, 1e-12 * (1 + norm));
  };
  expect_norm(Channel::human, Column::hand_torque);
  expect_norm(Channel::human_estimate, Column::hand_torque_estimate);
  expect_norm(Channel::contact, Column::contact_torque);
  for (int j = 0; j < n; ++j) {
    EXPECT_EQ(values[static_cast<std::size_t>(Channel::joints) + static_cast<std::size_t>(j)],
              x_E[j]);
  }
}

// Asked for more than it can give, by the limits of the arm or by the parameters' own.
TEST(TraceChannels, SayWhichMotorGivesAllItCan) {
  const ArmDescription arm = test::omni();
  Parameters p;
  const double effort = arm.joints[1].effort;
  EXPECT_EQ(motor_limits(arm, p)[1], effort);
  p.torque_limit = 0.2;
  TraceChannels channels{RowLayout(3)};
  const RowLayout& layout = channels.layout();
  std::vector<double> row(static_cast<std::size_t>(layout.stride()), 0.0);
  layout.in(std::span(row), Column::commanded_torque)[1] = -0.5;
  layout.in(std::span(row), Column::motor_torque)[1] = -0.2;
  EXPECT_FALSE(channels.limited(row, 1)) << "no limit is known yet";
  channels.set_limits(motor_limits(arm, p));
  EXPECT_TRUE(channels.limited(row, 1));
  EXPECT_FALSE(channels.limited(row, 0));
  layout.in(std::span(row), Column::motor_torque)[1] = -0.1;  // on its way there, or fading
  EXPECT_FALSE(channels.limited(row, 1));
  layout.in(std::span(row), Column::motor_torque)[1] = 0;  // force off
  EXPECT_FALSE(channels.limited(row, 1));
}

// Of two runs in one plot no two curves look alike.
TEST(TraceChannels, AreToldApartByTheirColours) {
  const TraceChannels channels{RowLayout(7)};
  for (const Palette* palette : {&kDarkPalette, &kLightPalette}) {
    for (const PlotSpec& plot : channels.plots({"", "re-run"})) {
      std::vector<Rgb> seen;
      for (const Curve& curve : plot.curves) {
        const Rgb rgb = ink(*palette, curve.ink, curve.shade);
        for (const Rgb other : seen) {
          const int apart =
              std::abs(rgb.r - other.r) + std::abs(rgb.g - other.g) + std::abs(rgb.b - other.b);
          EXPECT_GT(apart, 40) << plot.title << ": " << curve.label;
        }
        seen.push_back(rgb);
      }
    }
  }
}

TEST_P(TraceChannelsOfJoints, ArePlottedOnlyWhereTheyExist) {
  const TraceChannels channels{RowLayout(GetParam())};
  for (const bool rerun : {false, true}) {
    const auto plots = channels.plots(rerun ? RunNames{"", "re-run"} : RunNames{});
    ASSERT_EQ(plots.size(), 3u);
    for (const PlotSpec& plot : plots) {
      EXPECT_FALSE(plot.title.empty());
      EXPECT_FALSE(plot.curves.empty());
      for (const Curve& curve : plot.curves) {
        EXPECT_GE(curve.channel, 0);
        EXPECT_LT(curve.channel, (rerun ? 2 : 1) * channels.count());
      }
    }
  }
}

}  // namespace
}  // namespace limpid
