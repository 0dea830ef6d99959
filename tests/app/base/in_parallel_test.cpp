#include "app/base/in_parallel.h"

#include <gmock/gmock.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

namespace limpid {
namespace {

TEST(InParallel, DoesEachPieceOnce) {
  for (const unsigned threads : {1u, 3u, 40u}) {
    std::vector<std::atomic<int>> done(25);
    in_parallel(done.size(), threads, [&](std::size_t i, const std::atomic<bool>&) {
      ++done[i];
      return true;
    });
    for (const auto& times : done) EXPECT_EQ(times, 1);
  }
}

TEST(InParallel, TakesNoMoreOnceAPieceSaysSo) {
  std::vector<std::size_t> taken;
  in_parallel(10, 1, [&](std::size_t i, const std::atomic<bool>&) {
    taken.push_back(i);
    return i < 3;
  });
  EXPECT_THAT(taken, testing::ElementsAre(0, 1, 2, 3));
}

TEST(InParallel, ThrowsWhatAPieceThrewOnceAllHaveEnded) {
  std::atomic<int> inside{0};
  const auto piece = [&](std::size_t i, const std::atomic<bool>& over) {
    ++inside;
    if (i == 1) {
      --inside;
      throw std::runtime_error("piece 1");
    }
    // The cancel arrives at once, however long the work takes.
    while (!over) std::this_thread::yield();
    --inside;
    return true;
  };
  EXPECT_THAT([&] { in_parallel(100, 2, piece); },
              testing::ThrowsMessage<std::runtime_error>("piece 1"));
  EXPECT_EQ(inside, 0);
}

TEST(InParallel, TakesAsManyThreadsAsThereAreProcessorsWhereNoneAreAskedFor) {
  EXPECT_EQ(threads_for(7), 7u);
  EXPECT_GE(threads_for(0), 1u);
}

}  // namespace
}  // namespace limpid
