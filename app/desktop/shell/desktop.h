// Parts of the window's program, with the work that needs several of them. Panels, dialogs and
// commands work on the parts themselves.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "app/desktop/base/notices.h"
#include "app/desktop/base/settings.h"
#include "app/desktop/base/window_layout.h"
#include "app/desktop/coupling/chatter_watch.h"
#include "app/desktop/coupling/tuning.h"
#include "app/desktop/device/identify_controller.h"
#include "app/desktop/device/pads.h"
#include "app/desktop/experiments/sweep_controller.h"
#include "app/desktop/live/live_stage.h"
#include "app/desktop/playback/playback.h"
#include "app/desktop/scene/document.h"
#include "app/desktop/scene/transform_tool.h"
#include "app/desktop/scene/unsaved.h"
#include "app/desktop/shell/dialogs.h"
#include "app/desktop/shell/exporter.h"
#include "app/desktop/shell/focus.h"
#include "app/desktop/shell/key_labels.h"
#include "app/desktop/shell/lead.h"
#include "app/desktop/shell/marking.h"
#include "app/desktop/shell/person_question.h"
#include "app/desktop/shell/world.h"
#include "app/desktop/view/over_view.h"
#include "render/camera.h"
#include "render/quality.h"

namespace limpid {

// View of the screen's content: the recording that is played, or else the loop.
class Shown {
 public:
  Shown(const Settings& settings, Playback& playback, LiveStage& live)
      : settings_(settings), playback_(playback), live_(live) {}

  Stage& stage() { return playback_.on() ? playback_.shown()->stage() : live_.stage(); }
  const Stage& stage() const { return playback_.on() ? playback_.shown()->stage() : live_.stage(); }
  std::span<const double> row() const;  // empty before the first row
  // Returns the rows of all lanes that run.
  std::vector<std::span<const double>> rows() const;

  // Tells whether the view fits itself to the window's size, until the user chooses one.
  bool automatic_view() const { return automatic_; }
  void keep_view() { automatic_ = false; }
  void look(Camera::View view);
  void reset_view();
  // Takes the camera and the runs' names from a story's step; to be called once a frame.
  void follow_story();
  void leave_story() { step_ = nullptr; }  // the next step sets the camera anew

  int quality_level() const;  // level of Quality that the settings want

  Camera camera;
  ScreenRect picture{};  // place in the window; the first of several pictures
  AutoQuality automatic_quality;

 private:
  const Settings& settings_;
  Playback& playback_;
  LiveStage& live_;
  bool automatic_ = true;
  const StoryStep* step_ = nullptr;  // step of the present camera
};

// Plots of the window: single ones, and layouts with names.
class PlotLayout {
 public:
  PlotLayout(Settings& settings, Notices& notices, OpenDialog& dialog);

  // Opens the dialog for a new plot, or for another one in its place.
  void add();
  void choose(std::size_t plot);
  std::size_t chosen() const { return chosen_; }
  void remove(std::size_t plot);
  void show_in(std::size_t plot, const std::string& channel);  // by its key, beside the others
  void use(const std::string& name);                           // name of a layout

  NamedTexts layouts;

 private:
  Settings& settings_;
  Notices& notices_;
  OpenDialog& dialog_;
  std::size_t chosen_ = 0;
};

// Requests of commands to the system's window.
struct WindowRequests {
  bool close = false, toggle_full_screen = false;
  bool menu = false;              // to be opened for the keys
  std::filesystem::path picture;  // file for a picture of the window; empty: none
};

// Panel that keys lead through, as through a menu.
enum class LedPanel : std::uint8_t { none, left, right };

class Desktop {
 public:
  Desktop(Settings first, const AskForPriority& ask);
  Desktop(const Desktop&) = delete;
  Desktop& operator=(const Desktop&) = delete;

  Settings settings;
  Notices notices;
  OpenDialog dialog;
  Document document;
  LiveStage live;
  DeviceController devices;
  IdentifyController identify;
  Playback playback;
  SweepController sweep;
  Shown shown;
  Tuning tuning;
  ChatterWatch chatter{settings, live, document};
  PlotLayout plots;
  Exporter exporter{live, dialog};
  Marking marking{settings, live, playback, dialog, notices};
  TransformTool transform;
  Pads pads;
  KeptScenes kept;
  World world;
  Lead lead{*this};
  WindowRequests asked;
  // Question of a program on the control socket to the person at the window. `blind`: such a
  // program hides law, settings and plots, and all commands for them.
  PersonQuestion question;
  bool blind = false;
  bool recording_may_end = false;  // with the window: the user agreed
  // Progress of experiments beside the window, also while their dialog is closed: "3 of 12: ...".
  std::string experiments_under_way;
  // State of the system's window: its size on the screen, the work of its last frame without
  // waiting [s], and the labels of its keyboard.
  LedPanel led_panel = LedPanel::none;
  bool full_screen = false;
  double frame_time = 0;
  const KeyLabels* key_labels = &kUsKeyboard;

  // Does the work of a frame before anything is drawn; to be called once a frame.
  void update(double dt);
  // Takes the present gamepads, `dt` [s] after the last call. The chosen one moves the hand if the
  // window has the focus and nothing is open over it.
  void follow_pads(std::vector<Pad> plugged, bool focused, double dt);
  // Does the work of a device's first button: the magnet if something can be picked up, else the
  // next law.
  void pick_up_or_next_law();
  // Drops all pictures; to be called before the OpenGL context goes.
  void drop_pictures();

  // Returns the present focus of the keys.
  Focus focus() const;
  // Arms or cuts the force. A real device is armed only while its world is on the screen.
  void toggle_force();
  // Cuts the force of the arm, of a check of its axes, and of a device that is moved by itself.
  void cut_force();
  // Plays or pauses a recording where no real device may move, else cuts the force.
  void cut_or_play();
  // Closes one open thing, or with none a recording where no real device may move. Cuts the force,
  // too, if nothing was open or a real device may move.
  void escape();
  // Returns the banners over the picture.
  std::vector<Banner> banners() const;

 private:
  static const KeyLabels kUsKeyboard;

  bool close_one();
  bool only_plays() const;
  bool may_move() const;
  void follow_playback(double dt);
  void follow_break();
  void follow_first_steps();

  bool break_holds_ = false;  // the hand was put there by breaking passivity, and still is
  bool was_broken_ = false;
  bool told_ = false;                                   // a story was playing in the frame before
  std::optional<std::pair<CouplingKind, double>> law_;  // law and eta of the frame before
};

}  // namespace limpid
