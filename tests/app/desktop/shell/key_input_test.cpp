#include <string>

#include "app/desktop/shell/input.h"
#include "tests/app/plot/imgui_frames.h"

namespace limpid {
namespace {

constexpr Focus kText{.text = true};

class KeyInputTest : public ImGuiFrames {
 protected:
  void tap(int key, int modifiers = 0, const std::string& writes = "") {
    keys_.key(key, GLFW_PRESS, modifiers);
    for (const char c : writes) keys_.character(static_cast<unsigned char>(c));
    keys_.key(key, GLFW_RELEASE, modifiers);
  }
  void type(const std::string& text) {
    for (const char c : text) tap(std::toupper(c), 0, std::string(1, c));
  }
  void control(int key) {
    keys_.key(GLFW_KEY_LEFT_CONTROL, GLFW_PRESS, 0);
    tap(key, GLFW_MOD_CONTROL);
    keys_.key(GLFW_KEY_LEFT_CONTROL, GLFW_RELEASE, GLFW_MOD_CONTROL);
  }
  // Draws a frame; returns the keys it hands out.
  std::vector<int> look(const Focus& focus = {}) {
    keys_.forget_pressed();
    keys_.deal(focus);
    written_.clear();
    frame([this] {
      const ImGuiIO& io = ImGui::GetIO();
      for (const ImWchar c : io.InputQueueCharacters) written_ += static_cast<char>(c);
      control_ = io.KeyCtrl;
      backspace_ = key_pressed(GLFW_KEY_BACKSPACE, false);
    });
    std::vector<int> pressed;
    for (const KeyPress& press : keys_.pressed()) pressed.push_back(press.key);
    return pressed;
  }

