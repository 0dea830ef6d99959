// The running loop and what hangs on it: its controls, force, plots and recording.
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/base/tasks.h"
#include "app/desktop/base/notices.h"
#include "app/desktop/base/stage.h"
#include "app/live/live_loop.h"
#include "app/plot/plot_menu.h"
#include "app/run/simulate.h"

namespace limpid {

class LiveSession {
 public:
  LiveSession(Notices& notices, AskForPriority ask)
      : notices_(notices), loop_(std::move(ask), [this](std::unique_ptr<Device> device) {
          let_go(std::move(device));
        }) {}
  ~LiveSession();  // what is recorded is complete before the program ends
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;

  // Another world and its loop, with a real device or the virtual arm. `shown` as Stage's. Errors:
  // as Stage and LiveLoop::open(); what there was before goes on then.
  void open(ArmDescription arm, SceneDocument document, const MeshModels& models,
            const Parameters& p, double shown, std::unique_ptr<Device> device);
  // The same arm, and the loop that runs, in another scene.
  void open_beside(SceneDocument document, const MeshModels& models, const Parameters& p,
                   double shown);
  // Another state of the scene, for the loop.
  void touch(const Scene& scene);

  LiveLoop& loop() { return loop_; }
  const LiveLoop& loop() const { return loop_; }
  Controls& controls() { return controls_; }
  const Controls& controls() const { return controls_; }
  Stage& stage() { return *stage_; }
  const Stage& stage() const { return *stage_; }
  std::span<const double> row() const;       // the newest
  std::span<const double> twin_row() const;  // the same of the twin; empty without one
  // Why there can be no twin now, or the present one has to stay; empty if it may change.
  std::string why_twin_is_fixed() const;

  bool force_armed() const { return loop_.snapshot().armed(); }
  void toggle_force() { force_armed() ? loop_.cut() : loop_.arm(); }
  // The virtual arm's time: why it goes on as it is, for people, empty if it can be changed;
  // whether it stands still; one tick, or more, of it.
  std::string why_time_is_fixed() const;
  bool paused() const { return controls_.paused && why_time_is_fixed().empty(); }
  void pause(bool paused) { controls_.paused = paused; }
  void step(std::uint32_t ticks) { controls_.steps += ticks; }
  // "paused", "at 1/10 of the speed"; empty where it goes on as usual.
  std::string pace_text() const;
  // Why the tip cannot pick anything up, for people; empty if it can.
  std::string why_no_magnet() const;
  // The magnet at the tip on or off.
  void toggle_magnet();
  // At rest in the middle; a recording has to end first, and says so.
  void start_over();

  // From when it was asked for: what is recorded has to stay as it is.
  bool recording() const { return loop_.recording() || opening_.valid(); }
  // False while the last one is still being opened or closed.
  bool may_record();
  // `replaces`: a file that is there, once the recording is complete.
  void record(const RunPlan& plan, const std::filesystem::path& file, bool replaces = false);
  void stop_recording() { loop_.stop_recording(); }
  // What has been stopped is not complete yet.
  bool closing() const { return loop_.recorder() != nullptr || closing_.valid(); }
  struct Recorded {
    std::filesystem::path file;
    std::uint64_t rows = 0, dropped = 0;  // dropped: that found no room
    bool complete = false;
    std::string trouble = {};  // why it ended by itself, for people; empty: it did not
  };
  const Recorded& last_recording() const { return last_; }
  // Waits until what is recorded is complete, after the loop has been closed. Errors: FileError.
  void complete_recording();
  // The file of the recording that has just ended, once.
  std::optional<std::filesystem::path> take_recorded() { return std::exchange(recorded_, {}); }

  // Hears of every row that the loop has made, of the twin's beside it, and of which tick they are.
  std::function<void(std::span<const double>, std::span<const double>, std::uint64_t)> on_row;

  // Work on devices, which may hang; of their own, so that files never wait for it.
  TaskQueue& device_tasks() { return device_tasks_; }
  // Closes a device beside the window.
  void let_go(std::unique_ptr<Device> device);
  // Writes something beside the window, and says what became of it.
  void save_beside(std::function<PlotNotice()> work);
  // The file that was written that way last, once; empty: none.
  std::filesystem::path take_written() { return std::exchange(written_, {}); }

  // Once a frame: the controls with these parameters to the loop, and its rows to the plots.
  // `twin`: of a second run beside it; null: none.
  void update(const Parameters& p, const Parameters* twin);
  // True once the loop has become unstable, once.
  bool became_unstable();
  // Marks in the plots that something changes with the next update().
  void mark(const std::string& label, const std::string& key);
  // What somebody notes at a moment: in the plots, and, if it is of the recording that runs, in its
  // file. Errors: FileError for a text that is too long.
  struct Moment {
    double time = 0;                        // on the history's axis [s]
    std::optional<std::uint64_t> row = {};  // of the recording
    const Recorder* recording = nullptr;
  };
  Moment now() const;
  void note(const Moment& at, const std::string& text);
  // Before the OpenGL context goes.
  void drop_pictures();

 private:
  std::unique_ptr<Stage> make_stage(ArmDescription arm, SceneDocument document,
                                    const MeshModels& models, const Parameters& p,
                                    double shown) const;
  void take_stage(std::unique_ptr<Stage> fresh);
  void follow_recording();
  void follow_saving();
  void take_rows();
  void set_marks();
  void watch_loop();

  Notices& notices_;
  Controls controls_;
  TaskQueue device_tasks_, file_tasks_;
  LiveLoop loop_;
  std::unique_ptr<Stage> stage_;
  std::vector<double> rows_;
  std::vector<PlotMark> changes_;  // to be marked, at times not known yet
  bool was_diverged_ = false, was_running_ = false;
  std::future<std::unique_ptr<Recorder>> opening_;
  std::future<Notice> closing_;
  std::vector<std::future<PlotNotice>> saving_;
  std::filesystem::path written_;
  std::optional<std::filesystem::path> recorded_;
  Recorded last_;
};

}  // namespace limpid
