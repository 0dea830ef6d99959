// Keys of commands: which command a key runs for its owner, and the help that lists them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/desktop/shell/commands.h"
#include "app/desktop/shell/focus.h"
#include "app/desktop/shell/input.h"

namespace limpid {

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
