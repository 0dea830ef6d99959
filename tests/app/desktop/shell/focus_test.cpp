#include "app/desktop/shell/focus.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <set>

#include "app/desktop/shell/dialogs.h"

namespace limpid {
namespace {

TEST(Focus, TextComesBeforeMenusQuestionsDialogsPlaybackAndWhatIsSelected) {
  Focus focus;
  EXPECT_EQ(owner_of(focus), KeyOwner::view);
  focus.selection = true;
  EXPECT_EQ(owner_of(focus), KeyOwner::selection);
  focus.transform = true;
  EXPECT_EQ(owner_of(focus), KeyOwner::transform);
  focus.playback = true;
  EXPECT_EQ(owner_of(focus), KeyOwner::playback);
  focus.panel = true;
  EXPECT_EQ(owner_of(focus), KeyOwner::panel);
  focus.dialog = "add model";
  focus.modal = true;
  EXPECT_EQ(owner_of(focus), KeyOwner::dialog);
  focus.question = true;
  EXPECT_EQ(owner_of(focus), KeyOwner::question);
  focus.popup = true;
  EXPECT_EQ(owner_of(focus), KeyOwner::popup);
  focus.text = true;
  EXPECT_EQ(owner_of(focus), KeyOwner::text);
}

TEST(Focus, WhatIsOnlyReadLeavesTheKeysToTheView) {
  std::set<std::string_view> to_the_view;
  for (const DialogKind& kind : dialog_kinds()) {
    const KeyOwner owner = owner_of({.dialog = kind.name, .modal = kind.modal()});
    EXPECT_EQ(owner, kind.modal() ? KeyOwner::dialog : KeyOwner::view) << kind.name;
    if (owner == KeyOwner::view) to_the_view.insert(kind.name);
  }
  EXPECT_EQ(to_the_view, (std::set<std::string_view>{"help", "messages", "about", "experiments",
                                                     "sweep", "plot"}));
}

TEST(HeldKeys, KeyHeldWhileTheFocusChangesIsStaleUntilItIsPressedAgain) {
  HeldKeys keys;
  keys.press(GLFW_KEY_O);
  EXPECT_FALSE(keys.stale(GLFW_KEY_O));
  keys.set_focus({.dialog = "open session", .modal = true});
  EXPECT_TRUE(keys.stale(GLFW_KEY_O));
  EXPECT_FALSE(keys.stale(GLFW_KEY_X)) << "was not down";
  keys.set_focus({.text = true, .dialog = "open session", .modal = true});
  EXPECT_TRUE(keys.stale(GLFW_KEY_O)) << "as long as it is held";
  keys.release(GLFW_KEY_O);
  keys.press(GLFW_KEY_O);
  EXPECT_FALSE(keys.stale(GLFW_KEY_O));
}

TEST(HeldKeys, SameFocusMakesNothingStale) {
  HeldKeys keys;
  keys.set_focus({.text = true});
  keys.press(GLFW_KEY_A);
  keys.set_focus({.text = true});
  EXPECT_FALSE(keys.stale(GLFW_KEY_A));
}

TEST(HeldKeys, ModifiersAndUnknownKeysAreNeverStale) {
  HeldKeys keys;
  for (const int key : {GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_SHIFT, GLFW_KEY_UNKNOWN, 100000}) {
    keys.press(key);
    keys.set_focus({.text = true});
    EXPECT_FALSE(keys.stale(key)) << key;
    keys.release(key);
    keys.set_focus({});
  }
}

TEST(HeldKeys, KeyThatWasLetGoBeforeTheFocusChangesIsNotStale) {
  HeldKeys keys;
  for (const int key : {0, GLFW_KEY_O, HeldKeys::kKeys - 1}) {
    keys.press(key);
    keys.release(key);
  }
  keys.press(GLFW_KEY_P);
  keys.set_focus({.playback = true});
  for (const int key : {0, GLFW_KEY_O, HeldKeys::kKeys - 1}) EXPECT_FALSE(keys.stale(key)) << key;
  EXPECT_TRUE(keys.stale(GLFW_KEY_P));
  keys.release(GLFW_KEY_P);
  EXPECT_FALSE(keys.stale(GLFW_KEY_P)) << "its character may come later";
  keys.set_focus({.selection = true});
  EXPECT_FALSE(keys.stale(GLFW_KEY_P));
  EXPECT_FALSE(keys.stale(-1));
  EXPECT_FALSE(keys.stale(HeldKeys::kKeys));
}

TEST(HeldKeys, ModifiersAreShiftControlAltAndSuperOfBothSides) {
  std::set<int> modifiers;
  for (int key = 0; key <= GLFW_KEY_LAST; ++key) {
    if (is_modifier(key)) modifiers.insert(key);
  }
  EXPECT_EQ(modifiers,
            (std::set<int>{GLFW_KEY_LEFT_SHIFT, GLFW_KEY_LEFT_CONTROL, GLFW_KEY_LEFT_ALT,
                           GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SHIFT, GLFW_KEY_RIGHT_CONTROL,
                           GLFW_KEY_RIGHT_ALT, GLFW_KEY_RIGHT_SUPER}));
}

}  // namespace
}  // namespace limpid
