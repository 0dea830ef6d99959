// Everything the window works on, and what can be done with it. Panels draw it; keys, menus and
// buttons call its actions.
#pragma once

#include <chrono>
#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "app/desktop/device_desk.h"
#include "app/desktop/focus.h"
#include "app/desktop/placement.h"
#include "app/desktop/scene_editor.h"
#include "app/desktop/scene_loader.h"
#include "app/desktop/settings.h"
#include "app/desktop/stage.h"
#include "app/desktop/undo_history.h"
#include "app/live/live_loop.h"
#include "app/run/analysis.h"
#include "app/run/simulate.h"
#include "app/session/background.h"
#include "app/session/errands.h"
#include "app/session/player.h"
#include "render/camera.h"
#include "render/quality.h"

namespace limpid {

class Window;

// A second run of a recording's hand.
struct Rerun {
  std::vector<double> rows;  // as many as the session's
  RunEnd end;                // where it diverged the last row stands for those that are missing
  History history;           // of both
};

// A session that is being looked at, with a second run of its hand beside it if one was made.
struct Playback {
  std::filesystem::path file;
  Player player;
  ArmDescription arm;
  Scene scene;
  MeshModels models;
  History history;            // until the stage has it
  std::vector<double> rerun;  // rows of the second run; or none
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

// What undo goes back to.
struct EditState {
  Parameters parameters;
  SceneEditor::Version scene;
};

// A scene that waits until the device which brought its own is gone.
struct SetAside {
  std::string file;
  ArmDescription arm;
  std::shared_ptr<const SceneEditor::World> world;
  bool unsaved = false;
};

class Workbench {
 public:
  Workbench(Settings settings, AskForPriority ask);
  ~Workbench();

  // After the window is there. Errors: FileError and the like, for a device or scene given by hand.
  void open_world(const std::string& device, const std::string& scene);
  // Before the OpenGL context goes.
  void drop_pictures();
  // Once a frame, before anything is drawn.
  void update(double dt);

  // Coupling and force.
  void toggle_coupling();
  void cut_force() {
    live.cut();
    devices.cancel_check();
  }
  void toggle_force() { force_armed() ? live.cut() : live.arm(); }
  // Whether force is on, or will be as soon as nothing keeps it off.
  bool force_armed() const;
  void start_over();
  void undo();
  void redo();
  void reset_parameters();

  // The scene. Loading goes on beside the window; what is there stays until it is done.
  void open_scene(const std::filesystem::path& file);
  void add_model(const std::filesystem::path& file);
  void open_dropped(const std::vector<std::filesystem::path>& files);
  // False, and says why, while the scene has to stay as it is.
  bool may_edit();
  void add_object(SceneObject object);  // it gets a place in reach
  void remove_selected();
  void duplicate_selected();
  void frame_selected();
  // The text that a recording keeps of the present scene.
  std::string scene_toml() const;
  // Where Ctrl+S writes to; empty for scenes that came with Limpid.
  std::filesystem::path own_scene_file() const;
  void save_scene();
  bool save_scene_as(const std::filesystem::path& file);
  // Does it at once, or after the user has been asked what to do with unsaved changes.
  void leave_scene(std::function<void()> then);
  // The scene that waits for the end of a device, if it has changes that no file has.
  const SetAside* unsaved_set_aside() const {
    return set_aside_ && set_aside_->unsaved ? &*set_aside_ : nullptr;
  }
  void save_and_leave();  // the answers
  void discard_and_leave();

  // A real device takes the arm's place, or leads the virtual one's hand; and back. The scene comes
  // along with all its changes, or, if it cannot, the user is asked first.
  void open_device(std::unique_ptr<Device> device);
  void close_device();
  // Closes a device beside the window.
  void let_go(std::unique_ptr<Device> device);

  // Recording and playback.
  void toggle_recording();
  // From when it was asked for: what is recorded has to stay as it is.
  bool recording() const { return live.recording() || opening_recording_.valid(); }
  void open_session(const std::filesystem::path& file);
  void toggle_playing();
  void close_playback();
  void start_rerun();
  void export_csv();
  void recover_leftovers();
  void save_picture(Window& window);
  int quality_level() const;  // of Quality, as the settings want it

  void say(std::string text, bool bad = false);
  bool playing_back() const { return playback.has_value(); }
  Stage& shown() { return playback ? *playback->stage : *stage; }
  // The row on screen, of the loop or of the recording; empty before the first.
  std::span<const double> row() const;

  Settings settings;
  Parameters& parameters;  // of settings
  Controls controls;
  Errands device_errands, file_errands;
  LiveLoop live;
  std::unique_ptr<Stage> stage;
  std::optional<Playback> playback;
  Camera camera;
  Analysis analysis;
  std::deque<Notice> notices;
  DeviceDesk devices;
  std::filesystem::path last_recording;
  SceneEditor editor;
  SceneLoader loader;
  UndoHistory<EditState> history;
  std::function<void()> after_question;  // of what to do with unsaved changes; none: not asked
  AutoQuality automatic_quality;
  Background<std::optional<Playback>> loading;
  Background<Rerun> rerunning;
  Background<std::string> exporting;
  std::string scene_file, device_file;
  Dialog dialog = Dialog::none;  // that is open

 private:
  // A world, and its loop.
  void open(ArmDescription arm, Scene scene, MeshModels models,
            std::unique_ptr<Device> device = nullptr, bool saved = true);
  // The same arm, in another scene.
  void open_beside(Scene scene, MeshModels models);
  std::unique_ptr<Stage> make_stage(ArmDescription arm, Scene scene,
                                    const MeshModels& models) const;
  void take_stage(std::unique_ptr<Stage> fresh);
  void take_scene(MeshModels models, bool saved = true);
  std::optional<SceneEditor::World> scene_for(const ArmDescription& arm) const;
  void change_arm(const ArmDescription& arm, std::unique_ptr<Device> device);
  void take_up_set_aside(const ArmDescription& arm);
  void start_recording();
  void follow_recording();
  void take_rows();
  void note_changes();
  void follow_parameters();
  void go_to(const std::optional<EditState>& state);
  void take_results();
  void show_rerun(Rerun again);
  void take_loaded();
  void accept(LoadedScene& loaded);
  void accept(LoadedModel& loaded);
  Workplace workplace() const;
  void show_scene();
  void hand_scene_over(bool at_once);

  EditState known_;      // at the last frame
  Parameters analysed_;  // that marks and analysis know
  SceneEditor::Version shown_;
  std::shared_ptr<const SceneEditor::World> touched_;  // by the loop
  std::chrono::steady_clock::time_point touched_since_;
  std::vector<double> rows_;
  bool was_diverged_ = false, was_running_ = false;
  std::optional<SetAside> set_aside_;
  std::future<std::unique_ptr<Recorder>> opening_recording_;
  std::future<Notice> closing_recording_;
};

}  // namespace limpid
