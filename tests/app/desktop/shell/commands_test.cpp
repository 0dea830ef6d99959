// The table of commands by itself, and every key against the help's list.
#include "app/desktop/shell/commands.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "app/desktop/shell/command_keys.h"
#include "core/tick/parameters.h"

namespace limpid {
namespace {

constexpr int kShift = GLFW_MOD_SHIFT, kControl = GLFW_MOD_CONTROL;
constexpr KeyOwner kOwners[] = {KeyOwner::view,      KeyOwner::playback, KeyOwner::selection,
                                KeyOwner::transform, KeyOwner::dialog,   KeyOwner::panel,
                                KeyOwner::popup,     KeyOwner::question, KeyOwner::text};

struct Case {
  const char* help;  // keys as written in the list of shortcuts
  int key;
  int modifiers;
  const char *live, *playback;  // ids of commands; empty: none
  bool repeats = false;
  const char* selected = nullptr;  // id with an object selected; null: the same as without
  const char* following = "";      // id while the object follows the mouse
};

// Written by hand from the help, not from the program's table.
const Case kCases[] = {
    {"1", GLFW_KEY_1, 0, "view.front", "view.front"},
    {"2", GLFW_KEY_2, 0, "view.side", "view.side"},
    {"3", GLFW_KEY_3, 0, "view.top", "view.top"},
    {"0", GLFW_KEY_0, 0, "view.reset", "view.reset"},
    {"C", GLFW_KEY_C, 0, "coupling.next", "coupling.next"},
    {"B", GLFW_KEY_B, 0, "session.twin", "session.twin"},
    {"Shift+B", GLFW_KEY_B, kShift, "view.overlay", "view.overlay"},
    {"Ctrl+B", GLFW_KEY_B, kControl, "session.add_run", "session.add_run"},
    {"Ctrl+Shift+B", GLFW_KEY_B, kControl | kShift, "session.drop_run", "session.drop_run"},
    {"[", GLFW_KEY_LEFT_BRACKET, 0, "coupling.smaller_eta", "coupling.smaller_eta", true},
    {"]", GLFW_KEY_RIGHT_BRACKET, 0, "coupling.larger_eta", "coupling.larger_eta", true},
    {"Shift+[", GLFW_KEY_LEFT_BRACKET, kShift, "observer.smaller_alpha", "observer.smaller_alpha",
     true},
    {"Shift+]", GLFW_KEY_RIGHT_BRACKET, kShift, "observer.larger_alpha", "observer.larger_alpha",
     true},
    {"Ctrl+[", GLFW_KEY_LEFT_BRACKET, kControl, "coupling.softer", "coupling.softer", true},
    {"Ctrl+]", GLFW_KEY_RIGHT_BRACKET, kControl, "coupling.stiffer", "coupling.stiffer", true},
    {"Alt+[", GLFW_KEY_LEFT_BRACKET, GLFW_MOD_ALT, "hand.softer", "hand.softer", true},
    {"Alt+]", GLFW_KEY_RIGHT_BRACKET, GLFW_MOD_ALT, "hand.stiffer", "hand.stiffer", true},
    {"F", GLFW_KEY_F, 0, "device.force", "device.force"},
    {"Backspace", GLFW_KEY_BACKSPACE, 0, "device.start_over", "session.back_to_live"},
    {"R", GLFW_KEY_R, 0, "session.record", "session.record", false, "object.turn", "object.turn"},
    {"Ctrl+R", GLFW_KEY_R, kControl, "session.record", "session.record"},
    {"P", GLFW_KEY_P, 0, "session.play", "session.play"},
    {"K", GLFW_KEY_K, 0, "loop.pause", "loop.pause"},
    {"T", GLFW_KEY_T, 0, "session.mark", "session.mark"},
    {"Ctrl+Left", GLFW_KEY_LEFT, kControl, "", "session.mark_before", true},
    {"Ctrl+Right", GLFW_KEY_RIGHT, kControl, "", "session.mark_after", true},
    {"Left", GLFW_KEY_LEFT, 0, "", "session.tick_back", true},
    {"Right", GLFW_KEY_RIGHT, 0, "loop.step", "session.tick_on", true},
    {"Shift+Left", GLFW_KEY_LEFT, kShift, "", "session.step_back", true},
    {"Shift+Right", GLFW_KEY_RIGHT, kShift, "loop.step_ten", "session.step_on", true},
    {"Home", GLFW_KEY_HOME, 0, "view.reset", "session.to_the_beginning"},
    {".", GLFW_KEY_PERIOD, 0, "scene.look", "scene.look"},
    {"H", GLFW_KEY_H, 0, "hand.magnet", "hand.magnet"},
    {"S", GLFW_KEY_S, 0, "", "", false, "object.scale", "object.scale"},
    {"Y", GLFW_KEY_Y, 0, "", "", false, "", "object.along_y"},
    {"Z", GLFW_KEY_Z, 0, "", "", false, "", "object.along_z"},
    {"Enter", GLFW_KEY_ENTER, 0, "", "", false, "", "object.accept"},
    {"Keypad Enter", GLFW_KEY_KP_ENTER, 0, "", "", false, "", "object.accept"},
    {"L", GLFW_KEY_L, 0, "", "session.loop"},
    {"E", GLFW_KEY_E, 0, "", "session.rerun"},
    {"N", GLFW_KEY_N, 0, "plots.add", "plots.add"},
    {"Ctrl+L", GLFW_KEY_L, kControl, "plots.layouts", "plots.layouts"},
    {"Ctrl+P", GLFW_KEY_P, kControl, "settings.presets", "settings.presets"},
    {"V", GLFW_KEY_V, 0, "", "session.write_video"},
    {"X", GLFW_KEY_X, 0, "plots.freeze", "plots.freeze", false, nullptr, "object.along_x"},
    {"G", GLFW_KEY_G, 0, "view.ghost", "view.ghost", false, "object.move", "object.move"},
    {"M", GLFW_KEY_M, 0, "view.lens", "view.lens"},
    {"F1", GLFW_KEY_F1, 0, "help.keys", "help.keys"},
    {"?", GLFW_KEY_SLASH, kShift, "help.keys", "help.keys"},
    {"F2", GLFW_KEY_F2, 0, "view.left_panel", "view.left_panel"},
    {"F3", GLFW_KEY_F3, 0, "view.right_panel", "view.right_panel"},
    {"F4", GLFW_KEY_F4, 0, "view.plots", "view.plots"},
    {"F5", GLFW_KEY_F5, 0, "experiments.show", "experiments.show"},
    {"F6", GLFW_KEY_F6, 0, "sweep.show", "sweep.show"},
    {"F8", GLFW_KEY_F8, 0, "view.everything", "view.everything"},
    {"F7", GLFW_KEY_F7, 0, "device.identify", "device.identify"},
    {"F10", GLFW_KEY_F10, 0, "window.menu", "window.menu"},
    {"Ctrl++", GLFW_KEY_EQUAL, kControl | kShift, "view.text.larger", "view.text.larger"},
    {"Ctrl+=", GLFW_KEY_EQUAL, kControl, "view.text.larger", "view.text.larger"},
    {"Ctrl+Keypad +", GLFW_KEY_KP_ADD, kControl, "view.text.larger", "view.text.larger"},
    {"Ctrl+-", GLFW_KEY_MINUS, kControl, "view.text.smaller", "view.text.smaller"},
    {"Ctrl+Keypad -", GLFW_KEY_KP_SUBTRACT, kControl, "view.text.smaller", "view.text.smaller"},
    {"Ctrl+0", GLFW_KEY_0, kControl, "view.text.usual", "view.text.usual"},
    {"Ctrl+Tab", GLFW_KEY_TAB, kControl, "window.panels", "window.panels"},
    {"F11", GLFW_KEY_F11, 0, "window.full_screen", "window.full_screen"},
    {"F12", GLFW_KEY_F12, 0, "window.save_picture", "window.save_picture"},
    {"Ctrl+E", GLFW_KEY_E, kControl, "export.begin", "export.begin"},
    {"Ctrl+O", GLFW_KEY_O, kControl, "session.open", "session.open"},
    {"Ctrl+N", GLFW_KEY_N, kControl, "scene.new", "scene.new"},
    {"Ctrl+Shift+O", GLFW_KEY_O, kControl | kShift, "scene.open", "scene.open"},
    {"Ctrl+Q", GLFW_KEY_Q, kControl, "window.quit", "window.quit"},
    {"Ctrl+Z", GLFW_KEY_Z, kControl, "edit.undo", "edit.undo", true},
    {"Ctrl+Y", GLFW_KEY_Y, kControl, "edit.redo", "edit.redo", true},
    {"Ctrl+Shift+Z", GLFW_KEY_Z, kControl | kShift, "edit.redo", "edit.redo", true},
    {"Ctrl+G", GLFW_KEY_G, kControl, "scene.gallery", "scene.gallery"},
    {"Ctrl+M", GLFW_KEY_M, kControl, "scene.add_model", "scene.add_model"},
    {"Ctrl+S", GLFW_KEY_S, kControl, "scene.save", "scene.save"},
    {"Ctrl+Shift+S", GLFW_KEY_S, kControl | kShift, "scene.save_as", "scene.save_as"},
    {"Tab", GLFW_KEY_TAB, 0, "scene.select_next", "scene.select_next", true},
    {"Shift+Tab", GLFW_KEY_TAB, kShift, "scene.select_previous", "scene.select_previous", true},
    {"Delete", GLFW_KEY_DELETE, 0, "scene.remove", "scene.remove"},
    {"Ctrl+D", GLFW_KEY_D, kControl, "scene.copy", "scene.copy"},
};

const Case* case_of(int key, int modifiers) {
  for (const Case& c : kCases) {
    if (c.key == key && c.modifiers == modifiers) return &c;
  }
  return nullptr;
}

// Id of the command that a key runs; empty: none.
std::string_view id_of(KeyOwner owner, int key, int modifiers, bool repeated) {
  const Command* command = command_of(owner, {key, modifiers, repeated});
  return command != nullptr ? command->id : "";
}

// Splits "Ctrl+Z, Ctrl+Y" into both.
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
  // Keys of the help; it also lists mouse actions, and Esc and Space, which have tests of their
  // own.
  std::set<std::string> listed;
  for (const Shortcut& shortcut : shortcuts(KeyLabels())) {
    // Texts such as "[, ]"; mouse actions are written in words.
    for (const std::string& key : split(shortcut.keys)) listed.insert(key);
  }
  for (const char* other :
       {"drag the tip with the left button", "Ctrl+left drag", "left drag elsewhere", "right drag",
        "middle drag", "Shift+right drag", "wheel", "click", "right click", "plots", "sliders",
        "gamepad", "Esc", "Space"}) {
    EXPECT_EQ(listed.erase(other), 1u) << other;
  }
  std::set<std::string> expected;
  for (const Case& c : kCases) expected.insert(c.help);
  EXPECT_EQ(listed, expected);
}

// People look at headings first: each exists once, with all keys that belong to it.
TEST(Keys, HelpGroupsThem) {
  std::vector<std::string_view> groups;
  std::map<std::string, std::string_view> group_of;
  for (const Shortcut& shortcut : shortcuts(KeyLabels())) {
    EXPECT_FALSE(shortcut.group.empty()) << shortcut.keys;
    if (groups.empty() || groups.back() != shortcut.group) groups.push_back(shortcut.group);
    for (const std::string& key : split(shortcut.keys)) group_of[key] = shortcut.group;
  }
  EXPECT_EQ(std::set(groups.begin(), groups.end()).size(), groups.size());
  EXPECT_EQ(groups.front(), "Force and hand");
  EXPECT_EQ(group_of["Esc"], group_of["Space"]);
  EXPECT_EQ(group_of["C"], group_of["Ctrl+]"]);
  EXPECT_EQ(group_of["E"], group_of["L"]);
  EXPECT_EQ(group_of["wheel"], group_of["sliders"]);
  EXPECT_NE(group_of["C"], group_of["F1"]);
}

TEST(Keys, EachDoesWhatTheHelpSaysAndNothingUnlistedActs) {
  for (int key = GLFW_KEY_SPACE + 1; key <= GLFW_KEY_LAST; ++key) {
    if (key == GLFW_KEY_ESCAPE) continue;
    for (int modifiers = 0; modifiers < 16; ++modifiers) {
      const Case* c = case_of(key, modifiers);
      EXPECT_EQ(id_of(KeyOwner::view, key, modifiers, false), std::string_view(c ? c->live : ""))
          << key << " with " << modifiers;
      EXPECT_EQ(id_of(KeyOwner::playback, key, modifiers, false),
                std::string_view(c ? c->playback : ""))
          << key << " with " << modifiers;
      const char* selected = c && c->selected != nullptr ? c->selected : c ? c->live : "";
      EXPECT_EQ(id_of(KeyOwner::selection, key, modifiers, false), std::string_view(selected))
          << key << " with " << modifiers;
      EXPECT_EQ(id_of(KeyOwner::transform, key, modifiers, false),
                std::string_view(c ? c->following : ""))
          << key << " with " << modifiers;
    }
  }
}

TEST(Keys, HeldKeySwitchesNothingToAndFro) {
  for (const Case& c : kCases) {
    EXPECT_EQ(id_of(KeyOwner::playback, c.key, c.modifiers, true),
              std::string_view(c.repeats ? c.playback : ""))
        << c.help;
  }
}

TEST(Keys, NoneActsThroughATextFieldADialogOrAMenu) {
  for (const KeyOwner owner : {KeyOwner::text, KeyOwner::dialog, KeyOwner::popup}) {
    for (int key = GLFW_KEY_SPACE + 1; key <= GLFW_KEY_LAST; ++key) {
      if (key == GLFW_KEY_ESCAPE) continue;
      for (int modifiers = 0; modifiers < 16; ++modifiers) {
        EXPECT_EQ(id_of(owner, key, modifiers, false), "") << key;
      }
    }
  }
}

TEST(Keys, OfAPanelGoOnToTheNextOneAndRunNothingElse) {
  for (int key = GLFW_KEY_SPACE + 1; key <= GLFW_KEY_LAST; ++key) {
    if (key == GLFW_KEY_ESCAPE) continue;
    for (int modifiers = 0; modifiers < 16; ++modifiers) {
      const bool on = key == GLFW_KEY_TAB && modifiers == kControl;
      EXPECT_EQ(id_of(KeyOwner::panel, key, modifiers, false), on ? "window.panels" : "") << key;
    }
  }
}

TEST(Keys, QuestionKnowsEnterAndDOnly) {
  const std::map<int, std::string> answers{{GLFW_KEY_ENTER, "scene.save_and_leave"},
                                           {GLFW_KEY_KP_ENTER, "scene.save_and_leave"},
                                           {GLFW_KEY_D, "scene.discard_and_leave"}};
  for (int key = GLFW_KEY_SPACE + 1; key <= GLFW_KEY_LAST; ++key) {
    if (key == GLFW_KEY_ESCAPE) continue;
    const auto found = answers.find(key);
    EXPECT_EQ(id_of(KeyOwner::question, key, 0, false), found == answers.end() ? "" : found->second)
        << key;
    EXPECT_EQ(id_of(KeyOwner::question, key, 0, true), "") << key;
    for (int modifiers = 1; modifiers < 16; ++modifiers) {
      EXPECT_EQ(id_of(KeyOwner::question, key, modifiers, false), "") << key;
    }
  }
}

TEST(Keys, EscapeAlwaysAndSpaceOutsideOfTextCutTheForce) {
  for (const KeyOwner owner : kOwners) {
    for (int modifiers = 0; modifiers < 16; ++modifiers) {
      EXPECT_EQ(id_of(owner, GLFW_KEY_ESCAPE, modifiers, false), "window.escape");
      EXPECT_EQ(id_of(owner, GLFW_KEY_SPACE, modifiers, false),
                owner == KeyOwner::text ? "" : "force.cut");
    }
    EXPECT_EQ(id_of(owner, GLFW_KEY_ESCAPE, 0, true), "") << "held, it closes one thing";
  }
}

// "?" is Shift and the key right of 0 on a German keyboard, and Shift and "," on a French one.
TEST(Keys, SignsAndDigitsActWhereverTheyAreWritten) {
  const auto id = [](int key, int modifiers, char writes, KeyOwner owner = KeyOwner::view) {
    const Command* command =
        command_of(owner, {key, modifiers, false, static_cast<unsigned>(writes)});
    return std::string(command != nullptr ? command->id : "");
  };
  EXPECT_EQ(id(GLFW_KEY_MINUS, kShift, '?'), "help.keys");
  EXPECT_EQ(id(GLFW_KEY_COMMA, kShift, '?'), "help.keys");
  EXPECT_EQ(id(GLFW_KEY_SEMICOLON, kShift, '.'), "scene.look");
  EXPECT_EQ(id(GLFW_KEY_UNKNOWN, 0, '['), "coupling.smaller_eta") << "with AltGr";
  EXPECT_EQ(id(GLFW_KEY_1, kShift, '1'), "view.front") << "as on a French keyboard";
  EXPECT_EQ(id(GLFW_KEY_KP_3, 0, '3'), "view.top");
  EXPECT_EQ(id(GLFW_KEY_1, kShift, '!'), "");
  EXPECT_EQ(id(GLFW_KEY_1, 0, '&'), "view.front");
  EXPECT_EQ(id(GLFW_KEY_B, kShift, 'B'), "view.overlay");
  EXPECT_EQ(id(GLFW_KEY_1, GLFW_MOD_SUPER, '1'), "") << "the desktop's";
  EXPECT_EQ(id(GLFW_KEY_MINUS, kShift, '?', KeyOwner::text), "");
}

TEST(Commands, EachHasAnIdOfItsOwnATextAndSomethingToDo) {
  std::set<std::string_view> ids;
  std::set<std::string> listed;
  for (const Command& command : commands()) {
    EXPECT_TRUE(std::regex_match(command.id, std::regex("[a-z]+(\\.[a-z_]+)+"))) << command.id;
    EXPECT_TRUE(ids.insert(command.id).second) << command.id;
    EXPECT_STRNE(command.text, "") << command.id;
    EXPECT_NE(command.run, nullptr) << command.id;
    EXPECT_EQ(find_command(command.id), &command);
    const std::string menu = command.menu != nullptr ? command.menu : "";
    EXPECT_TRUE(
        std::regex_match(menu, std::regex("|(File|Edit|View|Session|Scene|Device|Help)(/.+)?")))
        << menu;
    // Otherwise two commands of a menu could not be told apart by their texts.
    if (!menu.empty()) {
      EXPECT_TRUE(listed.insert(menu + "/" + command.text).second) << command.id;
    }
  }
  EXPECT_EQ(find_command("edit.undone"), nullptr);
}

TEST(Commands, NoneHasTheKeyOfAnotherWhereBothAct) {
  std::map<std::pair<Reach, std::string>, std::string> taken;
  for (const Command& command : commands()) {
    if (command.keys == nullptr) continue;
    for (const std::string& key : split(command.keys)) {
      const auto [at, fresh] = taken.insert({{command.how.reach, key}, command.id});
      EXPECT_TRUE(fresh) << command.id << " and " << at->second;
    }
  }
}

// A command without a menu and a key is a button of a panel, a dialog or a banner, which names it.
TEST(Commands, EachIsReachedAndPanelsNameNoOthers) {
  std::set<std::string> named;
  const auto window = std::filesystem::path(LIMPID_SOURCE_DIR) / "app/desktop";
  for (const auto& file : std::filesystem::recursive_directory_iterator(window)) {
    if (file.path().extension() != ".cpp" || file.path().filename() == "commands.cpp") continue;
    std::stringstream text;
    text << std::ifstream(file.path()).rdbuf();
    const std::string source = text.str();
    const std::regex id("\"([a-z]+\\.[a-z_.]+)\"");
    for (std::sregex_iterator i(source.begin(), source.end(), id), end; i != end; ++i) {
      const std::string name = (*i)[1];
      if (!name.ends_with(".toml")) named.insert(name);
    }
  }
  for (const Command& command : commands()) {
    EXPECT_TRUE(command.menu != nullptr || command.keys != nullptr || named.contains(command.id))
        << command.id;
  }
  std::set<std::string> begins;  // beginnings of ids, and of settings: "coupling.eta"
  for (const Command& command : commands()) {
    const std::string whole = command.id;
    begins.insert(whole.substr(0, whole.find('.')));
  }
  for (const std::string& id : named) {
    if (!begins.contains(id.substr(0, id.find('.')))) continue;
    EXPECT_TRUE(find_command(id) != nullptr || find_parameter(id) != nullptr) << id;
  }
}

TEST(Commands, KeysAreWrittenAsTheHelpHasThem) {
  const auto text = [](const char* id) { return key_text(*find_command(id), KeyLabels()); };
  EXPECT_EQ(text("scene.save_as"), "Ctrl+Shift+S");
  EXPECT_EQ(text("hand.softer"), "Alt+[");
  EXPECT_EQ(text("window.full_screen"), "F11");
  EXPECT_EQ(text("help.keys"), "?");
  EXPECT_EQ(text("scene.remove"), "Delete");
  EXPECT_EQ(text("view.trail"), "");
}

TEST(Commands, KeysAreWrittenAsTheKeyboardHasThem) {
  const KeyLabels german([](int place) -> const char* {
    if (place == GLFW_KEY_LEFT_BRACKET) return "\xC3\xBC";
    return place == GLFW_KEY_RIGHT_BRACKET ? "+" : nullptr;
  });
  EXPECT_EQ(key_text(*find_command("hand.softer"), german), "Alt+\xC3\xBC");
  EXPECT_EQ(key_text(*find_command("scene.save"), german), "Ctrl+S");
  std::set<std::string> listed;
  for (const Shortcut& shortcut : shortcuts(german)) {
    for (const std::string& key : split(shortcut.keys)) listed.insert(key);
  }
  EXPECT_TRUE(listed.contains("Ctrl++"));
  EXPECT_FALSE(listed.contains("Ctrl+]"));
}

}  // namespace
}  // namespace limpid
