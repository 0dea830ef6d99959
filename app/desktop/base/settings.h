// What the window remembers from one start to the next.
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/desktop/base/plot_choice.h"
#include "core/tick/parameters.h"
#include "render/theme.h"

namespace limpid {

// Chosen plots in TOML files: [[plot]] with title, kind, across and channels.

toml::array plots_toml(const std::vector<PlotChoice>& plots);
// Those of the array "plot" of a table; without one the default. Errors: FileError naming `where`,
// the plot, its key and what is allowed.
std::vector<PlotChoice> plots_of(const toml::table& table, const std::string& where);

// A second run beside the first, on the same hand, under settings of its own.
struct TwinSettings {
  bool on = false;
  bool edited = false;  // sliders and keys act on it, and not on the first
  Parameters parameters = [] {
    Parameters p;
    p.kind = CouplingKind::standard;
    return p;
  }();
};

// While passivity is broken to be looked at: the settings of both runs as they were before. They
// come back whole, whatever is changed meanwhile, and they are the ones that are kept and undone.
struct BeforeBreak {
  Parameters first, twin;
  bool of_twin = false;  // it is the twin that is broken
};

struct Settings {
  Theme theme = Theme::dark;
  double ui_scale = 0;  // 0: the screen's
  int width = 1440, height = 900;
  double left = 300, right = 290, plots = 250;  // sizes of the panels at scale 1 [px]
  bool show_left = true, show_right = true, show_plots = true;
  bool show_ghost = true, show_trail = true, show_forces = true, show_grid = true;
  bool show_lens = true;  // while gap or contact is small
  bool show_joints = true;
  bool twin_overlaid = false;  // both runs in one picture, else one beside the other
  bool hold_on_release = false;
  bool own_file_dialogs = false;              // also where the desktop has some
  bool hint_seen = false;                     // the story was offered, and somebody went on
  bool your_turn = false;                     // the list of what to try is shown
  std::string tried;                          // of it, see first_steps.h
  std::string picture_quality = "automatic";  // or high, medium, low
  double plot_length = 10;                    // [s]
  double band = 5;                            // of the human, for the analysis [Hz]
  std::string device, scene;                  // files; empty: the default
  std::string device_tip;                     // a link of the device; empty: as its file has it
  std::string gamepad;                        // that leads the hand, as GLFW identifies it; or none
  std::vector<PlotChoice> plot_choices = default_plots();
  std::vector<std::string> recent;  // recordings and scenes, the newest first
  // A first start has the coupling that feels best and stays passive.
  Parameters parameters = [] {
    Parameters p;
    p.kind = CouplingKind::predictive;
    return p;
  }();
  TwinSettings twin;                        // starts switched off
  std::optional<BeforeBreak> before_break;  // while passivity is broken, see passivity_break.h
};

// This file was opened last.
void remember_recent(Settings& settings, const std::string& file);

// $XDG_CONFIG_HOME/limpid/settings.toml. What cannot be read is left at its default; `complaint`
// then says why.
Settings load_settings(std::string& complaint);
// Of the file as it is by now only what is otherwise than it `began` changes: another window may
// have written it meanwhile. One that cannot be read is kept beside it, with ".unread" behind its
// name. Never throws; a settings file that cannot be written is not worth losing work over. Returns
// what went wrong, empty if nothing did.
std::string save_settings(const Settings& settings, const Settings& began);

// Where recordings and scenes go: below $XDG_DATA_HOME/limpid, made if need be.
std::filesystem::path sessions_dir();
std::filesystem::path scenes_dir();

}  // namespace limpid
