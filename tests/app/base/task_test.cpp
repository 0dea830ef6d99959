#include <gtest/gtest.h>

#include <future>
#include <stdexcept>

#include "app/base/tasks.h"

namespace limpid {
namespace {

template <class Result>
Result wait_for(Task<Result>& background) {
  while (true) {
    if (auto result = background.take()) return *result;
    std::this_thread::yield();
  }
}

TEST(Task, HandsOverTheResultOnce) {
  Task<int> background;
  EXPECT_FALSE(background.take());
  background.start("adding", [](TaskProgress&) { return 2 + 3; });
  EXPECT_EQ(background.what(), "adding");
  EXPECT_EQ(wait_for(background), 5);
  EXPECT_FALSE(background.busy());
  EXPECT_FALSE(background.take());
}

TEST(Task, ShowsHowFarItIs) {
  Task<int> background;
  std::promise<void> half, go;
  background.start("waiting", [&](TaskProgress& progress) {
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

TEST(Task, ThrowsWhatTheWorkThrewAndCanStartAgain) {
  Task<int> background;
  background.start("failing", [](TaskProgress&) -> int { throw std::runtime_error("no"); });
  EXPECT_THROW(wait_for(background), std::runtime_error);
  EXPECT_FALSE(background.busy());
  background.start("working", [](TaskProgress&) { return 7; });
  EXPECT_EQ(wait_for(background), 7);
}

// Work that ends only when it is cancelled.
int until_cancelled(TaskProgress& progress) {
  while (!progress.cancel) std::this_thread::yield();
  return 1;
}

TEST(Task, EndsTheWorkWhenCancelledAndForgetsItsResult) {
  Task<int> background;
  background.start("endless", until_cancelled);
  background.cancel();
  EXPECT_FALSE(background.busy());
  EXPECT_FALSE(background.take());
}

TEST(Task, EndsTheOldWorkWhenANewOneStartsOrItGoes) {
  Task<int> background;
  background.start("endless", until_cancelled);
  background.start("short", [](TaskProgress& progress) { return progress.cancel ? 1 : 2; });
  EXPECT_EQ(wait_for(background), 2);
  background.start("endless again", until_cancelled);
}

}  // namespace
}  // namespace limpid
