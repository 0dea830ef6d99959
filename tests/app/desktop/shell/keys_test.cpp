// Every key there is against what the help says of it.
#include "app/desktop/shell/keys.h"

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
  Action live;
  Action playback;
  bool repeats = false;
};

// By hand from the help, not from the program's table.
const Case kCases[] = {
    {"1", GLFW_KEY_1, 0, Action::front_view, Action::front_view},
    {"2", GLFW_KEY_2, 0, Action::side_view, Action::side_view},
    {"3", GLFW_KEY_3, 0, Action::top_view, Action::top_view},
    {"0", GLFW_KEY_0, 0, Action::reset_camera, Action::reset_camera},
    {"C", GLFW_KEY_C, 0, Action::toggle_coupling, Action::toggle_coupling},
    {"B", GLFW_KEY_B, 0, Action::toggle_twin, Action::toggle_twin},
    {"Shift+B", GLFW_KEY_B, kShift, Action::toggle_overlay, Action::toggle_overlay},
    {"[", GLFW_KEY_LEFT_BRACKET, 0, Action::smaller_eta, Action::smaller_eta, true},
    {"]", GLFW_KEY_RIGHT_BRACKET, 0, Action::larger_eta, Action::larger_eta, true},
    {"Shift+[", GLFW_KEY_LEFT_BRACKET, kShift, Action::smaller_alpha, Action::smaller_alpha, true},
    {"Shift+]", GLFW_KEY_RIGHT_BRACKET, kShift, Action::larger_alpha, Action::larger_alpha, true},
    {"Ctrl+[", GLFW_KEY_LEFT_BRACKET, kControl, Action::softer_coupling, Action::softer_coupling,
     true},
    {"Ctrl+]", GLFW_KEY_RIGHT_BRACKET, kControl, Action::stiffer_coupling, Action::stiffer_coupling,
     true},
    {"Alt+[", GLFW_KEY_LEFT_BRACKET, GLFW_MOD_ALT, Action::softer_grip, Action::softer_grip, true},
    {"Alt+]", GLFW_KEY_RIGHT_BRACKET, GLFW_MOD_ALT, Action::stiffer_grip, Action::stiffer_grip,
     true},
    {"F", GLFW_KEY_F, 0, Action::toggle_force, Action::toggle_force},
    {"Backspace", GLFW_KEY_BACKSPACE, 0, Action::start_over, Action::back_to_live},
    {"R", GLFW_KEY_R, 0, Action::toggle_recording, Action::toggle_recording},
    {"P", GLFW_KEY_P, 0, Action::toggle_playing, Action::toggle_playing},
    {"Left", GLFW_KEY_LEFT, 0, Action::none, Action::tick_back, true},
    {"Right", GLFW_KEY_RIGHT, 0, Action::none, Action::tick_on, true},
    {"Shift+Left", GLFW_KEY_LEFT, kShift, Action::none, Action::step_back, true},
    {"Shift+Right", GLFW_KEY_RIGHT, kShift, Action::none, Action::step_on, true},
    {"Home", GLFW_KEY_HOME, 0, Action::none, Action::to_the_beginning},
    {"L", GLFW_KEY_L, 0, Action::none, Action::toggle_loop},
    {"E", GLFW_KEY_E, 0, Action::none, Action::rerun},
    {"N", GLFW_KEY_N, 0, Action::add_plot, Action::add_plot},
    {"Ctrl+L", GLFW_KEY_L, kControl, Action::layouts, Action::layouts},
    {"Ctrl+P", GLFW_KEY_P, kControl, Action::presets, Action::presets},
    {"V", GLFW_KEY_V, 0, Action::none, Action::write_video},
    {"X", GLFW_KEY_X, 0, Action::freeze_plots, Action::freeze_plots},
    {"G", GLFW_KEY_G, 0, Action::toggle_ghost, Action::toggle_ghost},
    {"M", GLFW_KEY_M, 0, Action::toggle_lens, Action::toggle_lens},
    {"F1", GLFW_KEY_F1, 0, Action::toggle_help, Action::toggle_help},
    {"?", GLFW_KEY_SLASH, kShift, Action::toggle_help, Action::toggle_help},
    {"F2", GLFW_KEY_F2, 0, Action::toggle_left, Action::toggle_left},
    {"F3", GLFW_KEY_F3, 0, Action::toggle_right, Action::toggle_right},
    {"F4", GLFW_KEY_F4, 0, Action::toggle_plots, Action::toggle_plots},
    {"F5", GLFW_KEY_F5, 0, Action::toggle_experiments, Action::toggle_experiments},
    {"F6", GLFW_KEY_F6, 0, Action::toggle_sweep, Action::toggle_sweep},
    {"F7", GLFW_KEY_F7, 0, Action::toggle_identify, Action::toggle_identify},
    {"F11", GLFW_KEY_F11, 0, Action::full_screen, Action::full_screen},
    {"F12", GLFW_KEY_F12, 0, Action::save_picture, Action::save_picture},
    {"Ctrl+O", GLFW_KEY_O, kControl, Action::open_session, Action::open_session},
    {"Ctrl+Q", GLFW_KEY_Q, kControl, Action::quit, Action::quit},
    {"Ctrl+Z", GLFW_KEY_Z, kControl, Action::undo, Action::undo, true},
    {"Ctrl+Y", GLFW_KEY_Y, kControl, Action::redo, Action::redo, true},
    {"Ctrl+Shift+Z", GLFW_KEY_Z, kControl | kShift, Action::redo, Action::redo, true},
    {"Ctrl+G", GLFW_KEY_G, kControl, Action::gallery, Action::gallery},
    {"Ctrl+M", GLFW_KEY_M, kControl, Action::add_model, Action::add_model},
    {"Ctrl+S", GLFW_KEY_S, kControl, Action::save_scene, Action::save_scene},
    {"Ctrl+Shift+S", GLFW_KEY_S, kControl | kShift, Action::save_scene_as, Action::save_scene_as},
    {"Tab", GLFW_KEY_TAB, 0, Action::select_next, Action::select_next, true},
    {"Shift+Tab", GLFW_KEY_TAB, kShift, Action::select_previous, Action::select_previous, true},
    {"Delete", GLFW_KEY_DELETE, 0, Action::remove_selected, Action::remove_selected},
    {"Ctrl+D", GLFW_KEY_D, kControl, Action::duplicate_selected, Action::duplicate_selected},
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
  for (const char* other :
       {"left drag", "right drag", "Alt+left drag", "middle drag", "Shift+right drag", "wheel",
        "plots", "sliders", "gamepad", "Esc", "Space"}) {
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
      EXPECT_EQ(action_of(KeyOwner::view, key, modifiers, false), c ? c->live : Action::none)
          << key << " with " << modifiers;
      EXPECT_EQ(action_of(KeyOwner::playback, key, modifiers, false),
                c ? c->playback : Action::none)
          << key << " with " << modifiers;
    }
  }
}

