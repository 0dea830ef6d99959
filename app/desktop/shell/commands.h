// What can be done in the window, in one table: menus, keys and the help are made of it, and
// whoever else runs a command names it by its id.
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

// Where a command's keys act.
enum class Reach : std::uint8_t {
  view,          // in playback, too, and with something selected, unless a command of those has the
                 // key
  playback,      //
  selection,     // while an object of the scene is selected
  transform,     // while that follows the mouse
  question,      // about unsaved changes
  all_but_text,  // whatever is open, with any modifiers; not while somebody types
  all,           // the same, also while somebody types
};

struct Command {
  struct Label {
    const char* text;
    const char* keys;  // null: those of the table
  };
  struct How {
    bool apart = false;  // has a line above it in its menu
    Reach reach = Reach::view;
    bool repeats = false;                              // while its key is held
    Label (*now)(const Desktop&) = nullptr;            // what the menu says instead of its text
    std::string (*why_not)(const Desktop&) = nullptr;  // for people; empty or null: it can be run
    bool (*checked)(const Desktop&) = nullptr;         // its mark in the menu
    bool blind = false;  // also while a program hides law, settings and plots
  };

  const char* id;    // never changes: "edit.undo"
  const char* text;  // in its menu, and wherever commands are listed
  const char* menu;  // "View", "View/Layouts"; null: in none
  const char* keys;  // "Ctrl+Y, Ctrl+Shift+Z", the first one for the menu; null: none
  const char* help;  // in the list of keys; null: its text, "": in the line of the one before it
  void (*run)(Desktop&);
  How how = {};
};

// In the order of menus and help.
std::span<const Command> commands();
const Command* find_command(std::string_view id);  // null: there is none
// Who runs a command: programs on the control socket are not kept from what they hide.
enum class Asker : std::uint8_t { person, program };
// Why it cannot be run now, for people; empty: it can.
std::string why_not(const Command& command, const Desktop& desktop, Asker who = Asker::person);
// Returns why it was not run, for people: there is none of that id, or it cannot be run now; empty
// if it was. Errors: as what it does.
std::string run_command(std::string_view id, Desktop& desktop, Asker who = Asker::person);
// The same for who looks at the window: a notice says why.
void run_or_say(std::string_view id, Desktop& desktop);

// What a key does for its owner, `repeated` while it is held down; null: nothing.
const Command* command_of(KeyOwner owner, const KeyPress& press);
// Runs those of the keys pressed in this frame.
void handle_keys(std::span<const KeyPress> pressed, Desktop& desktop);

// "Ctrl+Shift+S", of its first key, as it stands on this keyboard; empty without one.
std::string key_text(const Command& command, const KeyLabels& labels);

// What keys and mouse do, for the help: group after group.
struct Shortcut {
  std::string_view group;
  std::string keys, what;
};
std::vector<Shortcut> shortcuts(const KeyLabels& labels);

}  // namespace limpid
