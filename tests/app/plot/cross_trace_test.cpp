// Curves over another channel and over frequency.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "app/plot/trace.h"
#include "tests/support/tick.h"

namespace limpid {
namespace {

using test::T;

// x = cos, y = sin: a circle of radius 1, once a second.
History circle(int rows) {
  History history({.channels = 2, .seconds = 20});
  for (int i = 0; i < rows; ++i) {
    const double turn = 2 * std::numbers::pi * i * T;
    history.append(i * T, std::array{std::cos(turn), std::sin(turn)});
  }
  return history;
}

const Curve kCurve{.channel = 1, .across = 0};
constexpr TraceArea kArea{{{-1, 1}}, {{-1, 1}}, 200, 100};

Trace cross(const History& history) {
  Trace trace;
  make_cross_trace(history, kCurve, history.first(), history.end(), kArea, trace);
  return trace;
}

TEST(CrossTrace, IsOneChannelOverAnother) {
  const Trace trace = cross(circle(1000));
  ASSERT_EQ(trace.runs.size(), 1u);
  EXPECT_TRUE(trace.wanders);
  EXPECT_LT(trace.points.size(), 1000u) << "what falls on the same pixel is one point";
  EXPECT_GT(trace.points.size(), 100u);
  for (const TracePoint& p : trace.points) {
    const double x = static_cast<double>(p.x) / 100 - 1;  // 200 pixels from -1 to 1
    EXPECT_NEAR(x * x + static_cast<double>(p.low) * static_cast<double>(p.low), 1, 1e-5);
    EXPECT_EQ(p.low, p.high);
  }
}

TEST(CrossTrace, StandsStillAsOnePoint) {
  History history({.channels = 2});
  for (int i = 0; i < 100; ++i) history.append(i * T, std::array{0.25, 0.5});
  EXPECT_EQ(cross(history).points.size(), 1u);
}

TEST(CrossTrace, EndsARunWhereEitherChannelOrARowIsMissing) {
  for (const int missing : {0, 1, 2}) {
    History history({.channels = 2});
    for (int i = 0; i < 100; ++i) {
      const bool gone = i >= 40 && i < 45;
      if (gone && missing == 2) continue;
      const double x = gone && missing == 0 ? std::nan("") : i * 0.01;
      const double y = gone && missing == 1 ? std::nan("") : -i * 0.01;
      history.append(i * T, std::array{x, y});
    }
    EXPECT_EQ(cross(history).runs.size(), 2u) << missing;
  }
}

TEST(Spectrum, OfAHistoryHasTheSineAtItsPixel) {
  History history({.channels = 1, .seconds = 20});
  for (int i = 0; i < 8000; ++i) {
    history.append(i * T, std::array{0.02 * std::sin(2 * std::numbers::pi * 50 * i * T)});
  }
  const AmplitudeSpectrum s = spectrum_between(history, 0, 0, 8);
  EXPECT_DOUBLE_EQ(s.step, 0.25);
  EXPECT_NEAR(s.amplitude[200], 0.02, 1e-7);
  Trace trace;
  const TraceArea area{{{-1, 3}, true}, {{-6, 0}, true}, 400, 100};  // 0.1 to 1000 Hz
  make_spectrum_trace(s, area, trace);
  ASSERT_EQ(trace.runs.size(), 1u);
  const auto peak = std::ranges::max_element(trace.points, {}, &TracePoint::high);
  EXPECT_NEAR(peak->high, 0.02, 1e-6) << "the peak is not lost among those on its pixel";
  EXPECT_NEAR(peak->x, 100 * (std::log10(50) + 1), 1e-3);
  for (std::size_t i = 1; i < trace.points.size(); ++i) {
    EXPECT_GT(trace.points[i].x, trace.points[i - 1].x);
  }
}

// Rows before and after a new start are not one signal.
TEST(Spectrum, IsOfTheLongestPartWithoutAGap) {
  History history({.channels = 1, .seconds = 20});
  for (int i = 0; i < 1000; ++i) history.append(i * T, std::array{5.0});
  for (int i = 0; i < 4000; ++i) {
    history.append(i * T, std::array{std::sin(2 * std::numbers::pi * 50 * i * T)});
  }
  const AmplitudeSpectrum s = spectrum_between(history, 0, 0, 100);
  EXPECT_DOUBLE_EQ(s.step, 0.5);
  EXPECT_NEAR(s.amplitude[100], 1, 1e-5);
  EXPECT_NEAR(s.amplitude[3], 0, 1e-5) << "the step between the two runs";
  EXPECT_TRUE(spectrum_between(history, 0, 50, 100).empty());
}

TEST(AxisMap, IsItsOwnInverse) {
  for (const AxisMap map : {AxisMap{{-3, 5}}, AxisMap{{-2, 3}, true}}) {
    for (const double value : {0.01, 0.5, 3.0})
      EXPECT_NEAR(map.value(map.part(value)), value, 1e-12);
  }
  const AxisMap decades{{0, 2}, true};
  EXPECT_DOUBLE_EQ(decades.part(10), 0.5);
  EXPECT_LT(decades.part(0), -10) << "far below, and a number";
}

}  // namespace
}  // namespace limpid
