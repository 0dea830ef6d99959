// Carries out what keys, menus and buttons ask for.
#pragma once

#include "app/desktop/base/action.h"
#include "app/desktop/shell/desktop.h"
#include "app/desktop/shell/window.h"

namespace limpid {

// Those of playback act only while a recording is shown.
void carry_out(Action action, Desktop& desktop, Window& window);

// Those of the keys pressed in this frame.
void handle_keys(Desktop& desktop, Window& window);

}  // namespace limpid
