#include <gtest/gtest.h>

#include "app/desktop/scene/document.h"

namespace limpid {
namespace {

using std::chrono::milliseconds;

class Undo : public testing::Test {
 protected:
  void change(int to, const std::string& what, int after = 1000) {
    now_ += milliseconds(after);
    history_.changed(state_, what, now_);
    state_ = to;
  }
  bool undo() { return go(history_.undo(state_)); }
  bool redo() { return go(history_.redo(state_)); }

  UndoHistory<int> history_;
  UndoHistory<int>::Time now_{};
  int state_ = 0;

 private:
  bool go(std::optional<int> to) {
    if (to) state_ = *to;
    return to.has_value();
  }
};

TEST_F(Undo, GoesBackAndForthInOrderOfTime) {
  EXPECT_FALSE(undo());
  for (int i = 1; i <= 5; ++i) change(i, i % 2 == 0 ? "eta" : "place");
  for (int i = 4; i >= 0; --i) {
    EXPECT_TRUE(undo());
    EXPECT_EQ(state_, i);
  }
  EXPECT_FALSE(undo());
  for (int i = 1; i <= 5; ++i) {
    EXPECT_TRUE(redo());
    EXPECT_EQ(state_, i);
  }
  EXPECT_FALSE(redo());
}

TEST_F(Undo, TakesADragAsOneStepHoweverLongItRests) {
  history_.hold(true);
  for (int i = 1; i <= 20; ++i) {
    change(i, "place", 2000);
    history_.hold(true);
  }
  history_.hold(false);
  EXPECT_TRUE(undo());
  EXPECT_EQ(state_, 0);
  EXPECT_FALSE(undo());
}

TEST_F(Undo, TakesASecondDragOfTheSameAsASecondStep) {
  for (const int to : {1, 2}) {
    history_.hold(true);
    change(to, "place", 10);
    history_.hold(false);
  }
  EXPECT_TRUE(undo());
  EXPECT_EQ(state_, 1);
}

TEST_F(Undo, TakesKeysPressedInQuickSuccessionAsOneStep) {
  for (int i = 1; i <= 9; ++i) change(i, "eta", 100);
  change(10, "eta", 600);
  EXPECT_TRUE(undo());
  EXPECT_EQ(state_, 9);
  EXPECT_TRUE(undo());
  EXPECT_EQ(state_, 0);
}

TEST_F(Undo, KeepsStepsWithoutANameApart) {
  for (int i = 1; i <= 3; ++i) change(i, "", 1);
  EXPECT_TRUE(undo());
  EXPECT_EQ(state_, 2);
}

TEST_F(Undo, DoesNotGrowAStepThatWasGoneBackTo) {
  change(1, "eta");
  EXPECT_TRUE(undo());
  change(2, "eta", 1);
  EXPECT_TRUE(undo());
  EXPECT_EQ(state_, 0);
  EXPECT_TRUE(redo());
  EXPECT_EQ(state_, 2);
}

TEST_F(Undo, ForgetsWhatWasUndoneOnceSomethingElseIsDone) {
  change(1, "eta");
  change(2, "place");
  EXPECT_TRUE(undo());
  change(3, "eta");
  EXPECT_FALSE(redo());
  EXPECT_TRUE(undo());
  EXPECT_EQ(state_, 1);
}

TEST_F(Undo, HoldsTheLastTwoHundredSteps) {
  for (int i = 1; i <= 1000; ++i) change(i, "");
  int steps = 0;
  while (undo()) ++steps;
  EXPECT_EQ(steps, 200);
  EXPECT_EQ(state_, 800);
}

TEST_F(Undo, ForgetsStepsThatHaveBecomeNone) {
  for (int i = 1; i <= 6; ++i) change(i, "");
  history_.rewrite([](int& state) { state /= 2; }, std::equal_to<>());
  int steps = 0;
  while (undo()) ++steps;
  EXPECT_EQ(steps, 3) << "0, 1, 2 of 0, 0, 1, 1, 2, 2";
}

}  // namespace
}  // namespace limpid
