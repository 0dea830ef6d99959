#include "core/realtime/hand_over.h"

#include <gtest/gtest.h>

#include <thread>
#include <utility>
#include <vector>

namespace limpid {
namespace {

// A thing that counts its living copies; damage would show in its two values.
struct Thing {
  Thing(int number, std::atomic<int>& alive) : value(number), twice(2 * number), alive_(alive) {
    ++alive_;
  }
  ~Thing() { --alive_; }
  int value, twice;

 private:
  std::atomic<int>& alive_;
};

struct Handing : testing::Test {
  std::unique_ptr<Thing> make(int value) { return std::make_unique<Thing>(value, alive); }
  ~Handing() override { EXPECT_EQ(alive, 0); }
  std::atomic<int> alive = 0;
};

TEST_F(Handing, GivesTheNewestOnce) {
  HandOver<Thing> over;
  EXPECT_EQ(over.take(), nullptr);
  over.offer(make(1));
  over.offer(make(2));
  EXPECT_EQ(alive, 1) << "the first was never wanted";
  Thing* const taken = over.take();
  ASSERT_NE(taken, nullptr);
  EXPECT_EQ(taken->value, 2);
  EXPECT_EQ(over.take(), nullptr);
  over.give_back(taken);
}

TEST_F(Handing, TakesNothingNewUntilTheOldWasCollected) {
  HandOver<Thing> over;
  over.offer(make(1));
  Thing* const first = over.take();
  over.give_back(nullptr);
  over.offer(make(2));
  Thing* const second = over.take();
  over.give_back(first);
  EXPECT_EQ(over.take(), nullptr);
  EXPECT_EQ(alive, 2);
  over.collect();
  EXPECT_EQ(alive, 1);
  delete second;
}

TEST_F(Handing, DestroysWhatNobodyTook) {
  HandOver<Thing> over;
  over.offer(make(1));
}

TEST_F(Handing, WorksWhileBothSidesRun) {
  constexpr int kOffers = 20'000;
  HandOver<Thing> over;
  std::atomic<bool> done = false;
  std::atomic<int> newest = 0;
  int taken_all = 0;
  Thing* held = nullptr;
  std::thread loop([&] {
    for (bool last = false; !last;) {
      last = done;
      Thing* const taken = over.take();
      if (taken == nullptr) continue;
      EXPECT_EQ(taken->twice, 2 * taken->value);
      EXPECT_GT(taken->value, newest) << "older than one before";
      newest = taken->value;
      ++taken_all;
      over.give_back(std::exchange(held, taken));
    }
  });
  for (int i = 1; i <= kOffers; ++i) {
    over.offer(make(i));
    EXPECT_LE(alive, 4);
    // At times waits until the loop has this one, or a newer one.
    while (i % 100 == 0 && newest < i) over.collect();
  }
  done = true;
  loop.join();
  EXPECT_GE(taken_all, kOffers / 100);
  EXPECT_EQ(newest, kOffers);
  over.clear();
  delete held;
}

}  // namespace
}  // namespace limpid
