#include "app/plot/history.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "tests/support/tick.h"

namespace limpid {
namespace {

using test::T;

// A plain reference of the history's content.
struct Plain {
  std::vector<double> times;
  std::vector<float> values;
};

Extent brute_force(const Plain& plain, std::size_t from, std::size_t to) {
  Extent extent;
  for (std::size_t i = from; i < to; ++i) extent.include(plain.values[i]);
  return extent;
}

Plain fill(History& history, int rows, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise;
  Plain plain;
  for (int i = 0; i < rows; ++i) {
    const double value = i % 97 == 0 ? std::numeric_limits<double>::quiet_NaN() : noise(random);
    plain.times.push_back(i * T);
    plain.values.push_back(static_cast<float>(value));
    history.append(plain.times.back(), std::array{value});
  }
  return plain;
}

void compare_random_windows(const History& history, const Plain& plain, unsigned seed) {
  std::mt19937_64 random(seed);
  const SampleIndex first = history.first();
  for (int i = 0; i < 3000; ++i) {
    SampleIndex from = first + random() % (history.end() - first + 1);
    SampleIndex to = first + random() % (history.end() - first + 1);
    if (from > to) std::swap(from, to);
    if (i % 2 == 0) to = std::min(to, from + i % 60);
    EXPECT_EQ(history.extent(0, from, to), brute_force(plain, from, to)) << from << ' ' << to;
  }
}

TEST(History, ExtentsOfRandomWindowsAreThoseOfTheSamples) {
  History history({.seconds = 60, .tick = T});
  const Plain plain = fill(history, 30011, 1);
  EXPECT_EQ(history.first(), 0u);
  compare_random_windows(history, plain, 2);
}

TEST(History, ExtentsStayRightAfterTheOldestSamplesWereOverwritten) {
  for (const int rows : {8192, 8193, 12000, 16384, 30011}) {
    History history({.seconds = 8, .tick = T});
    const Plain plain = fill(history, rows, 3);
    EXPECT_EQ(history.end(), static_cast<SampleIndex>(rows));
    EXPECT_GE(history.end() - history.first(), 8000u);
    compare_random_windows(history, plain, 4);
  }
}

// A second run may begin at any time: before, within and after the first lap of the buffer.
TEST(History, ExtentsAreRightWhereverTheFirstNumberComes) {
  for (const int nothing : {0, 1, 7, 8, 500, 4096, 8191, 8192, 8193, 20011}) {
    History history({.seconds = 8, .tick = T});
    Plain plain;
    for (int i = 0; i < nothing; ++i) {
      plain.times.push_back(i * T);
      plain.values.push_back(std::numeric_limits<float>::quiet_NaN());
      history.append(plain.times.back(), std::array{std::numeric_limits<double>::quiet_NaN()});
    }
    compare_random_windows(history, plain, 3);
    for (int i = nothing; i < nothing + 9001; ++i) {
      plain.times.push_back(i * T);
      plain.values.push_back(static_cast<float>(std::sin(0.37 * i)));
      history.append(plain.times.back(), std::array{static_cast<double>(plain.values.back())});
      if (i == nothing + 3) compare_random_windows(history, plain, 4);
    }
    compare_random_windows(history, plain, 5);
    for (SampleIndex i = history.first(); i < history.end(); ++i) {
      const float kept = history.value(0, i), given = plain.values[i];
      EXPECT_TRUE(kept == given || (std::isnan(kept) && std::isnan(given))) << i;
    }
  }
}

TEST(History, ChannelsThatNeverHadANumberTakeNoMemory) {
  const auto resident = [] {
    std::size_t size = 0, pages = 0;
    std::ifstream("/proc/self/statm") >> size >> pages;
    return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  };
  constexpr int kChannels = 200;
  History history({.channels = kChannels, .tick = T});
  const std::vector<double> nothing(kChannels, std::numeric_limits<double>::quiet_NaN());
  const std::size_t before = resident();
  for (int i = 0; i < 60'000; ++i) history.append(i * T, nothing);
  // The values would take 60 MB; times alone take 0.5 MB.
  EXPECT_LT(resident() - before, 5'000'000u);
}

TEST(History, RemembersSamplesByNumberAndTime) {
  History history({.seconds = 8, .tick = T});
  const Plain plain = fill(history, 20000, 5);
  for (SampleIndex i = history.first(); i < history.end(); i += 37) {
    EXPECT_EQ(history.time(i), plain.times[i]);
    if (std::isfinite(plain.values[i])) {
      EXPECT_EQ(history.value(0, i), plain.values[i]);
    }
    EXPECT_EQ(history.nearest(plain.times[i] + 0.3 * T), i);
    EXPECT_EQ(history.lower_bound(plain.times[i]), i);
  }
  EXPECT_EQ(history.nearest(-100), history.first());
  EXPECT_EQ(history.nearest(1e6), history.end() - 1);
}

TEST(History, LowerBoundFromAnyRowBeforeIsTheSame) {
  History history({.seconds = 8, .tick = T});
  fill(history, 5000, 6);
  for (SampleIndex from = 0; from < 4000; from += 333) {
    EXPECT_EQ(history.lower_bound(4.0005, from), 4001u);
  }
  EXPECT_EQ(history.lower_bound(99), history.end());
}

TEST(History, ExtentBetweenTimesHasBothEnds) {
  History history({.seconds = 1, .tick = T});
  for (int i = 0; i < 10; ++i) history.append(i * 0.5, std::array{static_cast<double>(i)});
  const Extent extent = history.extent_between(0, 1.0, 3.0);
  EXPECT_EQ(extent.low, 2);
  EXPECT_EQ(extent.high, 6);
}

TEST(History, DroppedTicksAreAGap) {
  History history({.tick = T});
  for (const double time : {0.0, 0.001, 0.002, 0.005, 0.006}) history.append(time, std::array{1.0});
  EXPECT_FALSE(history.gap_before(1));
  EXPECT_FALSE(history.gap_before(2));
  EXPECT_TRUE(history.gap_before(3));
  EXPECT_FALSE(history.gap_before(4));
}

TEST(History, TimeThatStartsAgainGoesOnAfterAGapAndIsMarked) {
  History history({.tick = T});
  for (int i = 0; i < 100; ++i) history.append(i * T, std::array{1.0});
  for (int i = 0; i < 100; ++i) history.append(i * T, std::array{2.0});
  EXPECT_TRUE(history.gap_before(100));
  EXPECT_GT(history.time(100), history.time(99));
  EXPECT_NEAR(history.time(150) - history.offset(), 0.050, 1e-12);
  for (SampleIndex i = 1; i < history.end(); ++i) EXPECT_GT(history.time(i), history.time(i - 1));
  ASSERT_EQ(history.marks().size(), 1u);
  EXPECT_EQ(history.marks().front().time, history.time(100));
}

TEST(History, MarksOfOneGestureBecomeOneAndOldOnesAreForgotten) {
  History history({.seconds = 2, .tick = T});
  history.append(0, std::array{0.0});
  for (int i = 0; i < 10; ++i) history.mark(i * 0.1, "eta " + std::to_string(i), "eta");
  history.mark(0.95, "standard", "kind");
  ASSERT_EQ(history.marks().size(), 2u);
  EXPECT_EQ(history.marks().front().label, "eta 9");
  for (int i = 1; i < 20000; ++i) history.append(i * T, std::array{0.0});
  EXPECT_TRUE(history.marks().empty());
}

TEST(History, ClearForgetsEverything) {
  History history({.seconds = 1, .tick = T});
  fill(history, 5000, 7);
  history.mark(5, "here");
  history.clear();
  EXPECT_TRUE(history.empty());
  EXPECT_TRUE(history.marks().empty());
  const Plain plain = fill(history, 700, 8);
  compare_random_windows(history, plain, 9);
}

TEST(History, InfiniteValuesDoNotSpoilTheExtent) {
  History history({.tick = T});
  history.append(0, std::array{1.0});
  history.append(T, std::array{std::numeric_limits<double>::infinity()});
  history.append(2 * T, std::array{3.0});
  EXPECT_EQ(history.extent(0, 0, 3).high, 3);
}

TEST(History, RefusesRowsOfTheWrongWidthAndTimesThatAreNone) {
  History history({.channels = 2});
  EXPECT_THROW(history.append(0, std::array{1.0}), std::invalid_argument);
  EXPECT_THROW(history.append(std::nan(""), std::array{1.0, 2.0}), std::invalid_argument);
  EXPECT_THROW(History({.channels = 0}), std::invalid_argument);
  EXPECT_THROW(History({.tick = 0}), std::invalid_argument);
}

// A second run counts its time from zero again; its marks belong to it, not to the first one.
TEST(History, MarksOfASecondRunStandInThatRun) {
  History history({.seconds = 8, .tick = T});
  for (int i = 0; i < 1000; ++i) history.append(i * T, std::array{1.0});
  history.mark(0.2, "eta of the first", "eta");
  for (int i = 0; i < 1000; ++i) history.append(i * T, std::array{2.0});
  ASSERT_GT(history.offset(), 0.9);
  history.mark(0.2, "eta", "eta");
  history.mark(0.3, "eta moved on", "eta");
  history.mark(0.9, "eta later", "eta");  // another gesture
  ASSERT_EQ(history.marks().size(), 4u);
  EXPECT_EQ(history.marks()[1].key, kResetMark);
  EXPECT_EQ(history.marks()[0].label, "eta of the first");
  EXPECT_NEAR(history.marks()[0].time, 0.2, 1e-12);
  EXPECT_EQ(history.marks()[2].label, "eta moved on");
  EXPECT_NEAR(history.marks()[2].time, history.time(1300), 1e-9);
}

// Every frame draws all marks, and a program may set thousands a second.
TEST(HistoryMarks, AreBoundedAndTheOldestGoFirst) {
  History history({.channels = 1, .seconds = 60});
  const std::size_t all = 3 * History::kMostMarks;
  for (std::size_t i = 0; i < all; ++i) {
    const double time = 0.001 * static_cast<double>(i);
    history.append(time, std::array{0.0});
    history.mark_at(time, std::to_string(i), kNoteMark);
  }
  ASSERT_EQ(history.marks().size(), History::kMostMarks);
  EXPECT_EQ(history.marks().back().label, std::to_string(all - 1));
  EXPECT_EQ(history.marks().front().label, std::to_string(all - History::kMostMarks));
}

// A person marks an earlier moment while settings go on changing.
TEST(HistoryMarks, StandInTheOrderOfTheirTimesWheneverTheyWereSet) {
  History history({.channels = 1, .seconds = 60});
  for (int i = 0; i < 3000; ++i) history.append(0.001 * i, std::array{0.0});
  history.mark(2, "eta", "coupling.eta");
  history.mark_at(1, "one", kNoteMark);
  history.mark_at(1.1, "two", kNoteMark);
  ASSERT_EQ(history.marks().size(), 3u);
  EXPECT_EQ(history.marks()[0].label, "one");
  EXPECT_EQ(history.marks()[1].label, "two");
  EXPECT_EQ(history.marks()[2].label, "eta");
  history.replace_marks(kNoteMark, {{2.5, kNoteMark, "three"}});
  ASSERT_EQ(history.marks().size(), 2u);
  EXPECT_EQ(history.marks()[0].label, "eta");
  EXPECT_EQ(history.marks()[1].label, "three");
}

}  // namespace
}  // namespace limpid
