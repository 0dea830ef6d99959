#include "app/desktop/keys.h"

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
    Shortcut{"1  2  3  0", "front, side, top view; reset the camera"},
    Shortcut{"C", "standard or proposed coupling (A/B)"},
    Shortcut{"[  ]", "smaller or larger eta"},
    Shortcut{"Esc, Space", "force off at once"},
    Shortcut{"F", "force on or off"},
    Shortcut{"Backspace", "start over; in playback: back to live"},
    Shortcut{"R", "record, stop recording"},
    Shortcut{"P", "play, pause"},
    Shortcut{"left, right arrow", "step by a tick (Shift: 0.1 s) in playback"},
    Shortcut{"Home, L, E", "in playback: to the beginning, loop, re-run"},
    Shortcut{"X", "freeze or follow the plots"},
    Shortcut{"G", "ghost of the device"},
    Shortcut{"F2  F3  F4", "coupling panel, device panel, plots"},
    Shortcut{"F5", "the paper's experiments"},
    Shortcut{"F11, F12", "full screen, save a picture"},
    Shortcut{"Ctrl+O  Ctrl+Z  Ctrl+Y  Ctrl+Q", "open a recording, undo, redo, quit"},
    Shortcut{"Ctrl+G  Ctrl+M", "gallery of scenes; add a model (.glb), or drop one here"},
    Shortcut{"Ctrl+S  Ctrl+Shift+S", "save the scene; under another name"},
    Shortcut{"Tab, Shift+Tab", "select the next object of the scene, or the one before"},
    Shortcut{"Delete  Ctrl+D", "remove or copy the selected object"},
    Shortcut{"plots", "drag pans, wheel zooms, double click fits, right click saves"},
    Shortcut{"sliders", "double click to type, right click for the paper's value"},
};

void handle_control_key(Workbench& bench, Window& window, const KeyPress& press) {
  const bool shift = (press.modifiers & GLFW_MOD_SHIFT) != 0;
  switch (press.key) {
    case GLFW_KEY_D: bench.duplicate_selected(); break;
    case GLFW_KEY_G: bench.show_gallery = !bench.show_gallery; break;
    case GLFW_KEY_M: bench.show_add_model = true; break;
    case GLFW_KEY_S:
      if (shift) {
        bench.show_save_as = true;
      } else {
        bench.save_scene();
      }
      break;
    case GLFW_KEY_O: bench.show_open = true; break;
    case GLFW_KEY_Z: shift ? bench.redo() : bench.undo(); break;
    case GLFW_KEY_Y: bench.redo(); break;
    case GLFW_KEY_Q: window.close(); break;
    default: break;
  }
}

void handle_playback_key(Playback& playback, Workbench& bench, const KeyPress& press) {
  const bool shift = (press.modifiers & GLFW_MOD_SHIFT) != 0;
  const int step = shift ? 100 : 1;
  switch (press.key) {
    case GLFW_KEY_LEFT: playback.player.step(-step); break;
    case GLFW_KEY_RIGHT: playback.player.step(step); break;
    case GLFW_KEY_HOME: playback.player.seek(0); break;
    case GLFW_KEY_L: playback.player.loop = !playback.player.loop; break;
    case GLFW_KEY_E: bench.start_rerun(); break;
    default: break;
  }
}

void change_eta(Workbench& bench, double factor) {
  const ParameterInfo& info = *find_parameter("coupling.eta");
  double& eta = bench.parameters.eta;
  eta = std::clamp(eta * factor, info.slider_minimum, info.slider_maximum);
}

void handle_key(Workbench& bench, Window& window, const KeyPress& press) {
  Settings& s = bench.settings;
  switch (press.key) {
    case GLFW_KEY_C: bench.toggle_coupling(); break;
    case GLFW_KEY_LEFT_BRACKET: change_eta(bench, 1 / 1.1); break;
    case GLFW_KEY_RIGHT_BRACKET: change_eta(bench, 1.1); break;
    case GLFW_KEY_F: bench.toggle_force(); break;
    case GLFW_KEY_R: bench.toggle_recording(); break;
    case GLFW_KEY_P: bench.toggle_playing(); break;
    case GLFW_KEY_G: s.show_ghost = !s.show_ghost; break;
    case GLFW_KEY_X: bench.shown().group.set_following(!bench.shown().group.following()); break;
    case GLFW_KEY_1: bench.camera.look(Camera::View::front); break;
    case GLFW_KEY_2: bench.camera.look(Camera::View::side); break;
    case GLFW_KEY_3: bench.camera.look(Camera::View::top); break;
    case GLFW_KEY_0: bench.camera.reset(bench.shown().picture.bounds()); break;
    case GLFW_KEY_F1: bench.show_help = !bench.show_help; break;
    case GLFW_KEY_SLASH:
      if ((press.modifiers & GLFW_MOD_SHIFT) != 0) bench.show_help = !bench.show_help;
      break;
    case GLFW_KEY_F2: s.show_left = !s.show_left; break;
    case GLFW_KEY_F3: s.show_right = !s.show_right; break;
    case GLFW_KEY_F4: s.show_plots = !s.show_plots; break;
    case GLFW_KEY_F5: bench.show_experiments = !bench.show_experiments; break;
    case GLFW_KEY_F11: window.toggle_full_screen(); break;
    case GLFW_KEY_F12: bench.save_picture(window); break;
    case GLFW_KEY_BACKSPACE: bench.start_over(); break;
    case GLFW_KEY_DELETE: bench.remove_selected(); break;
    case GLFW_KEY_TAB:
      bench.editor.select_next((press.modifiers & GLFW_MOD_SHIFT) != 0 ? -1 : 1);
      break;
    default: break;
  }
}

}  // namespace

std::span<const Shortcut> shortcuts() { return kShortcuts; }

void handle_keys(Workbench& bench, Window& window) {
  for (const KeyPress& press : window.keys()) {
    // Force goes off whatever else the key may do.
    if (press.key == GLFW_KEY_ESCAPE || press.key == GLFW_KEY_SPACE) {
      bench.cut_force();
      bench.show_help = bench.show_about = bench.show_open = bench.show_experiments = false;
      bench.show_gallery = bench.show_add_model = bench.show_save_as = false;
      bench.after_question = nullptr;
    } else if (bench.after_question) {
      if (press.key == GLFW_KEY_ENTER) {
        bench.save_and_leave();
      } else if (press.key == GLFW_KEY_D) {
        bench.discard_and_leave();
      }
    } else if ((press.modifiers & GLFW_MOD_CONTROL) != 0) {
      handle_control_key(bench, window, press);
    } else if (bench.playback && press.key == GLFW_KEY_BACKSPACE) {
      bench.close_playback();
    } else {
      if (bench.playback) handle_playback_key(*bench.playback, bench, press);
      handle_key(bench, window, press);
    }
  }
}

}  // namespace limpid
