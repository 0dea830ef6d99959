#include "app/plot/trace.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/support/tick.h"

namespace limpid {
namespace {

using test::T;

Trace trace_of(const History& history, const Curve& curve, const PixelWindow& window) {
  std::vector<SampleIndex> rows;
  pixel_rows(history, window, rows);
  Trace trace;
  make_trace(history, curve, window, rows, trace);
  return trace;
}

TEST(Trace, WindowsEndWithinAPixelAndKeepTheirGridWhenTheyMove) {
  const PixelWindow a = pixel_window(12.3456, 10, 400);
  const PixelWindow b = pixel_window(12.5, 10, 400);
  EXPECT_NEAR(a.stop(), 12.3456, a.per_pixel);
  EXPECT_GE(a.stop(), 12.3456);
  const double pixels = (b.start() - a.start()) / a.per_pixel;
  EXPECT_NEAR(pixels, std::round(pixels), 1e-6);
  EXPECT_NEAR(a.time(a.pixel(7.7)), 7.7, 1e-9);
}

TEST(Trace, BandsHoldEverySampleOfTheirPixel) {
  History history({.seconds = 20});
  std::mt19937 random(1);
  std::normal_distribution<double> noise;
  for (int i = 0; i < 20000; ++i) history.append(i * T, std::array{noise(random)});
  const PixelWindow window = pixel_window(19, 15, 333);
  const Trace trace = trace_of(history, {.channel = 0}, window);
  ASSERT_TRUE(trace.band);
  ASSERT_EQ(trace.runs.size(), 1u);
  ASSERT_EQ(trace.points.size(), 333u);
  for (SampleIndex row = 0; row < history.end(); ++row) {
    const double x = std::floor(window.pixel(history.time(row)) + 1e-9);
    if (x < 1 || x >= 332) continue;
    // Neighbours count for times on the border of two pixels.
    const auto at = static_cast<std::size_t>(x);
    bool inside = false;
    for (std::size_t i = at - 1; i <= at + 1; ++i) {
      const float value = history.value(0, row);
      inside = inside || (value >= trace.points[i].low && value <= trace.points[i].high);
    }
    EXPECT_TRUE(inside) << row;
  }
}

TEST(Trace, NeighbouringBandsTouchHoweverSteepTheSignal) {
  History history({.seconds = 20});
  for (int i = 0; i < 20000; ++i) {
    history.append(i * T, std::array{(i / 700) % 2 == 0 ? 0.0 : 1.0});
  }
  const Trace trace = trace_of(history, {.channel = 0}, pixel_window(20, 20, 500));
  for (std::size_t i = 1; i < trace.points.size(); ++i) {
    EXPECT_LE(trace.points[i].low, trace.points[i - 1].high);
    EXPECT_GE(trace.points[i].high, trace.points[i - 1].low);
  }
}

TEST(Trace, AGapEndsARunInBothKindsOfTraces) {
  History history({.seconds = 20});
  for (int i = 0; i < 10000; ++i) {
    if (i < 4000 || i >= 5000) history.append(i * T, std::array{1.0});
  }
  EXPECT_EQ(trace_of(history, {.channel = 0}, pixel_window(10, 10, 500)).runs.size(), 2u);
  const Trace close = trace_of(history, {.channel = 0}, pixel_window(5.1, 1.2, 4000));
  EXPECT_FALSE(close.band);
  EXPECT_EQ(close.runs.size(), 2u);
}

TEST(Trace, MissingValuesAreAGapOfTheirCurveAlone) {
  History history({.channels = 2, .seconds = 20});
  for (int i = 0; i < 10000; ++i) {
    const bool missing = i >= 4000 && i < 5000;
    history.append(i * T, std::array{missing ? std::nan("") : 1.0, 2.0});
  }
  EXPECT_EQ(trace_of(history, {.channel = 0}, pixel_window(10, 10, 500)).runs.size(), 2u);
  EXPECT_EQ(trace_of(history, {.channel = 1}, pixel_window(10, 10, 500)).runs.size(), 1u);
}

// A ramp of 2 s, of which law 0 made the first half and law 2 the rest.
History switched() {
  History history({.channels = 3, .seconds = 5});
  for (int i = 0; i < 2000; ++i)
    history.append(i * T, std::array{i * T, i < 1000 ? 0.0 : 2.0, 1.0});
  return history;
}

// Parts of a curve belong to the law that made them, and meet where the law changed.
TEST(Trace, KeepsTheLawThatMadeEachPart) {
  const History history = switched();
  const Curve curve{.channel = 0, .law_channel = 1};
  for (const int pixels : {200, 4000}) {
    const PixelWindow window = pixel_window(2, 2, pixels);
    const Trace trace = trace_of(history, curve, window);
    EXPECT_EQ(trace.band, pixels == 200);
    ASSERT_EQ(trace.runs.size(), 2u);
    EXPECT_EQ(trace.runs[0].law, 0);
    EXPECT_EQ(trace.runs[1].law, 2);
    const TracePoint& end = trace.points[trace.runs[0].count - 1];
    const TracePoint& start = trace.points[trace.runs[1].first];
    EXPECT_EQ(end.x, start.x);
    EXPECT_EQ(end.high, start.high);
    EXPECT_NEAR(window.time(static_cast<double>(start.x)), 1, 2 * window.per_pixel + T);
  }
  EXPECT_EQ(trace_of(history, {.channel = 0}, pixel_window(2, 2, 200)).runs.size(), 1u)
      << "a curve that does not ask";
}

TEST(Trace, OverAnotherChannelKeepsItsLaws) {
  const History history = switched();
  Trace trace;
  make_cross_trace(history, {.channel = 0, .across = 2, .law_channel = 1}, 0, history.end(),
                   {{{0, 2}}, {{0, 2}}, 100, 100}, trace);
  ASSERT_EQ(trace.runs.size(), 2u);
  EXPECT_EQ(trace.runs[1].law, 2);
}

TEST(Trace, AnEmptyHistoryLeavesNoTrace) {
  const History history({.channels = 1});
  EXPECT_TRUE(trace_of(history, {.channel = 0}, pixel_window(10, 10, 100)).runs.empty());
}

// A row more on either side lets the line go on to the edge of its window.
TEST(Trace, OfSamplesReachesBeyondBothEdges) {
  History history({.channels = 2, .seconds = 20});
  for (int i = 0; i < 100; ++i) {
    history.append(i * T, std::array{0.5 * i, i == 30 ? std::nan("") : 1.0});
  }
  const PixelWindow window{1e-4, 205, 300};  // from 20.5 to 50.5 ms
  const Trace trace = trace_of(history, {.channel = 0}, window);
  EXPECT_FALSE(trace.band);
  ASSERT_EQ(trace.runs.size(), 1u);
  ASSERT_EQ(trace.points.size(), 32u);
  for (std::size_t i = 0; i < trace.points.size(); ++i) {
    EXPECT_NEAR(trace.points[i].x, 10 * static_cast<double>(i) - 5, 1e-3);
    EXPECT_EQ(trace.points[i].low, 0.5f * static_cast<float>(20 + i));
    EXPECT_EQ(trace.points[i].high, trace.points[i].low);
  }
  const Trace torn = trace_of(history, {.channel = 1}, window);
  ASSERT_EQ(torn.runs.size(), 2u);
  EXPECT_EQ(torn.runs[0].count, 10u) << "20 to 29";
  EXPECT_EQ(torn.runs[1].first, 10u);
  EXPECT_EQ(torn.runs[1].count, 21u) << "31 to 51";
  // At the ends of the history there is no more.
  EXPECT_EQ(trace_of(history, {.channel = 0}, {1e-4, -100, 2000}).points.size(), 100u);
}

// Each pixel has what its own samples have, and reaches half a step towards its neighbours.
TEST(Trace, OfABandHasTheExtentOfEachPixel) {
  History history({.channels = 1, .seconds = 20});
  for (int i = 0; i < 100; ++i) {
    history.append((i + 0.5) * T, std::array{i < 50 ? i % 2 + 0.0 : 10.0 + i % 2});
  }
  const Trace trace = trace_of(history, {.channel = 0}, {10 * T, 0, 12});
  ASSERT_TRUE(trace.band);
  ASSERT_EQ(trace.points.size(), 10u) << "nothing behind the end";
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(trace.points[i].x, static_cast<float>(i) + 0.5f);
    EXPECT_EQ(trace.points[i].low, i < 5 ? 0 : i == 5 ? 5.5f : 10) << i;
    EXPECT_EQ(trace.points[i].high, i < 4 ? 1 : i == 4 ? 5.5f : 11) << i;
  }
}

}  // namespace
}  // namespace limpid
