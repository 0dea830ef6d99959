// What keys and mouse do: one table for what acts, one list for the help.
#pragma once

#include <cstdint>
#include <span>

#include "app/desktop/focus.h"
#include "app/desktop/window.h"
#include "app/desktop/workbench.h"

namespace limpid {

struct Shortcut {
  const char* keys;
  const char* what;
};
std::span<const Shortcut> shortcuts();

enum class KeyAction : std::uint8_t {
  none,
  escape,  // force off, and what is open first is closed
  cut_force,
  save_and_leave,
  discard_and_leave,
  front_view,
  side_view,
  top_view,
  reset_camera,
  toggle_coupling,
  smaller_eta,
  larger_eta,
  toggle_force,
  start_over,
  back_to_live,
  toggle_recording,
  toggle_playing,
  tick_back,
  tick_on,
  step_back,
  step_on,
  to_the_beginning,
  toggle_loop,
  rerun,
  freeze_plots,
  toggle_ghost,
  toggle_help,
  toggle_left,
  toggle_right,
  toggle_plots,
  toggle_experiments,
  full_screen,
  save_picture,
  open_session,
  undo,
  redo,
  quit,
  gallery,
  add_model,
  save_scene,
  save_scene_as,
  select_next,
  select_previous,
  remove_selected,
  duplicate_selected,
};

// What a key does for its owner; `repeated` while it is held down. Key and modifiers as GLFW names
// them.
KeyAction action_of(KeyOwner owner, int key, int modifiers, bool repeated);

// Who has the keys at this moment.
Focus focus_of(const Workbench& bench);

// Carries out the keys pressed in this frame.
void handle_keys(Workbench& bench, Window& window);

}  // namespace limpid
