#include "app/desktop/shell/keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

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
    Shortcut{"C", "the next coupling law"},
    Shortcut{"[, ]", "smaller or larger impedance scaling, eta"},
    Shortcut{"B, Shift+B", "twin: a second coupling on the same hand; both in one picture"},
    Shortcut{"Shift+[, Shift+]", "smaller or larger observer gain, alpha"},
    Shortcut{"Ctrl+[, Ctrl+]", "softer or stiffer coupling spring, k_vc"},
    Shortcut{"Alt+[, Alt+]", "softer or stiffer grip"},
    Shortcut{"Space", "force off at once"},
    Shortcut{"Esc",
             "closes what is open; with nothing open, and always on a real device, force off"},
    Shortcut{"F", "force on or off"},
    Shortcut{"Backspace", "start over; in playback: back to live"},
    Shortcut{"R", "record, stop recording"},
    Shortcut{"P", "play, pause"},
    Shortcut{"Left, Right", "in playback: step by a tick"},
    Shortcut{"Shift+Left, Shift+Right", "in playback: step by 0.1 s"},
    Shortcut{"Home, L, E, V", "in playback: to the beginning, loop, re-run, write a video"},
    Shortcut{"X", "freeze or follow the plots"},
    Shortcut{"G, M", "ghost of the device, lens at the tip"},
    Shortcut{"F2, F3, F4", "coupling panel, device panel, plots"},
    Shortcut{"F5, F6", "the paper's experiments; the map of the sweep that is open"},
    Shortcut{"F7", "identify the device: it moves and shows its inertia, friction and delay"},
    Shortcut{"F11, F12", "full screen, save a picture"},
    Shortcut{"F1, ?", "this list"},
    Shortcut{"Ctrl+O, Ctrl+Q", "open a recording or a sweep, quit"},
    Shortcut{"Ctrl+Z, Ctrl+Y, Ctrl+Shift+Z", "undo, redo, redo"},
    Shortcut{"Ctrl+G, Ctrl+M", "gallery of scenes; add a model, or drop one here"},
    Shortcut{"Ctrl+S, Ctrl+Shift+S", "save the scene; under another name"},
    Shortcut{"Tab, Shift+Tab", "select the next object of the scene, or the one before"},
    Shortcut{"Delete, Ctrl+D", "remove or copy the selected object"},
    Shortcut{"N", "a new plot: of any channel, over time, against another one, or its spectrum"},
    Shortcut{"Ctrl+L, Ctrl+P", "layouts of plots and panels; presets of settings"},
    Shortcut{"gamepad",
             "left stick: the hand; triggers: nearer, farther; A hold, B force off, Y next law"},
    Shortcut{"plots", "drag pans, wheel zooms, double click fits, right click chooses and saves"},
    Shortcut{"sliders", "double click to type, right click for the usual value"},
};

struct Binding {
  KeyOwner owner;  // the view's act in playback, too, where that has none for the key
  int modifiers;
  int key;
  Action action;
  bool repeats = false;
};

constexpr auto kView = KeyOwner::view;
constexpr auto kPlayback = KeyOwner::playback;
constexpr auto kQuestion = KeyOwner::question;
constexpr int kShift = GLFW_MOD_SHIFT;
constexpr int kControl = GLFW_MOD_CONTROL;

