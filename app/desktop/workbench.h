// Everything the window works on, and what can be done with it. Panels draw it; keys, menus and
// buttons call its actions.
#pragma once

#include <chrono>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/desktop/settings.h"
#include "app/desktop/stage.h"
#include "app/live/live_loop.h"
#include "app/run/analysis.h"
#include "app/session/background.h"
#include "app/session/player.h"
#include "render/camera.h"

namespace limpid {

class Window;

// A session that is being looked at, with a second run of its hand beside it if one was made.
struct Playback {
  std::filesystem::path file;
  Player player;
  std::vector<double> rerun;  // rows of the second run, as many as the session's; or none
  Parameters rerun_parameters;
  std::unique_ptr<Stage> stage;

  std::span<const double> rerun_row() const {
    const auto stride = static_cast<std::size_t>(player.session().layout.stride());
    return rerun.empty() ? std::span<const double>()
                         : std::span<const double>(rerun).subspan(player.index() * stride, stride);
  }
};

struct Notice {
  std::string text;
  bool bad = false;
  std::chrono::steady_clock::time_point until;
};

class Workbench {
 public:
  Workbench(Settings settings, AskForPriority ask);
  ~Workbench();

  // After the window is there. Errors: FileError and the like, for a device or scene given by hand.
  void open_world(const std::string& device, const std::string& scene);
  void open_scene(const std::filesystem::path& file);
  // Before the OpenGL context goes.
  void drop_pictures();
  // Once a frame, before anything is drawn.
  void update(double dt);

  // Coupling and force.
  void toggle_coupling();
  void cut_force() { controls.force = false; }
  void toggle_force() { controls.force = !controls.force; }
  void start_over();
  void undo();
  void redo();
  void reset_parameters();

  // Recording and playback.
  void toggle_recording();
  void open_session(const std::filesystem::path& file);
  void toggle_playing();
  void close_playback();
  void start_rerun();
  void export_csv();
  void recover_leftovers();
  void save_picture(Window& window);

  void say(std::string text, bool bad = false);
  bool playing_back() const { return playback.has_value(); }
  Stage& shown() { return playback ? *playback->stage : *stage; }
  // The row on screen, of the loop or of the recording; empty before the first.
  std::span<const double> row() const;

  Settings settings;
  Parameters& parameters;  // of settings
  Controls controls;
  LiveLoop live;
  std::unique_ptr<Stage> stage;
  std::optional<Playback> playback;
  Camera camera;
  Analysis analysis;
  std::deque<Notice> notices;
  std::filesystem::path last_recording;
  Background<std::optional<Playback>> loading;
  Background<std::vector<double>> rerunning;
  Background<std::string> exporting;
  std::string scene_file, device_file;
  bool show_help = false, show_about = false, show_open = false, show_experiments = false;
  std::string typed_path;

 private:
  void open(ArmDescription arm, Scene scene);
  void take_rows();
  void follow_parameters();
  void take_results();
  void rebuild_playback_stage();

  Parameters known_;  // at the last frame
  std::vector<Parameters> undo_, redo_;
  std::optional<Parameters> before_change_;
  std::chrono::steady_clock::time_point last_change_;
  std::vector<double> rows_;
  bool was_diverged_ = false;
};

}  // namespace limpid
