#include "app/session/trace_channels.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/devices/files/session/sample_session.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

class TraceChannelsOfJoints : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Arms, TraceChannelsOfJoints, testing::Values(1, 2, 3, 7, 32));

TEST_P(TraceChannelsOfJoints, AreTheQuantitiesOfTheRow) {
  const int n = GetParam();
  const RowLayout layout(n);
  const TraceChannels channels(layout);
  ASSERT_EQ(channels.count(), 7 + n);
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

TEST_P(TraceChannelsOfJoints, ArePlottedOnlyWhereTheyExist) {
  const TraceChannels channels{RowLayout(GetParam())};
  for (const bool rerun : {false, true}) {
    const auto plots = channels.plots(rerun);
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
