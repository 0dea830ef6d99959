// Every key there is against what the help says of it.
#include "app/desktop/keys.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <vector>

namespace limpid {
namespace {

constexpr int kShift = GLFW_MOD_SHIFT, kControl = GLFW_MOD_CONTROL;
constexpr KeyOwner kOwners[] = {KeyOwner::view,  KeyOwner::playback, KeyOwner::dialog,
                                KeyOwner::popup, KeyOwner::question, KeyOwner::text};

struct Case {
  const char* help;  // as the list of shortcuts writes it
  int key;
  int modifiers;
  KeyAction live;
  KeyAction playback;
  bool repeats = false;
};

// By hand from the help, not from the program's table.
const Case kCases[] = {
    {"1", GLFW_KEY_1, 0, KeyAction::front_view, KeyAction::front_view},
    {"2", GLFW_KEY_2, 0, KeyAction::side_view, KeyAction::side_view},
    {"3", GLFW_KEY_3, 0, KeyAction::top_view, KeyAction::top_view},
    {"0", GLFW_KEY_0, 0, KeyAction::reset_camera, KeyAction::reset_camera},
    {"C", GLFW_KEY_C, 0, KeyAction::toggle_coupling, KeyAction::toggle_coupling},
    {"[", GLFW_KEY_LEFT_BRACKET, 0, KeyAction::smaller_eta, KeyAction::smaller_eta, true},
    {"]", GLFW_KEY_RIGHT_BRACKET, 0, KeyAction::larger_eta, KeyAction::larger_eta, true},
    {"F", GLFW_KEY_F, 0, KeyAction::toggle_force, KeyAction::toggle_force},
    {"Backspace", GLFW_KEY_BACKSPACE, 0, KeyAction::start_over, KeyAction::back_to_live},
    {"R", GLFW_KEY_R, 0, KeyAction::toggle_recording, KeyAction::toggle_recording},
    {"P", GLFW_KEY_P, 0, KeyAction::toggle_playing, KeyAction::toggle_playing},
    {"Left", GLFW_KEY_LEFT, 0, KeyAction::none, KeyAction::tick_back, true},
    {"Right", GLFW_KEY_RIGHT, 0, KeyAction::none, KeyAction::tick_on, true},
    {"Shift+Left", GLFW_KEY_LEFT, kShift, KeyAction::none, KeyAction::step_back, true},
    {"Shift+Right", GLFW_KEY_RIGHT, kShift, KeyAction::none, KeyAction::step_on, true},
    {"Home", GLFW_KEY_HOME, 0, KeyAction::none, KeyAction::to_the_beginning},
    {"L", GLFW_KEY_L, 0, KeyAction::none, KeyAction::toggle_loop},
    {"E", GLFW_KEY_E, 0, KeyAction::none, KeyAction::rerun},
    {"X", GLFW_KEY_X, 0, KeyAction::freeze_plots, KeyAction::freeze_plots},
    {"G", GLFW_KEY_G, 0, KeyAction::toggle_ghost, KeyAction::toggle_ghost},
    {"F1", GLFW_KEY_F1, 0, KeyAction::toggle_help, KeyAction::toggle_help},
    {"?", GLFW_KEY_SLASH, kShift, KeyAction::toggle_help, KeyAction::toggle_help},
    {"F2", GLFW_KEY_F2, 0, KeyAction::toggle_left, KeyAction::toggle_left},
    {"F3", GLFW_KEY_F3, 0, KeyAction::toggle_right, KeyAction::toggle_right},
    {"F4", GLFW_KEY_F4, 0, KeyAction::toggle_plots, KeyAction::toggle_plots},
    {"F5", GLFW_KEY_F5, 0, KeyAction::toggle_experiments, KeyAction::toggle_experiments},
    {"F11", GLFW_KEY_F11, 0, KeyAction::full_screen, KeyAction::full_screen},
    {"F12", GLFW_KEY_F12, 0, KeyAction::save_picture, KeyAction::save_picture},
    {"Ctrl+O", GLFW_KEY_O, kControl, KeyAction::open_session, KeyAction::open_session},
    {"Ctrl+Q", GLFW_KEY_Q, kControl, KeyAction::quit, KeyAction::quit},
    {"Ctrl+Z", GLFW_KEY_Z, kControl, KeyAction::undo, KeyAction::undo, true},
    {"Ctrl+Y", GLFW_KEY_Y, kControl, KeyAction::redo, KeyAction::redo, true},
    {"Ctrl+Shift+Z", GLFW_KEY_Z, kControl | kShift, KeyAction::redo, KeyAction::redo, true},
    {"Ctrl+G", GLFW_KEY_G, kControl, KeyAction::gallery, KeyAction::gallery},
    {"Ctrl+M", GLFW_KEY_M, kControl, KeyAction::add_model, KeyAction::add_model},
    {"Ctrl+S", GLFW_KEY_S, kControl, KeyAction::save_scene, KeyAction::save_scene},
    {"Ctrl+Shift+S", GLFW_KEY_S, kControl | kShift, KeyAction::save_scene_as,
     KeyAction::save_scene_as},
    {"Tab", GLFW_KEY_TAB, 0, KeyAction::select_next, KeyAction::select_next, true},
    {"Shift+Tab", GLFW_KEY_TAB, kShift, KeyAction::select_previous, KeyAction::select_previous,
     true},
    {"Delete", GLFW_KEY_DELETE, 0, KeyAction::remove_selected, KeyAction::remove_selected},
    {"Ctrl+D", GLFW_KEY_D, kControl, KeyAction::duplicate_selected, KeyAction::duplicate_selected},
};

const Case* case_of(int key, int modifiers) {
  for (const Case& c : kCases) {
    if (c.key == key && c.modifiers == modifiers) return &c;
  }
  return nullptr;
}

// "Ctrl+Z, Ctrl+Y" -> both.
std::vector<std::string> split(std::string text) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; (at = text.find(", ")) != std::string::npos;) {
    parts.push_back(text.substr(0, at));
    text.erase(0, at + 2);
  }
  parts.push_back(text);
  return parts;
}

