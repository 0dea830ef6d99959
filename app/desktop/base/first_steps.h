// First steps: things that a new user is asked to try, and which of them were done once.
#pragma once

#include <array>
#include <cstdint>

#include "app/desktop/base/settings.h"

namespace limpid {

enum class FirstStep : std::uint8_t { pull, push, press, law, eta, twin, play };

struct FirstStepInfo {
  FirstStep step;
  char letter;  // in Settings::tried
  const char* what;
  const char* how;  // key or mouse
};
// Steps in the order in which they are worth trying; hints and "Your turn" go by them.
inline constexpr std::array kFirstSteps{
    FirstStepInfo{FirstStep::pull, 'd', "Pull the arm by its tip", "left drag"},
    FirstStepInfo{FirstStep::push, 'w', "Move the tip along the view", "wheel while dragging"},
    FirstStepInfo{FirstStep::press, 'p', "Press the tip onto something", "left drag"},
    FirstStepInfo{FirstStep::law, 'c', "Switch the coupling", "C"},
    FirstStepInfo{FirstStep::eta, 'e', "Make the arm lighter or heavier", "[ and ]"},
    FirstStepInfo{FirstStep::twin, 't', "Two couplings on one hand", "B"},
    FirstStepInfo{FirstStep::play, 'r', "Record your motion, and play it", "R, then P"},
};

bool done(const Settings& settings, FirstStep step);
void note_done(Settings& settings, FirstStep step);
bool all_done(const Settings& settings);
void note_all_done(Settings& settings);

}  // namespace limpid
