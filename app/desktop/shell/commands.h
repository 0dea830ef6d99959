// Commands of the window, in one table. Menus, keys and the help are made of it; all else runs a
// command by its id.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/desktop/shell/focus.h"
#include "app/desktop/shell/input.h"

namespace limpid {

class Desktop;

// Place where a command's keys act.
enum class Reach : std::uint8_t {
  view,          // also in playback and with a selection, unless a command of those has the key
  playback,      // while a recording is shown
  selection,     // while an object of the scene is selected
  transform,     // while the selected object follows the mouse
  panel,         // as view, and while keys lead through a panel
  question,      // in the question about unsaved changes
  all_but_text,  // always, with any modifiers, but not while the user types
  all,           // always, with any modifiers
};

struct Command {
  struct Label {
    const char* text;
    const char* keys;  // null: those of the command
  };
  struct How {
    bool apart = false;  // has a line above it in its menu
    Reach reach = Reach::view;
    bool repeats = false;                              // while its key is held
    Label (*now)(const Desktop&) = nullptr;            // its present label in the menu
    std::string (*why_not)(const Desktop&) = nullptr;  // for people; empty or null: it can be run
    bool (*checked)(const Desktop&) = nullptr;         // has a mark in the menu
    bool blind = false;  // can be run while a program hides law, settings and plots
  };

  const char* id;    // never changes: "edit.undo"
  const char* text;  // in its menu and in lists of commands
  const char* menu;  // "View", "View/Layouts"; null: none
  const char* keys;  // "Ctrl+Y, Ctrl+Shift+Z", the first one for the menu; null: none
  const char* help;  // in the list of keys; null: its text, "": shares the line before
  void (*run)(Desktop&);
  How how = {};
};

// Returns all commands, in the order of menus and help.
std::span<const Command> commands();
const Command* find_command(std::string_view id);  // null: there is none
// Kind of user who runs a command. Programs on the control socket may run what they hide from
// people.
enum class Asker : std::uint8_t { person, program };
// Returns why the command cannot be run now, for people; empty: it can.
std::string why_not(const Command& command, const Desktop& desktop, Asker who = Asker::person);
// Runs a command. Returns why it was not run, for people: the id is unknown, or it cannot be run
// now; empty if it was. Errors: as the command.
std::string run_command(std::string_view id, Desktop& desktop, Asker who = Asker::person);
// Runs a command for the person at the window: a notice says why not.
void run_or_say(std::string_view id, Desktop& desktop);

// Returns the command of a key for its owner; null: none. `repeated` presses count only for
// commands that repeat.
const Command* command_of(KeyOwner owner, const KeyPress& press);
// Runs the commands of the keys pressed in this frame.
void handle_keys(std::span<const KeyPress> pressed, Desktop& desktop);

// Returns "Ctrl+Shift+S", the command's first key, with this keyboard's labels; empty without a
// key.
std::string key_text(const Command& command, const KeyLabels& labels);

// Line of the help on keys and mouse; shortcuts() returns them group after group.
struct Shortcut {
  std::string_view group;
  std::string keys, what;
};
std::vector<Shortcut> shortcuts(const KeyLabels& labels);

}  // namespace limpid
