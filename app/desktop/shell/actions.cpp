#include "app/desktop/shell/actions.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "app/desktop/shell/keys.h"
#include "app/desktop/sweep/sweep_desk.h"
#include "app/style/number_slider.h"

namespace limpid {
namespace {

// By a step of its slider.
void step(Parameters& p, const char* key, int direction) {
  const ParameterInfo& info = *find_parameter(key);
  const double usual = parameter_number(Parameters{}, info);
  set_parameter_number(p, info, slider_step(info, parameter_number(p, info), usual, direction));
}

bool act_on_parameters(Action action, Parameters& p) {
  switch (action) {
    case Action::smaller_eta: step(p, "coupling.eta", -1); return true;
    case Action::larger_eta: step(p, "coupling.eta", 1); return true;
    case Action::smaller_alpha: step(p, "observer.alpha", -1); return true;
    case Action::larger_alpha: step(p, "observer.alpha", 1); return true;
    case Action::softer_coupling: step(p, "coupling.k_vc", -1); return true;
    case Action::stiffer_coupling: step(p, "coupling.k_vc", 1); return true;
    case Action::softer_grip: step(p, "hand.stiffness", -1); return true;
    case Action::stiffer_grip: step(p, "hand.stiffness", 1); return true;
    default: return false;
  }
}

void toggle(Desktop& desktop, Dialog dialog) {
  desktop.open_dialog(desktop.dialog() == dialog ? Dialog::none : dialog);
}

void toggle_sweep(Desktop& desktop) {
  if (desktop.sweep().sweep() != nullptr || desktop.sweep().loading()) {
    return toggle(desktop, Dialog::sweep);
  }
  desktop.notices().say(
      "No sweep is open. Drop a sweep's folder or its table.h5 here, or open it with Ctrl+O.");
}

void save_picture(Window& window) {
  const std::string name =
      fmt::format("limpid-{:%Y%m%d-%H%M%S}.png", fmt::localtime(std::time(nullptr)));
  window.save_picture(sessions_dir() / name);
}

void write_video(Desktop& desktop) {
  const Playback& playback = desktop.playback();
  if (playback.on() && !playback.video().busy()) desktop.open_dialog(Dialog::video);
}

void freeze_plots(PlotGroup& group) { group.set_following(!group.following()); }

// Each carries out its own actions and knows no others.
bool act_on_playback(Action action, Playback& playback, const Parameters& parameters) {
  if (!playback.on()) return false;
  Player& player = playback.shown()->player();
  switch (action) {
    case Action::back_to_live: playback.close(); return true;
    case Action::tick_back: player.step(-1); return true;
    case Action::tick_on: player.step(1); return true;
    case Action::step_back: player.step(-100); return true;
    case Action::step_on: player.step(100); return true;
    case Action::to_the_beginning: player.seek(0); return true;
    case Action::toggle_loop: player.loop = !player.loop; return true;
    case Action::rerun: playback.start_rerun(parameters); return true;
    default: return false;
  }
}

bool act_on_document(Action action, Document& document) {
  switch (action) {
    case Action::discard_and_leave: document.discard_and_leave(); return true;
    case Action::undo: document.undo(); return true;
    case Action::redo: document.redo(); return true;
    case Action::select_next: document.editor().select_next(1); return true;
    case Action::select_previous: document.editor().select_next(-1); return true;
    case Action::remove_selected: document.remove_selected(); return true;
    case Action::duplicate_selected: document.duplicate_selected(); return true;
    default: return false;
  }
}

bool act_on_view(Action action, Desktop& desktop) {
  Settings& s = desktop.settings();
  switch (action) {
    case Action::front_view: desktop.look(Camera::View::front); return true;
    case Action::side_view: desktop.look(Camera::View::side); return true;
    case Action::top_view: desktop.look(Camera::View::top); return true;
    case Action::toggle_ghost: s.show_ghost = !s.show_ghost; return true;
    case Action::toggle_overlay: s.twin_overlaid = !s.twin_overlaid; return true;
    case Action::toggle_lens: s.show_lens = !s.show_lens; return true;
    case Action::toggle_left: s.show_left = !s.show_left; return true;
    case Action::toggle_right: s.show_right = !s.show_right; return true;
    case Action::toggle_plots: s.show_plots = !s.show_plots; return true;
    default: return false;
  }
}

bool act_on_window(Action action, Window& window) {
  switch (action) {
    case Action::full_screen: window.toggle_full_screen(); return true;
    case Action::save_picture: save_picture(window); return true;
    case Action::quit: window.close(); return true;
    default: return false;
  }
}

void act_on_desktop(Action action, Desktop& d) {
  switch (action) {
    case Action::escape: d.escape(); break;
    case Action::cut_force: d.cut_force(); break;
    case Action::toggle_force: d.desk().toggle_force(); break;
    case Action::break_passivity: d.break_passivity(); break;
    case Action::end_passivity_break: d.end_break(); break;
    case Action::start_over: d.desk().start_over(); break;
    case Action::toggle_coupling: d.toggle_coupling(); break;
    case Action::toggle_twin: d.toggle_twin(); break;
    case Action::toggle_recording: d.toggle_recording(); break;
    case Action::toggle_playing: d.toggle_playing(); break;
    case Action::reset_camera: d.reset_view(); break;
    case Action::frame_selected: d.frame_selected(); break;
    case Action::freeze_plots: freeze_plots(d.shown().group); break;
    case Action::save_scene: d.save_scene(); break;
    case Action::save_and_leave: d.save_and_leave(); break;
    case Action::toggle_help: toggle(d, Dialog::help); break;
    case Action::toggle_experiments: toggle(d, Dialog::experiments); break;
    case Action::toggle_sweep: toggle_sweep(d); break;
    case Action::toggle_identify: toggle(d, Dialog::identify); break;
    case Action::add_plot: d.add_plot(); break;
    case Action::layouts: d.open_dialog(Dialog::layouts); break;
    case Action::presets: d.open_dialog(Dialog::presets); break;
    case Action::open_session: d.open_dialog(Dialog::open_session); break;
    case Action::write_video: write_video(d); break;
    case Action::gallery: d.open_dialog(Dialog::gallery); break;
    case Action::add_model: d.open_dialog(Dialog::add_model); break;
    case Action::open_arm: d.open_dialog(Dialog::open_arm); break;
    case Action::save_scene_as: d.open_dialog(Dialog::save_scene); break;
    case Action::open_kept: d.open_kept(); break;
    case Action::leave_kept: d.leave_kept(); break;
    case Action::discard_kept: d.discard_kept(); break;
    default: break;
  }
}

}  // namespace

void carry_out(Action action, Desktop& desktop, Window& window) {
  Parameters& parameters = desktop.edited();
  const bool done = act_on_parameters(action, parameters) || act_on_view(action, desktop) ||
                    act_on_window(action, window) || act_on_document(action, desktop.document()) ||
                    act_on_playback(action, desktop.playback(), parameters);
  if (!done) act_on_desktop(action, desktop);
}

void handle_keys(Desktop& desktop, Window& window) {
  for (const KeyPress& press : window.keys()) {
    // A key may have opened something for the next one.
    const KeyOwner owner = owner_of(desktop.focus());
    carry_out(action_of(owner, press.key, press.modifiers, press.repeated), desktop, window);
  }
}

}  // namespace limpid
