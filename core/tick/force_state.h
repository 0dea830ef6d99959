// Why there is no force, or less of it.
#pragma once

#include <cstdint>

namespace limpid {

// The order is that of the session file's /device/force_state.
enum class ForceState : std::uint8_t {
  on,
  off,        // not armed
  no_hand,    // the dead-man switch is open
  stale,      // no reading for kStaleReading
  fault,      // the device says that it is not well
  lost,       // unplugged
  too_fast,   // fades with the speed
  too_far,    // fades outside of the range of a joint
  energy,     // the motors have put more energy out than they should
  diverged,   // the command was not finite
  unwatched,  // the window does not answer; fades
  stalled,    // the loop or the device stood still; fades in anew
  frozen,     // the readings stand still while the motors push; fades
};
const char* explain(ForceState state);  // for people, a short clause

}  // namespace limpid
