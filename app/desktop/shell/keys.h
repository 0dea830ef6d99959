// What keys and mouse do: one table for what acts, one list for the help.
#pragma once

#include <span>

#include "app/desktop/base/action.h"
#include "app/desktop/shell/focus.h"

namespace limpid {

struct Shortcut {
  const char* keys;
  const char* what;
};
std::span<const Shortcut> shortcuts();

// What a key does for its owner; `repeated` while it is held down. Key and modifiers as GLFW names
// them.
Action action_of(KeyOwner owner, int key, int modifiers, bool repeated);

}  // namespace limpid
