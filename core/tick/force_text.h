// What is said of a moment without force, or with less of it.
#pragma once

#include <string>

#include "core/tick/force_state.h"

namespace limpid {

// A reason for less force, which may end in none.
constexpr bool holds_back(ForceState state) {
  using enum ForceState;
  return state == too_fast || state == too_far || state == unwatched || state == stalled;
}

// "force off: not armed"; empty while force is on.
inline std::string force_text(ForceState state) {
  if (state == ForceState::on) return {};
  return std::string(holds_back(state) ? "force held back: " : "force off: ") + explain(state);
}

}  // namespace limpid
