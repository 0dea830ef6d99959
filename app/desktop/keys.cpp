#include "app/desktop/keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>

namespace limpid {
namespace {

constexpr std::array kShortcuts{
    Shortcut{"left drag", "pull the arm by its tip; wheel meanwhile: nearer and farther"},
    Shortcut{"right drag, Alt+left drag", "turn the camera"},
    Shortcut{"middle drag, Shift+right drag", "move the camera"},
    Shortcut{"wheel", "zoom to the cursor"},
    Shortcut{"1, 2, 3, 0", "front, side, top view; reset the camera"},
    Shortcut{"C", "standard or proposed coupling (A/B)"},
    Shortcut{"[, ]", "smaller or larger eta"},
    Shortcut{"Esc, Space", "force off at once; Esc closes what is open, too"},
    Shortcut{"F", "force on or off"},
    Shortcut{"Backspace", "start over; in playback: back to live"},
    Shortcut{"R", "record, stop recording"},
    Shortcut{"P", "play, pause"},
    Shortcut{"Left, Right", "in playback: step by a tick"},
    Shortcut{"Shift+Left, Shift+Right", "in playback: step by 0.1 s"},
    Shortcut{"Home, L, E", "in playback: to the beginning, loop, re-run"},
    Shortcut{"X", "freeze or follow the plots"},
    Shortcut{"G", "ghost of the device"},
    Shortcut{"F2, F3, F4", "coupling panel, device panel, plots"},
    Shortcut{"F5", "the paper's experiments"},
    Shortcut{"F11, F12", "full screen, save a picture"},
    Shortcut{"F1, ?", "this list"},
    Shortcut{"Ctrl+O, Ctrl+Q", "open a recording, quit"},
    Shortcut{"Ctrl+Z, Ctrl+Y, Ctrl+Shift+Z", "undo, redo, redo"},
    Shortcut{"Ctrl+G, Ctrl+M", "gallery of scenes; add a model (.glb), or drop one here"},
    Shortcut{"Ctrl+S, Ctrl+Shift+S", "save the scene; under another name"},
    Shortcut{"Tab, Shift+Tab", "select the next object of the scene, or the one before"},
    Shortcut{"Delete, Ctrl+D", "remove or copy the selected object"},
    Shortcut{"plots", "drag pans, wheel zooms, double click fits, right click saves"},
    Shortcut{"sliders", "double click to type, right click for the paper's value"},
};

struct Binding {
  KeyOwner owner;  // the view's act in playback, too, where that has none for the key
  int modifiers;
  int key;
  KeyAction action;
  bool repeats = false;
};

constexpr auto kView = KeyOwner::view;
constexpr auto kPlayback = KeyOwner::playback;
constexpr auto kQuestion = KeyOwner::question;
constexpr int kShift = GLFW_MOD_SHIFT;
constexpr int kControl = GLFW_MOD_CONTROL;

constexpr std::array kBindings{
    Binding{kQuestion, 0, GLFW_KEY_ENTER, KeyAction::save_and_leave},
    Binding{kQuestion, 0, GLFW_KEY_KP_ENTER, KeyAction::save_and_leave},
    Binding{kQuestion, 0, GLFW_KEY_D, KeyAction::discard_and_leave},
    Binding{kPlayback, 0, GLFW_KEY_LEFT, KeyAction::tick_back, true},
    Binding{kPlayback, 0, GLFW_KEY_RIGHT, KeyAction::tick_on, true},
    Binding{kPlayback, kShift, GLFW_KEY_LEFT, KeyAction::step_back, true},
    Binding{kPlayback, kShift, GLFW_KEY_RIGHT, KeyAction::step_on, true},
    Binding{kPlayback, 0, GLFW_KEY_HOME, KeyAction::to_the_beginning},
    Binding{kPlayback, 0, GLFW_KEY_L, KeyAction::toggle_loop},
    Binding{kPlayback, 0, GLFW_KEY_E, KeyAction::rerun},
    Binding{kPlayback, 0, GLFW_KEY_BACKSPACE, KeyAction::back_to_live},
    Binding{kView, 0, GLFW_KEY_1, KeyAction::front_view},
    Binding{kView, 0, GLFW_KEY_2, KeyAction::side_view},
    Binding{kView, 0, GLFW_KEY_3, KeyAction::top_view},
    Binding{kView, 0, GLFW_KEY_0, KeyAction::reset_camera},
    Binding{kView, 0, GLFW_KEY_C, KeyAction::toggle_coupling},
    Binding{kView, 0, GLFW_KEY_LEFT_BRACKET, KeyAction::smaller_eta, true},
    Binding{kView, 0, GLFW_KEY_RIGHT_BRACKET, KeyAction::larger_eta, true},
    Binding{kView, 0, GLFW_KEY_F, KeyAction::toggle_force},
    Binding{kView, 0, GLFW_KEY_BACKSPACE, KeyAction::start_over},
    Binding{kView, 0, GLFW_KEY_R, KeyAction::toggle_recording},
    Binding{kView, 0, GLFW_KEY_P, KeyAction::toggle_playing},
    Binding{kView, 0, GLFW_KEY_X, KeyAction::freeze_plots},
    Binding{kView, 0, GLFW_KEY_G, KeyAction::toggle_ghost},
    Binding{kView, 0, GLFW_KEY_F1, KeyAction::toggle_help},
    Binding{kView, kShift, GLFW_KEY_SLASH, KeyAction::toggle_help},
    Binding{kView, 0, GLFW_KEY_F2, KeyAction::toggle_left},
    Binding{kView, 0, GLFW_KEY_F3, KeyAction::toggle_right},
    Binding{kView, 0, GLFW_KEY_F4, KeyAction::toggle_plots},
    Binding{kView, 0, GLFW_KEY_F5, KeyAction::toggle_experiments},
    Binding{kView, 0, GLFW_KEY_F11, KeyAction::full_screen},
    Binding{kView, 0, GLFW_KEY_F12, KeyAction::save_picture},
    Binding{kView, kControl, GLFW_KEY_O, KeyAction::open_session},
    Binding{kView, kControl, GLFW_KEY_Z, KeyAction::undo, true},
    Binding{kView, kControl, GLFW_KEY_Y, KeyAction::redo, true},
    Binding{kView, kControl | kShift, GLFW_KEY_Z, KeyAction::redo, true},
    Binding{kView, kControl, GLFW_KEY_Q, KeyAction::quit},
    Binding{kView, kControl, GLFW_KEY_G, KeyAction::gallery},
    Binding{kView, kControl, GLFW_KEY_M, KeyAction::add_model},
    Binding{kView, kControl, GLFW_KEY_S, KeyAction::save_scene},
    Binding{kView, kControl | kShift, GLFW_KEY_S, KeyAction::save_scene_as},
    Binding{kView, 0, GLFW_KEY_TAB, KeyAction::select_next, true},
    Binding{kView, kShift, GLFW_KEY_TAB, KeyAction::select_previous, true},
    Binding{kView, 0, GLFW_KEY_DELETE, KeyAction::remove_selected},
    Binding{kView, kControl, GLFW_KEY_D, KeyAction::duplicate_selected},
};

void change_eta(Workbench& bench, double factor) {
  const ParameterInfo& info = *find_parameter("coupling.eta");
  double& eta = bench.parameters.eta;
  eta = std::clamp(eta * factor, info.slider_minimum, info.slider_maximum);
}

void toggle(Workbench& bench, Dialog dialog) {
  bench.dialog = bench.dialog == dialog ? Dialog::none : dialog;
}

void cut_force(Workbench& bench) {
  if (bench.live.snapshot().arming != Arming::off) bench.say("Force off. F switches it on again.");
  bench.cut_force();
}

// Closes what is open first: a menu, then typing outside of dialogs (which ImGui ends), the
// question, the dialog.
void close_one(Workbench& bench, const Focus& focus) {
  if (focus.popup) {
    // Lists inside of a dialog go, the dialog stays.
    const int level = ImGui::GetTopMostPopupModal() != nullptr ? 1 : 0;
    ImGui::ClosePopupToLevel(level, true);
  } else if (focus.question) {
    bench.after_question = nullptr;
  } else if (!focus.text || modal(focus.dialog)) {
    bench.dialog = Dialog::none;
  }
}

bool typing() {
  const ImGuiContext& ui = *ImGui::GetCurrentContext();
  const bool wanted =
      ui.WantTextInputNextFrame != -1 ? ui.WantTextInputNextFrame != 0 : ui.IO.WantTextInput;
  return wanted && ui.ActiveId != 0;
}

bool popup_open() {
  const auto& open = ImGui::GetCurrentContext()->OpenPopupStack;
  if (open.empty()) return false;
  const ImGuiWindow* top = open.back().Window;
  return top != nullptr && (top->Flags & ImGuiWindowFlags_Modal) == 0;
}

void carry_out(KeyAction action, Workbench& bench, Window& window, const Focus& focus) {
  Settings& s = bench.settings;
  Player* player = bench.playback ? &bench.playback->player : nullptr;
  switch (action) {
    case KeyAction::none: break;
    case KeyAction::escape:
      cut_force(bench);
      close_one(bench, focus);
      break;
    case KeyAction::cut_force: cut_force(bench); break;
    case KeyAction::save_and_leave: bench.save_and_leave(); break;
    case KeyAction::discard_and_leave: bench.discard_and_leave(); break;
    case KeyAction::front_view: bench.camera.look(Camera::View::front); break;
    case KeyAction::side_view: bench.camera.look(Camera::View::side); break;
    case KeyAction::top_view: bench.camera.look(Camera::View::top); break;
    case KeyAction::reset_camera: bench.camera.reset(bench.shown().picture.bounds()); break;
    case KeyAction::toggle_coupling: bench.toggle_coupling(); break;
    case KeyAction::smaller_eta: change_eta(bench, 1 / 1.1); break;
    case KeyAction::larger_eta: change_eta(bench, 1.1); break;
    case KeyAction::toggle_force: bench.toggle_force(); break;
    case KeyAction::start_over: bench.start_over(); break;
    case KeyAction::back_to_live: bench.close_playback(); break;
    case KeyAction::toggle_recording: bench.toggle_recording(); break;
    case KeyAction::toggle_playing: bench.toggle_playing(); break;
    case KeyAction::tick_back: player->step(-1); break;
    case KeyAction::tick_on: player->step(1); break;
    case KeyAction::step_back: player->step(-100); break;
    case KeyAction::step_on: player->step(100); break;
    case KeyAction::to_the_beginning: player->seek(0); break;
    case KeyAction::toggle_loop: player->loop = !player->loop; break;
    case KeyAction::rerun: bench.start_rerun(); break;
    case KeyAction::freeze_plots:
      bench.shown().group.set_following(!bench.shown().group.following());
      break;
    case KeyAction::toggle_ghost: s.show_ghost = !s.show_ghost; break;
    case KeyAction::toggle_help: toggle(bench, Dialog::help); break;
    case KeyAction::toggle_left: s.show_left = !s.show_left; break;
    case KeyAction::toggle_right: s.show_right = !s.show_right; break;
    case KeyAction::toggle_plots: s.show_plots = !s.show_plots; break;
    case KeyAction::toggle_experiments: toggle(bench, Dialog::experiments); break;
    case KeyAction::full_screen: window.toggle_full_screen(); break;
    case KeyAction::save_picture: bench.save_picture(window); break;
    case KeyAction::open_session: bench.dialog = Dialog::open_session; break;
    case KeyAction::undo: bench.undo(); break;
    case KeyAction::redo: bench.redo(); break;
    case KeyAction::quit: window.close(); break;
    case KeyAction::gallery: bench.dialog = Dialog::gallery; break;
    case KeyAction::add_model: bench.dialog = Dialog::add_model; break;
    case KeyAction::save_scene: bench.save_scene(); break;
    case KeyAction::save_scene_as: bench.dialog = Dialog::save_scene; break;
    case KeyAction::select_next: bench.editor.select_next(1); break;
    case KeyAction::select_previous: bench.editor.select_next(-1); break;
    case KeyAction::remove_selected: bench.remove_selected(); break;
    case KeyAction::duplicate_selected: bench.duplicate_selected(); break;
  }
}

}  // namespace

std::span<const Shortcut> shortcuts() { return kShortcuts; }

KeyAction action_of(KeyOwner owner, int key, int modifiers, bool repeated) {
  // Nobody who wants the force off looks for the right modifiers first.
  if (key == GLFW_KEY_ESCAPE) return repeated ? KeyAction::none : KeyAction::escape;
  if (key == GLFW_KEY_SPACE && owner != KeyOwner::text) return KeyAction::cut_force;
  const int held = modifiers & (kShift | kControl | GLFW_MOD_ALT | GLFW_MOD_SUPER);
  const auto find = [&](KeyOwner whose) {
    return std::ranges::find_if(kBindings, [&](const Binding& b) {
      return b.owner == whose && b.key == key && b.modifiers == held;
    });
  };
  const auto* found = find(owner);
  if (found == kBindings.end() && owner == KeyOwner::playback) found = find(KeyOwner::view);
  if (found == kBindings.end() || (repeated && !found->repeats)) return KeyAction::none;
  return found->action;
}

Focus focus_of(const Workbench& bench) {
  return {.text = typing(),
          .popup = popup_open(),
          .question = bench.after_question != nullptr,
          .dialog = bench.dialog,
          .playback = bench.playing_back()};
}

void handle_keys(Workbench& bench, Window& window) {
  for (const KeyPress& press : window.keys()) {
    const Focus focus = focus_of(bench);  // a key may have opened something for the next one
    carry_out(action_of(owner_of(focus), press.key, press.modifiers, press.repeated), bench, window,
              focus);
  }
}

}  // namespace limpid
