// What the window's program is made of. Panels, dialogs and commands work on the parts themselves;
// here is what needs several of them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/desktop/document/document.h"
#include "app/desktop/document/unsaved.h"
#include "app/desktop/live/identify_controller.h"
#include "app/desktop/panels/over_view.h"
#include "app/desktop/playback/playback.h"
#include "app/desktop/shell/dialogs.h"
#include "app/desktop/shell/focus.h"
#include "app/desktop/shell/pads.h"
#include "app/desktop/shell/plot_layout.h"
#include "app/desktop/shell/shown.h"
#include "app/desktop/shell/tuning.h"
#include "app/desktop/shell/world.h"
#include "app/desktop/sweep/sweep_controller.h"

namespace limpid {

// What commands ask of the system's window, for who has it.
struct WindowRequests {
  bool close = false, toggle_full_screen = false;
  std::filesystem::path picture;  // to be saved there; empty: none
};

class Desktop {
 public:
  Desktop(Settings first, const AskForPriority& ask);
  Desktop(const Desktop&) = delete;
  Desktop& operator=(const Desktop&) = delete;

  Settings settings;
  Notices notices;
  OpenDialog dialog;
  Document document;
  LiveSession live;
  DeviceController devices;
  IdentifyController identify;
  Playback playback;
  SweepController sweep;
  Shown shown;
  Tuning tuning;
  PlotLayout plots;
  Pads pads;
  KeptScenes kept;
  World world;
  WindowRequests asked;
  // Of the system's window: how it is, and the work of its last frame, without waiting [s].
  bool full_screen = false;
  double frame_time = 0;

  // Once a frame, before anything is drawn.
  void update(double dt);
  // The gamepads that are there now, `dt` [s] after the last call: the chosen one leads the hand,
  // where the window has the focus and nothing is open over it.
  void follow_pads(std::vector<Pad> plugged, bool focused, double dt);
  // Before the OpenGL context goes.
  void drop_pictures();

  // Who has the keys at this moment.
  Focus focus() const;
  // Of the arm, of a check of its axes, and of a device that is moved by itself.
  void cut_force();
  // Closes what is open first; where nothing is, and on a real device, it cuts the force.
  void escape();
  // What stands over the picture as long as it is so.
  std::vector<Banner> banners() const;

 private:
  bool close_one();
  void follow_playback(double dt);
};

}  // namespace limpid
