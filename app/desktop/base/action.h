// What keys, menus and buttons ask for.
#pragma once

#include <cstdint>
#include <functional>

namespace limpid {

enum class Action : std::uint8_t {
  none,
  escape,  // closes what is open first; force off where nothing is, and on a real device
  cut_force,
  save_and_leave,
  discard_and_leave,
  front_view,
  side_view,
  top_view,
  reset_camera,
  toggle_coupling,
  toggle_twin,
  toggle_overlay,
  smaller_eta,
  larger_eta,
  smaller_alpha,
  larger_alpha,
  softer_coupling,
  stiffer_coupling,
  softer_grip,
  stiffer_grip,
  toggle_force,
  break_passivity,
  end_passivity_break,
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
  write_video,
  freeze_plots,
  toggle_ghost,
  toggle_lens,
  toggle_help,
  toggle_left,
  toggle_right,
  toggle_plots,
  toggle_experiments,
  toggle_sweep,
  toggle_identify,
  add_plot,
  layouts,
  presets,
  full_screen,
  save_picture,
  open_session,
  undo,
  redo,
  quit,
  gallery,
  add_model,
  open_arm,
  save_scene,
  save_scene_as,
  select_next,
  select_previous,
  remove_selected,
  duplicate_selected,
  frame_selected,
  open_kept,  // the scene of the last time that nobody had saved
  leave_kept,
  discard_kept,
};

// Has it carried out.
using Act = std::function<void(Action)>;

}  // namespace limpid
