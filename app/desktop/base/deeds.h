// What somebody new is asked to try, and what of it was done once: hints and "Your turn" go by it.
#pragma once

#include <array>
#include <cstdint>

#include "app/desktop/base/settings.h"

namespace limpid {

enum class Deed : std::uint8_t { pull, push, press, law, eta, twin, play };

struct DeedInfo {
  Deed deed;
  char letter;  // in the settings
  const char* what;
  const char* how;  // key or mouse
};
// In the order in which they are worth trying.
inline constexpr std::array kDeeds{
    DeedInfo{Deed::pull, 'd', "Pull the arm by its tip", "left drag"},
    DeedInfo{Deed::push, 'w', "Push it nearer and farther", "wheel while dragging"},
    DeedInfo{Deed::press, 'p', "Press it onto something", "left drag"},
    DeedInfo{Deed::law, 'c', "Switch the coupling", "C"},
    DeedInfo{Deed::eta, 'e', "Make it lighter or heavier", "[ and ]"},
    DeedInfo{Deed::twin, 't', "Two couplings on one hand", "B"},
    DeedInfo{Deed::play, 'r', "Record what you do, and play it", "R, then P"},
};

bool done(const Settings& settings, Deed deed);
void note_done(Settings& settings, Deed deed);
bool all_done(const Settings& settings);
void note_all_done(Settings& settings);

}  // namespace limpid
