#include "app/session/background.h"

#include <gtest/gtest.h>

#include <future>
#include <stdexcept>

namespace limpid {
namespace {

template <class Result>
Result wait_for(Background<Result>& background) {
  while (true) {
    if (auto result = background.take()) return *result;
    std::this_thread::yield();
  }
}

TEST(Background, HandsOverTheResultOnce) {
  Background<int> background;
  EXPECT_FALSE(background.take());
  background.start("adding", [](BackgroundProgress&) { return 2 + 3; });
  EXPECT_EQ(background.what(), "adding");
  EXPECT_EQ(wait_for(background), 5);
  EXPECT_FALSE(background.busy());
  EXPECT_FALSE(background.take());
}

TEST(Background, ShowsHowFarItIs) {
  Background<int> background;
  std::promise<void> half, go;
  background.start("waiting", [&](BackgroundProgress& progress) {
    progress.part = 0.5;
    half.set_value();
    go.get_future().wait();
    return 1;
  });
  half.get_future().wait();
  EXPECT_TRUE(background.busy());
  EXPECT_EQ(background.part(), 0.5);
  EXPECT_FALSE(background.take());
  go.set_value();
  EXPECT_EQ(wait_for(background), 1);
}

TEST(Background, ThrowsWhatTheWorkThrewAndCanStartAgain) {
  Background<int> background;
  background.start("failing", [](BackgroundProgress&) -> int { throw std::runtime_error("no"); });
  EXPECT_THROW(wait_for(background), std::runtime_error);
  EXPECT_FALSE(background.busy());
  background.start("working", [](BackgroundProgress&) { return 7; });
  EXPECT_EQ(wait_for(background), 7);
}

// Work that ends only when it is cancelled.
int until_cancelled(BackgroundProgress& progress) {
  while (!progress.cancel) std::this_thread::yield();
  return 1;
}

TEST(Background, EndsTheWorkWhenCancelledAndForgetsItsResult) {
  Background<int> background;
  background.start("endless", until_cancelled);
  background.cancel();
  EXPECT_FALSE(background.busy());
  EXPECT_FALSE(background.take());
}

TEST(Background, EndsTheOldWorkWhenANewOneStartsOrItGoes) {
  Background<int> background;
  background.start("endless", until_cancelled);
  background.start("short", [](BackgroundProgress& progress) { return progress.cancel ? 1 : 2; });
  EXPECT_EQ(wait_for(background), 2);
  background.start("endless again", until_cancelled);
}

}  // namespace
}  // namespace limpid
