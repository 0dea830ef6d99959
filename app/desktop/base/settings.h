// Settings that the window remembers from one start to the next.
#pragma once

#include <toml++/toml.h>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/stage/plot_choice.h"
#include "core/base/lanes.h"
#include "core/tick/parameters.h"
#include "render/theme.h"

namespace limpid {

// Returns chosen plots for a TOML file: [[plot]] with title, kind, across and channels.
toml::array plots_toml(const std::vector<PlotChoice>& plots);
// Returns the plots of a table's array "plot", or the default without one. Errors: FileError naming
// `where`, the plot, its key and what is allowed.
std::vector<PlotChoice> plots_of(const toml::table& table, const std::string& where);

// Settings of every lane, whether it runs or not.
using LaneParameters = std::array<Parameters, kMostLanes>;

// Lanes of the window: the first one, and those beside it.
struct LaneSettings {
  std::size_t count = 1;           // of those that run
  std::size_t edited = kMainLane;  // sliders and keys act on this one
  LaneParameters parameters = [] {
    // A first start has the coupling that feels best and stays passive.
    LaneParameters all;
    using enum CouplingKind;
    constexpr std::array kFirst{predictive, standard, proposed};
    static_assert(kFirst.size() == kMostLanes);
    for (std::size_t i = 0; i < kMostLanes; ++i) all[i].kind = kFirst[i];
    return all;
  }();

  friend bool operator==(const LaneSettings&, const LaneSettings&) = default;
};

// Settings of all lanes from before passivity was broken for a demonstration. They come back whole,
// whatever is changed meanwhile, and are the settings that are kept and undone.
struct BeforeBreak {
  LaneParameters parameters;
  std::size_t lane = kMainLane;  // the broken one
};

// Sizes of text and controls that can be chosen, in the usual one.
inline constexpr std::array kTextSizes{1.0, 1.25, 1.5, 2.0};

struct Settings {
  Theme theme = Theme::dark;
  double ui_scale = 0;   // 0: the screen's scale
  double text_size = 1;  // on top of that scale
  int width = 1440, height = 900;
  double left = 300, right = 290, plots = 250;  // sizes of the panels at scale 1 [px]
  bool everything = true;                       // the whole bench, else what a first hour needs
  bool show_left = true, show_right = true, show_plots = true;
  bool show_ghost = true, show_trail = true, show_forces = true, show_grid = true;
  bool show_lens = true;  // while gap or contact is small
  bool show_joints = true;
  bool overlaid = false;  // all runs in one picture, else one beside the other
  bool hold_on_release = false;
  bool own_file_dialogs = false;  // even if the desktop has file dialogs
  bool hint_seen = false;         // the story's button was pressed, or the arm was dragged
  bool your_turn = false;         // the list of first steps is shown
  std::string tried;              // letters of the steps done, see first_steps.h
  std::string picture_quality = "automatic";  // or high, medium, low
  double plot_length = 10;                    // span of time in the plots [s]
  double band = 5;                            // of the human's motion, for the analysis [Hz]
  std::string device, scene;                  // files; empty: the default
  std::string device_tip;                     // a link of the device; empty: as its file has it
  std::string gamepad;  // the gamepad that moves the hand, as GLFW identifies it; or none
  std::vector<PlotChoice> plot_choices = default_plots();
  std::vector<std::string> recent;          // recordings and scenes, the newest first
  LaneSettings lanes;                       // starts with one
  std::optional<BeforeBreak> before_break;  // while passivity is broken, see passivity_break.h

  Parameters& parameters() { return lanes.parameters[kMainLane]; }
  const Parameters& parameters() const { return lanes.parameters[kMainLane]; }
};

// Puts a file at the front of the recent ones.
void remember_recent(Settings& settings, const std::string& file);

// Shows the whole bench, or what a first hour needs. Plots that nobody has changed follow.
void show_everything(Settings& settings, bool everything);

// Reads $XDG_CONFIG_HOME/limpid/settings.toml. Without the file these are a first start's, which
// shows what a first hour needs. Unreadable values keep their default; `complaint`
// then says why.
Settings load_settings(std::string& complaint);
// Writes only the differences from `began`, as another window may have written the file meanwhile.
// An unreadable file is kept beside it, with ".unread" behind its name. Never throws. Returns the
// reason of a failure, or an empty text.
std::string save_settings(const Settings& settings, const Settings& began);

// Folders for recordings, scenes and sweeps, below $XDG_DATA_HOME/limpid; made if need be.
std::filesystem::path sessions_dir();
std::filesystem::path scenes_dir();
std::filesystem::path sweeps_dir();

}  // namespace limpid