TEST(Keys, HelpListsExactlyTheKeysThatAct) {
  // What the mouse does, and Esc and Space, which have tests of their own.
  std::set<std::string> listed;
  for (const Shortcut& shortcut : shortcuts()) {
    // "[, ]" and the like; what the mouse does is written in words.
    for (const std::string& key : split(shortcut.keys)) listed.insert(key);
  }
  for (const char* other : {"left drag", "right drag", "Alt+left drag", "middle drag",
                            "Shift+right drag", "wheel", "plots", "sliders", "Esc", "Space"}) {
    EXPECT_EQ(listed.erase(other), 1u) << other;
  }
  std::set<std::string> expected;
  for (const Case& c : kCases) expected.insert(c.help);
  EXPECT_EQ(listed, expected);
}

TEST(Keys, EachDoesWhatTheHelpSaysAndNothingUnlistedActs) {
  for (int key = GLFW_KEY_SPACE + 1; key <= GLFW_KEY_LAST; ++key) {
    if (key == GLFW_KEY_ESCAPE) continue;
    for (int modifiers = 0; modifiers < 16; ++modifiers) {
      const Case* c = case_of(key, modifiers);
      EXPECT_EQ(action_of(KeyOwner::view, key, modifiers, false), c ? c->live : KeyAction::none)
          << key << " with " << modifiers;
      EXPECT_EQ(action_of(KeyOwner::playback, key, modifiers, false),
                c ? c->playback : KeyAction::none)
          << key << " with " << modifiers;
    }
  }
}

TEST(Keys, HeldKeySwitchesNothingToAndFro) {
  for (const Case& c : kCases) {
    EXPECT_EQ(action_of(KeyOwner::playback, c.key, c.modifiers, true),
              c.repeats ? c.playback : KeyAction::none)
        << c.help;
  }
}

TEST(Keys, NoneActsThroughATextFieldADialogOrAMenu) {
  for (const KeyOwner owner : {KeyOwner::text, KeyOwner::dialog, KeyOwner::popup}) {
    for (int key = GLFW_KEY_SPACE + 1; key <= GLFW_KEY_LAST; ++key) {
      if (key == GLFW_KEY_ESCAPE) continue;
      for (int modifiers = 0; modifiers < 16; ++modifiers) {
        EXPECT_EQ(action_of(owner, key, modifiers, false), KeyAction::none) << key;
      }
    }
  }
}

TEST(Keys, QuestionKnowsEnterAndDOnly) {
  const std::map<int, KeyAction> answers{{GLFW_KEY_ENTER, KeyAction::save_and_leave},
                                         {GLFW_KEY_KP_ENTER, KeyAction::save_and_leave},
                                         {GLFW_KEY_D, KeyAction::discard_and_leave}};
  for (int key = GLFW_KEY_SPACE + 1; key <= GLFW_KEY_LAST; ++key) {
    if (key == GLFW_KEY_ESCAPE) continue;
    const auto found = answers.find(key);
    EXPECT_EQ(action_of(KeyOwner::question, key, 0, false),
              found == answers.end() ? KeyAction::none : found->second)
        << key;
    EXPECT_EQ(action_of(KeyOwner::question, key, 0, true), KeyAction::none) << key;
    for (int modifiers = 1; modifiers < 16; ++modifiers) {
      EXPECT_EQ(action_of(KeyOwner::question, key, modifiers, false), KeyAction::none) << key;
    }
  }
}

TEST(Keys, EscapeAlwaysAndSpaceOutsideOfTextCutTheForce) {
  for (const KeyOwner owner : kOwners) {
    for (int modifiers = 0; modifiers < 16; ++modifiers) {
      EXPECT_EQ(action_of(owner, GLFW_KEY_ESCAPE, modifiers, false), KeyAction::escape);
      EXPECT_EQ(action_of(owner, GLFW_KEY_SPACE, modifiers, false),
                owner == KeyOwner::text ? KeyAction::none : KeyAction::cut_force);
    }
    EXPECT_EQ(action_of(owner, GLFW_KEY_ESCAPE, 0, true), KeyAction::none)
        << "held, it closes one thing";
  }
}

}  // namespace
}  // namespace limpid
