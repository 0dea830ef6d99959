#include "core/realtime/trace_ring.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <numeric>
#include <thread>
#include <vector>

namespace limpid {
namespace {

TEST(TraceRing, RefusesACapacityThatIsNotAPowerOfTwo) {
  EXPECT_THROW(TraceRing(0, 1), std::invalid_argument);
  EXPECT_THROW(TraceRing(12, 1), std::invalid_argument);
  EXPECT_NO_THROW(TraceRing(16, 1));
}

TEST(TraceRing, RefusesRowsWithoutColumns) {
  EXPECT_THROW(TraceRing(16, 0), std::invalid_argument);
}

TEST(TraceRing, ReturnsRowsInOrderAcrossTheSeam) {
  TraceRing ring(4, 2);
  std::array<double, 6> out{};
  double next_in = 0;
  double next_out = 0;
  for (int round = 0; round < 10; ++round) {
    for (int i = 0; i < 3; ++i, ++next_in) ASSERT_TRUE(ring.push(std::array{next_in, -next_in}));
    ASSERT_EQ(ring.size(), 3u);
    ASSERT_EQ(ring.pop(out), 3u);
    for (std::size_t i = 0; i < 3; ++i, ++next_out) {
      EXPECT_EQ(out[2 * i], next_out);
      EXPECT_EQ(out[2 * i + 1], -next_out);
    }
  }
  EXPECT_EQ(ring.dropped(), 0u);
}

TEST(TraceRing, DropsAndCountsWhatFindsNoRoomAndKeepsTheOlderRows) {
  TraceRing ring(4, 1);
  for (double n = 0; n < 7; ++n) EXPECT_EQ(ring.push(std::array{n}), n < 4);
  EXPECT_EQ(ring.dropped(), 3u);
  EXPECT_EQ(ring.size(), ring.capacity());

  std::array<double, 8> out{};
  ASSERT_EQ(ring.pop(out), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(out[i], static_cast<double>(i));
  EXPECT_TRUE(ring.push(std::array{9.0}));
  EXPECT_EQ(ring.dropped(), 3u);
}

TEST(TraceRing, NumbersRowsAsTheyWereOfferedAndPopsUpToAGap) {
  TraceRing ring(4, 1);
  std::array<double, 8> out{};
  const auto offer = [&](int first, int last) {
    for (int n = first; n <= last; ++n) ring.push(std::array{static_cast<double>(n)});
  };
  const auto popped = [&](std::size_t room) {
    const double number = static_cast<double>(ring.number());
    const std::size_t count = ring.pop(std::span(out).first(room));
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(out[i], number + static_cast<double>(i));
    return count;
  };
  offer(0, 5);  // 4 and 5 find no room
  EXPECT_EQ(popped(1), 1u);
  offer(6, 7);  // nor does 7
  EXPECT_EQ(popped(8), 3u) << "1 to 3";
  offer(8, 9);
  EXPECT_EQ(popped(8), 1u) << "6";
  EXPECT_EQ(popped(8), 2u) << "8 and 9";
  EXPECT_EQ(ring.size(), 0u);
}

TEST(TraceRing, PopsWholeRowsOnly) {
  TraceRing ring(4, 3);
  ring.push(std::array{1.0, 2.0, 3.0});
  ring.push(std::array{4.0, 5.0, 6.0});
  std::array<double, 5> out{-1, -1, -1, -1, -1};
  EXPECT_EQ(ring.pop(std::span(out).first(2)), 0u);
  EXPECT_EQ(ring.size(), 2u);
  EXPECT_EQ(ring.pop(out), 1u);
  EXPECT_EQ(out, (std::array{1.0, 2.0, 3.0, -1.0, -1.0}));
  EXPECT_EQ(ring.pop({}), 0u);
  EXPECT_EQ(ring.size(), 1u);
}

// The reader is slower than the writer at times, so that rows are dropped as well.
TEST(TraceRing, DeliversEveryAcceptedRowOnceAndInOrderUnderTwoThreads) {
  constexpr std::int64_t kRows = 300'000;
  constexpr std::size_t kStride = 7;
  TraceRing ring(64, kStride);
  std::atomic<bool> done{false};
  std::vector<double> accepted;
  std::uint64_t refused = 0;
  std::thread producer([&] {
    std::array<double, kStride> row{};
    for (std::int64_t n = 0; n < kRows; ++n) {
      row.fill(static_cast<double>(n));
      if (ring.push(row))
        accepted.push_back(row[0]);
      else
        ++refused;
    }
    done.store(true, std::memory_order_release);
  });

  std::vector<double> received;
  std::int64_t torn = 0;
  std::int64_t misnumbered = 0;
  std::vector<double> rows(10 * kStride);
  for (bool last = false; !last;) {
    last = done.load(std::memory_order_acquire);
    while (ring.size() > 0) {
      const std::uint64_t number = ring.number();
      const std::size_t count = ring.pop(rows);
      for (std::size_t r = 0; r < count; ++r) {
        const auto row = std::span(rows).subspan(r * kStride, kStride);
        received.push_back(row[0]);
        misnumbered += row[0] != static_cast<double>(number + r);
        for (const double value : row) torn += value != row[0];
      }
    }
    std::this_thread::yield();
  }
  producer.join();

  EXPECT_EQ(torn, 0);
  EXPECT_EQ(misnumbered, 0);
  EXPECT_TRUE(received == accepted);
  EXPECT_EQ(ring.dropped(), refused);
  EXPECT_EQ(received.size() + ring.dropped(), static_cast<std::uint64_t>(kRows));
}

TEST(SpscQueue, RefusesWhenFullAndReturnsNothingWhenEmpty) {
  SpscQueue<int> queue(2);
  EXPECT_FALSE(queue.pop().has_value());
  EXPECT_TRUE(queue.push(1));
  EXPECT_TRUE(queue.push(2));
  EXPECT_FALSE(queue.push(3));
  EXPECT_EQ(queue.pop(), 1);
  EXPECT_TRUE(queue.push(4));
  EXPECT_EQ(queue.pop(), 2);
  EXPECT_EQ(queue.pop(), 4);
  EXPECT_FALSE(queue.pop().has_value());
}

TEST(SpscQueue, DeliversEveryEventOnceAndInOrderUnderTwoThreads) {
  constexpr int kEvents = 200'000;
  struct Event {
    int number;
    int same;
  };
  SpscQueue<Event> queue(16);
  std::thread producer([&] {
    for (int n = 0; n < kEvents; ++n)
      while (!queue.push({n, n})) std::this_thread::yield();
  });
  int wrong = 0;
  for (int expected = 0; expected < kEvents;) {
    const std::optional<Event> event = queue.pop();
    if (!event) continue;
    wrong += event->number != expected || event->same != expected;
    ++expected;
  }
  producer.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(queue.size(), 0u);
}

}  // namespace
}  // namespace limpid
