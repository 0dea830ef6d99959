// The display that goes while the program runs.
#pragma once

#include <functional>

namespace limpid {

// X11's library ends the program when its display is gone, where `leave` is called first, once, on
// the thread that used the display: what is to be kept is kept there, without drawing anything.
// Does nothing where the window is not X11's. After the window is there.
void when_display_is_lost(std::function<void()> leave);

}  // namespace limpid
