// What the window's program is made of. Panels, dialogs and commands work on the parts themselves;
// here is what needs several of them.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "app/desktop/base/notices.h"
#include "app/desktop/base/settings.h"
#include "app/desktop/base/window_layout.h"
#include "app/desktop/document/document.h"
#include "app/desktop/document/unsaved.h"
#include "app/desktop/live/identify_controller.h"
#include "app/desktop/live/live_session.h"
#include "app/desktop/live/sweep_controller.h"
#include "app/desktop/panels/over_view.h"
#include "app/desktop/panels/person_question.h"
#include "app/desktop/panels/transform_tool.h"
#include "app/desktop/playback/playback.h"
#include "app/desktop/shell/chatter_watch.h"
#include "app/desktop/shell/dialogs.h"
#include "app/desktop/shell/exporter.h"
#include "app/desktop/shell/focus.h"
#include "app/desktop/shell/key_labels.h"
#include "app/desktop/shell/lead.h"
#include "app/desktop/shell/marking.h"
#include "app/desktop/shell/pads.h"
#include "app/desktop/shell/tuning.h"
#include "app/desktop/shell/world.h"
#include "render/camera.h"
#include "render/quality.h"

namespace limpid {

// What is on screen: the recording that is played, or else the loop, and how it is looked at.

class Shown {
 public:
  Shown(const Settings& settings, Playback& playback, LiveSession& live)
      : settings_(settings), playback_(playback), live_(live) {}

  Stage& stage() { return playback_.on() ? playback_.shown()->stage() : live_.stage(); }
  const Stage& stage() const { return playback_.on() ? playback_.shown()->stage() : live_.stage(); }
  std::span<const double> row() const;       // empty before the first
  std::span<const double> twin_row() const;  // empty without a twin

  // The view is chosen for the window's size until somebody chooses one.
  bool automatic_view() const { return automatic_; }
  void keep_view() { automatic_ = false; }
  void look(Camera::View view);
  void reset_view();
  // Once a frame: from where a story's step wants to be looked at, and what it calls the runs.
  void follow_story();
  void leave_story() { step_ = nullptr; }  // the next step looks anew

  int quality_level() const;  // of Quality, as the settings want it

  Camera camera;
  ScreenRect picture{};  // where it is in the window, of a twin's the left one
  AutoQuality automatic_quality;

 private:
  const Settings& settings_;
  Playback& playback_;
  LiveSession& live_;
  bool automatic_ = true;
  const StoryStep* step_ = nullptr;  // that the camera knows
};

// Which plots the window shows, one after the other or as a layout that has a name.
class PlotLayout {
 public:
  PlotLayout(Settings& settings, Notices& notices, OpenDialog& dialog);

  // A new plot, or another one in its place, is chosen in a dialog.
  void add();
  void choose(std::size_t plot);
  std::size_t chosen() const { return chosen_; }
  void remove(std::size_t plot);
  void use(const std::string& name);  // a layout

  NamedTexts layouts;

 private:
  Settings& settings_;
  Notices& notices_;
  OpenDialog& dialog_;
  std::size_t chosen_ = 0;
};

// What commands ask of the system's window, for who has it.
struct WindowRequests {
  bool close = false, toggle_full_screen = false;
  bool menu = false;              // open, for the keys
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
  ChatterWatch chatter{settings, live, document};
  PlotLayout plots;
  Exporter exporter{live, dialog, notices};
  Marking marking{settings, live, playback, dialog, notices};
  TransformTool transform;
  Pads pads;
  KeptScenes kept;
  World world;
  Lead lead{*this};
  WindowRequests asked;
  // Of programs on the control socket: what one asks whoever is here, and that one hides the law,
  // the settings and the plots, and all commands that show or change them.
  PersonQuestion question;
  bool blind = false;
  bool recording_may_end = false;  // with the window: somebody was asked
  // Of experiments that go on beside the window, also while their dialog is closed: "3 of 12: ...".
  std::string experiments_under_way;
  // State of the system's window: its size on the screen, the work of its last frame without
  // waiting [s], and the labels of its keyboard.
  bool full_screen = false;
  double frame_time = 0;
  const KeyLabels* key_labels = &kUsKeyboard;

  // Once a frame, before anything is drawn.
  void update(double dt);
  // The gamepads that are there now, `dt` [s] after the last call: the chosen one leads the hand,
  // where the window has the focus and nothing is open over it.
  void follow_pads(std::vector<Pad> plugged, bool focused, double dt);
  // What a device's first button does: the magnet where something can be picked up, else the next
  // coupling law.
  void pick_up_or_next_law();
  // Before the OpenGL context goes.
  void drop_pictures();

  // Who has the keys at this moment.
  Focus focus() const;
  // A real device is armed only where its world is on the screen.
  void toggle_force();
  // Of the arm, of a check of its axes, and of a device that is moved by itself.
  void cut_force();
  // Closes what is open first; where nothing is, and on a real device, it cuts the force.
  void escape();
  // What stands over the picture as long as it is so.
  std::vector<Banner> banners() const;

 private:
  static const KeyLabels kUsKeyboard;

  bool close_one();
  void follow_playback(double dt);
  void follow_break();
  void follow_first_steps();

  bool break_holds_ = false;  // the hand was put there when passivity was broken, and is there
  bool was_broken_ = false;
  bool told_ = false;                                   // a story was, in the frame before
  std::optional<std::pair<CouplingKind, double>> law_;  // and eta, of the frame before
};

}  // namespace limpid