  KeyInput keys_;
  std::string written_;  // characters given to ImGui in the last frame
  bool control_ = false, backspace_ = false;
};

using testing::ElementsAre;
using testing::IsEmpty;

TEST_F(KeyInputTest, TextTypedBetweenTwoFramesComesAtOnce) {
  type("hello");
  look(kText);
  EXPECT_EQ(written_, "hello");
  EXPECT_FALSE(keys_.waiting());
}

TEST_F(KeyInputTest, TextAfterASelectionIsNotTypedWithControlHeld) {
  control(GLFW_KEY_A);
  type("new");
  EXPECT_THAT(look(kText), ElementsAre(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_A));
  EXPECT_TRUE(control_);
  EXPECT_EQ(written_, "");
  look(kText);
  EXPECT_FALSE(control_);
  EXPECT_EQ(written_, "new");
}

TEST_F(KeyInputTest, TextAndTheKeysThatChangeItKeepTheirOrder) {
  type("ab");
  tap(GLFW_KEY_BACKSPACE);
  type("c");
  look(kText);
  EXPECT_EQ(written_, "ab");
  EXPECT_FALSE(backspace_);
  look(kText);
  EXPECT_TRUE(backspace_);
  EXPECT_EQ(written_, "");
  look(kText);
  EXPECT_EQ(written_, "c");
}

TEST_F(KeyInputTest, EveryTapOfAKeyIsSeen) {
  for (int i = 0; i < 3; ++i) tap(GLFW_KEY_BACKSPACE);
  int seen = 0;
  for (int frames = 0; keys_.waiting() && frames < 20; ++frames) {
    look(kText);
    seen += backspace_ ? 1 : 0;
  }
  EXPECT_EQ(seen, 3);
}

TEST_F(KeyInputTest, AKeyMayOpenSomethingForTheNextOne) {
  tap(GLFW_KEY_N, 0, "n");
  type("eta");
  EXPECT_THAT(look(), ElementsAre(GLFW_KEY_N));
  look({.text = true, .dialog = "plot"});
  EXPECT_EQ(written_, "eta");
}

TEST_F(KeyInputTest, WhatCutsTheForceWaitsForNothing) {
  for (const int key : {GLFW_KEY_ESCAPE, GLFW_KEY_SPACE}) {
    tap(GLFW_KEY_C, 0, "c");
    tap(GLFW_KEY_R, 0, "r");
    tap(key);
    tap(GLFW_KEY_G, 0, "g");
    EXPECT_THAT(look(), ElementsAre(GLFW_KEY_C, GLFW_KEY_R, key));
    EXPECT_THAT(look(), ElementsAre(GLFW_KEY_G));
    look();
  }
}

const char* french(int place) {
  switch (place) {
    case GLFW_KEY_Q: return "a";
    case GLFW_KEY_A: return "q";
    default: return nullptr;
  }
}

TEST_F(KeyInputTest, AKeyIsWhatStandsOnIt) {
  keys_.set_labels(KeyLabels(french));
  tap(GLFW_KEY_Q, GLFW_MOD_CONTROL);
  EXPECT_THAT(look(), ElementsAre(GLFW_KEY_A));
}

TEST_F(KeyInputTest, AKeyIsLetGoAsWhatItWasPressedAs) {
  keys_.set_labels(KeyLabels(french));
  keys_.key(GLFW_KEY_Q, GLFW_PRESS, 0);
  look();
  keys_.set_labels(KeyLabels());  // a changed keyboard
  keys_.key(GLFW_KEY_Q, GLFW_RELEASE, 0);
  look();
  keys_.set_labels(KeyLabels(french));
  keys_.key(GLFW_KEY_Q, GLFW_PRESS, 0);
  bool down = false;
  keys_.deal({});
  frame([&] { down = key_pressed(GLFW_KEY_A, false); });
  EXPECT_TRUE(down) << "it was up before";
}

TEST_F(KeyInputTest, AKeyKnowsWhatItWrote) {
  tap(GLFW_KEY_SLASH, GLFW_MOD_SHIFT, "?");
  tap(GLFW_KEY_F1);
  look();
  EXPECT_EQ(keys_.pressed().at(0).character, '?');
  look();
  EXPECT_EQ(keys_.pressed().at(0).character, 0u);
}

// AltGr+E is a euro sign, not E. The space bar stays the same.
TEST_F(KeyInputTest, WithAltGrAKeyIsNotItsLetter) {
  keys_.key(GLFW_KEY_RIGHT_ALT, GLFW_PRESS, 0);
  look();
  tap(GLFW_KEY_E);
  EXPECT_THAT(look(), ElementsAre(GLFW_KEY_UNKNOWN));
  tap(GLFW_KEY_SPACE);
  EXPECT_THAT(look(), ElementsAre(GLFW_KEY_SPACE));
  tap(GLFW_KEY_E, GLFW_MOD_ALT);
  EXPECT_THAT(look(), ElementsAre(GLFW_KEY_E)) << "where it is an Alt as the other one";
}

// ImGui takes a menu's item with the space bar, which cuts the force here.
TEST_F(KeyInputTest, InAMenuEnterTakesAnItemAndTheSpaceBarDoesNot) {
  const Focus menu{.popup = true};
  const auto taken = [&](int key) {
    tap(key);
    keys_.forget_pressed();
    keys_.deal(menu);
    bool space = false;
    frame([&] { space = key_pressed(GLFW_KEY_SPACE, false); });
    keys_.deal(menu);
    frame([] {});
    return space;
  };
  EXPECT_TRUE(taken(GLFW_KEY_ENTER));
  EXPECT_TRUE(taken(GLFW_KEY_ENTER)) << "and once more";
  EXPECT_TRUE(taken(GLFW_KEY_KP_ENTER));
  EXPECT_FALSE(taken(GLFW_KEY_SPACE));
  tap(GLFW_KEY_SPACE);
  EXPECT_THAT(look(menu), ElementsAre(GLFW_KEY_SPACE)) << "for the command";
}

TEST_F(KeyInputTest, AReleaseThatNeverCameStopsNothing) {
  keys_.key(GLFW_KEY_BACKSPACE, GLFW_PRESS, 0);
  look(kText);
  keys_.key(GLFW_KEY_BACKSPACE, GLFW_PRESS, 0);
  look(kText);
  EXPECT_FALSE(keys_.waiting());
}

}  // namespace
}  // namespace limpid
