// What keys and mouse do: one list for the handler's readers and for the help.
#pragma once

#include <span>

#include "app/desktop/window.h"
#include "app/desktop/workbench.h"

namespace limpid {

struct Shortcut {
  const char* keys;
  const char* what;
};
std::span<const Shortcut> shortcuts();

// Carries out the keys pressed in this frame.
void handle_keys(Workbench& bench, Window& window);

}  // namespace limpid