constexpr std::array kBindings{
    Binding{kQuestion, 0, GLFW_KEY_ENTER, Action::save_and_leave},
    Binding{kQuestion, 0, GLFW_KEY_KP_ENTER, Action::save_and_leave},
    Binding{kQuestion, 0, GLFW_KEY_D, Action::discard_and_leave},
    Binding{kPlayback, 0, GLFW_KEY_LEFT, Action::tick_back, true},
    Binding{kPlayback, 0, GLFW_KEY_RIGHT, Action::tick_on, true},
    Binding{kPlayback, kShift, GLFW_KEY_LEFT, Action::step_back, true},
    Binding{kPlayback, kShift, GLFW_KEY_RIGHT, Action::step_on, true},
    Binding{kPlayback, 0, GLFW_KEY_HOME, Action::to_the_beginning},
    Binding{kPlayback, 0, GLFW_KEY_L, Action::toggle_loop},
    Binding{kPlayback, 0, GLFW_KEY_E, Action::rerun},
    Binding{kPlayback, 0, GLFW_KEY_V, Action::write_video},
    Binding{kPlayback, 0, GLFW_KEY_BACKSPACE, Action::back_to_live},
    Binding{kView, 0, GLFW_KEY_1, Action::front_view},
    Binding{kView, 0, GLFW_KEY_2, Action::side_view},
    Binding{kView, 0, GLFW_KEY_3, Action::top_view},
    Binding{kView, 0, GLFW_KEY_0, Action::reset_camera},
    Binding{kView, 0, GLFW_KEY_C, Action::toggle_coupling},
    Binding{kView, 0, GLFW_KEY_B, Action::toggle_twin},
    Binding{kView, kShift, GLFW_KEY_B, Action::toggle_overlay},
    Binding{kView, 0, GLFW_KEY_LEFT_BRACKET, Action::smaller_eta, true},
    Binding{kView, 0, GLFW_KEY_RIGHT_BRACKET, Action::larger_eta, true},
    Binding{kView, kShift, GLFW_KEY_LEFT_BRACKET, Action::smaller_alpha, true},
    Binding{kView, kShift, GLFW_KEY_RIGHT_BRACKET, Action::larger_alpha, true},
    Binding{kView, kControl, GLFW_KEY_LEFT_BRACKET, Action::softer_coupling, true},
    Binding{kView, kControl, GLFW_KEY_RIGHT_BRACKET, Action::stiffer_coupling, true},
    Binding{kView, GLFW_MOD_ALT, GLFW_KEY_LEFT_BRACKET, Action::softer_grip, true},
    Binding{kView, GLFW_MOD_ALT, GLFW_KEY_RIGHT_BRACKET, Action::stiffer_grip, true},
    Binding{kView, 0, GLFW_KEY_F, Action::toggle_force},
    Binding{kView, 0, GLFW_KEY_BACKSPACE, Action::start_over},
    Binding{kView, 0, GLFW_KEY_R, Action::toggle_recording},
    Binding{kView, 0, GLFW_KEY_P, Action::toggle_playing},
    Binding{kView, 0, GLFW_KEY_X, Action::freeze_plots},
    Binding{kView, 0, GLFW_KEY_G, Action::toggle_ghost},
    Binding{kView, 0, GLFW_KEY_M, Action::toggle_lens},
    Binding{kView, 0, GLFW_KEY_F1, Action::toggle_help},
    Binding{kView, kShift, GLFW_KEY_SLASH, Action::toggle_help},
    Binding{kView, 0, GLFW_KEY_F2, Action::toggle_left},
    Binding{kView, 0, GLFW_KEY_F3, Action::toggle_right},
    Binding{kView, 0, GLFW_KEY_F4, Action::toggle_plots},
    Binding{kView, 0, GLFW_KEY_F5, Action::toggle_experiments},
    Binding{kView, 0, GLFW_KEY_F6, Action::toggle_sweep},
    Binding{kView, 0, GLFW_KEY_F7, Action::toggle_identify},
    Binding{kView, 0, GLFW_KEY_F11, Action::full_screen},
    Binding{kView, 0, GLFW_KEY_F12, Action::save_picture},
    Binding{kView, 0, GLFW_KEY_N, Action::add_plot},
    Binding{kView, kControl, GLFW_KEY_L, Action::layouts},
    Binding{kView, kControl, GLFW_KEY_P, Action::presets},
    Binding{kView, kControl, GLFW_KEY_O, Action::open_session},
    Binding{kView, kControl, GLFW_KEY_Z, Action::undo, true},
    Binding{kView, kControl, GLFW_KEY_Y, Action::redo, true},
    Binding{kView, kControl | kShift, GLFW_KEY_Z, Action::redo, true},
    Binding{kView, kControl, GLFW_KEY_Q, Action::quit},
    Binding{kView, kControl, GLFW_KEY_G, Action::gallery},
    Binding{kView, kControl, GLFW_KEY_M, Action::add_model},
    Binding{kView, kControl, GLFW_KEY_S, Action::save_scene},
    Binding{kView, kControl | kShift, GLFW_KEY_S, Action::save_scene_as},
    Binding{kView, 0, GLFW_KEY_TAB, Action::select_next, true},
    Binding{kView, kShift, GLFW_KEY_TAB, Action::select_previous, true},
    Binding{kView, 0, GLFW_KEY_DELETE, Action::remove_selected},
    Binding{kView, kControl, GLFW_KEY_D, Action::duplicate_selected},
};

}  // namespace

std::span<const Shortcut> shortcuts() { return kShortcuts; }

Action action_of(KeyOwner owner, int key, int modifiers, bool repeated) {
  // Nobody who wants the force off looks for the right modifiers first. What Esc is for is up to
  // what is open.
  if (key == GLFW_KEY_ESCAPE) return repeated ? Action::none : Action::escape;
  if (key == GLFW_KEY_SPACE && owner != KeyOwner::text) return Action::cut_force;
  const int held = modifiers & (kShift | kControl | GLFW_MOD_ALT | GLFW_MOD_SUPER);
  const auto find = [&](KeyOwner whose) {
    return std::ranges::find_if(kBindings, [&](const Binding& b) {
      return b.owner == whose && b.key == key && b.modifiers == held;
    });
  };
  const auto* found = find(owner);
  if (found == kBindings.end() && owner == KeyOwner::playback) found = find(KeyOwner::view);
  if (found == kBindings.end() || (repeated && !found->repeats)) return Action::none;
  return found->action;
}

}  // namespace limpid