TEST(Keys, HeldKeySwitchesNothingToAndFro) {
  for (const Case& c : kCases) {
    EXPECT_EQ(action_of(KeyOwner::playback, c.key, c.modifiers, true),
              c.repeats ? c.playback : Action::none)
        << c.help;
  }
}

TEST(Keys, NoneActsThroughATextFieldADialogOrAMenu) {
  for (const KeyOwner owner : {KeyOwner::text, KeyOwner::dialog, KeyOwner::popup}) {
    for (int key = GLFW_KEY_SPACE + 1; key <= GLFW_KEY_LAST; ++key) {
      if (key == GLFW_KEY_ESCAPE) continue;
      for (int modifiers = 0; modifiers < 16; ++modifiers) {
        EXPECT_EQ(action_of(owner, key, modifiers, false), Action::none) << key;
      }
    }
  }
}

TEST(Keys, QuestionKnowsEnterAndDOnly) {
  const std::map<int, Action> answers{{GLFW_KEY_ENTER, Action::save_and_leave},
                                      {GLFW_KEY_KP_ENTER, Action::save_and_leave},
                                      {GLFW_KEY_D, Action::discard_and_leave}};
  for (int key = GLFW_KEY_SPACE + 1; key <= GLFW_KEY_LAST; ++key) {
    if (key == GLFW_KEY_ESCAPE) continue;
    const auto found = answers.find(key);
    EXPECT_EQ(action_of(KeyOwner::question, key, 0, false),
              found == answers.end() ? Action::none : found->second)
        << key;
    EXPECT_EQ(action_of(KeyOwner::question, key, 0, true), Action::none) << key;
    for (int modifiers = 1; modifiers < 16; ++modifiers) {
      EXPECT_EQ(action_of(KeyOwner::question, key, modifiers, false), Action::none) << key;
    }
  }
}

TEST(Keys, EscapeAlwaysAndSpaceOutsideOfTextCutTheForce) {
  for (const KeyOwner owner : kOwners) {
    for (int modifiers = 0; modifiers < 16; ++modifiers) {
      EXPECT_EQ(action_of(owner, GLFW_KEY_ESCAPE, modifiers, false), Action::escape);
      EXPECT_EQ(action_of(owner, GLFW_KEY_SPACE, modifiers, false),
                owner == KeyOwner::text ? Action::none : Action::cut_force);
    }
    EXPECT_EQ(action_of(owner, GLFW_KEY_ESCAPE, 0, true), Action::none)
        << "held, it closes one thing";
  }
}

}  // namespace
}  // namespace limpid
