#include "core/realtime/triple_buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <thread>

namespace limpid {
namespace {

// A torn read would show two different numbers in it.
using Counters = std::array<std::uint64_t, 64>;

Counters all_equal(std::uint64_t n) {
  Counters c{};
  c.fill(n);
  return c;
}

TEST(TripleBuffer, ShowsTheInitialValueBeforeTheFirstUpdate) {
  TripleBuffer<int> buffer(7);
  EXPECT_FALSE(buffer.update());
  EXPECT_EQ(buffer.front(), 7);
}

TEST(TripleBuffer, HandsOverTheNewestValueOnce) {
  TripleBuffer<int> buffer;
  for (int i = 1; i <= 5; ++i) buffer.write(i);
  EXPECT_TRUE(buffer.update());
  EXPECT_EQ(buffer.front(), 5);
  EXPECT_FALSE(buffer.update());
  EXPECT_EQ(buffer.front(), 5);
}

TEST(TripleBuffer, DoesNotShowWhatWasNotPublished) {
  TripleBuffer<int> buffer(1);
  buffer.back() = 2;
  EXPECT_FALSE(buffer.update());
  EXPECT_EQ(buffer.front(), 1);
  buffer.publish();
  EXPECT_TRUE(buffer.update());
  EXPECT_EQ(buffer.front(), 2);
}

TEST(TripleBuffer, KeepsTheFrontValueWhileTheWriterGoesOn) {
  TripleBuffer<int> buffer;
  buffer.write(1);
  buffer.update();
  const int& front = buffer.front();
  for (int i = 2; i < 10; ++i) {
    buffer.write(i);
    EXPECT_EQ(front, 1);
  }
}

TEST(TripleBuffer, NeverTearsNorGoesBackUnderTwoThreads) {
  constexpr std::uint64_t kLast = 200'000;
  TripleBuffer<Counters> buffer(all_equal(0));
  std::thread writer([&] {
    for (std::uint64_t n = 1; n <= kLast; ++n) {
      buffer.back().fill(n);
      buffer.publish();
    }
  });

  std::uint64_t seen = 0;
  std::uint64_t torn = 0;
  std::uint64_t not_newer = 0;
  while (seen < kLast) {
    if (!buffer.update()) continue;
    const Counters& c = buffer.front();
    if (!std::ranges::all_of(c, [&](std::uint64_t n) { return n == c[0]; })) ++torn;
    if (c[0] <= seen) ++not_newer;
    seen = c[0];
  }
  writer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(not_newer, 0u);
  EXPECT_EQ(seen, kLast);
  EXPECT_FALSE(buffer.update());
}

}  // namespace
}  // namespace limpid
