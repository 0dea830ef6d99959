#include <gmock/gmock.h>

#include <cmath>

#include "app/experiments/signals.h"

namespace limpid {
namespace {

Session ramp(std::size_t rows) {
  Session s;
  const auto stride = static_cast<std::size_t>(s.layout.stride());
  s.rows.resize(rows * stride);
  for (std::size_t k = 0; k < rows; ++k) {
    const auto row = std::span(s.rows).subspan(k * stride, stride);
    s.layout.in(row, Column::time)[0] = 0.001 * static_cast<double>(k);
    const auto x1 = s.layout.in(row, Column::device_position);
    const auto x2 = s.layout.in(row, Column::proxy_position);
    for (std::size_t i = 0; i < 3; ++i) {
      x1[i] = static_cast<double>(k + i);
      x2[i] = static_cast<double>(k);
    }
  }
  return s;
}

TEST(Series, SlopeOfALineThroughTheOriginIsExact) {
  EXPECT_DOUBLE_EQ(slope_through_origin({{1, 0.1}, {2, 0.2}, {-4, -0.4}}), 0.1);
}

// Minimum of sum (y - a x)^2: a = (1*1 + 2*1) / (1 + 4).
TEST(Series, SlopeIsTheLeastSquaresOne) {
  EXPECT_DOUBLE_EQ(slope_through_origin({{1, 1}, {2, 1}}), 0.6);
}

TEST(Series, SlopeOfNothingIsZero) {
  EXPECT_EQ(slope_through_origin({}), 0);
  EXPECT_EQ(slope_through_origin({{0, 3}}), 0);
}

TEST(Series, CoordinationErrorIsDeviceLessProxy) {
  EXPECT_EQ(coordination_error(ramp(5), 2), Eigen::Vector3d(0, 1, 2));
}

TEST(Series, RootMeanSquareCountsTheRowsAskedFor) {
  const Session s = ramp(5);  // squared norms of x2: 3 k^2
  EXPECT_DOUBLE_EQ(rms_norm(s, Column::proxy_position, 1, 3), std::sqrt((3.0 + 12.0) / 2));
}

TEST(Series, OverTimeThinsEvenlyAndStartsAtTheFirstRow) {
  const Session s = ramp(1000);
  const Series all = over_time(
      s, "", "#000000", Series::Style::line, [](std::size_t k) { return static_cast<double>(k); },
      100);
  ASSERT_EQ(all.points.size(), 100u);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(all.points[i].y, static_cast<double>(10 * i));
    EXPECT_EQ(all.points[i].x, s.at(10 * i, Column::time)[0]);
  }
}

}  // namespace
}  // namespace limpid
