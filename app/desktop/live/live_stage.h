// The live session on its stage: force, time, plots and recording, as the window has them.
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
#include "app/live/grip_meter.h"
#include "app/live/live_session.h"
#include "app/plot/plot_menu.h"
#include "app/run/simulate.h"
#include "app/stage/stage.h"

namespace limpid {

class LiveStage {
 public:
  LiveStage(Notices& notices, AskForPriority ask);
  ~LiveStage();
  LiveStage(const LiveStage&) = delete;
  LiveStage& operator=(const LiveStage&) = delete;

  // Opens another world and its loop, with `device` or, if null, the virtual arm. `shown` as
  // Stage's. Errors: as Stage and LiveLoop::open(); the world of before goes on then.
  void open(ArmDescription arm, SceneDocument document, const MeshModels& models,
            const Parameters& p, double shown, std::unique_ptr<Device> device);
  // Opens another scene for the same arm in the running loop. Errors: as Stage; std::runtime_error
  // if the scene has another number of moving objects.
  void open_beside(SceneDocument document, const MeshModels& models, const Parameters& p,
                   double shown);
  // Gives another state of the scene to the loop.
  void touch(const Scene& scene);

  LiveSession& session() { return session_; }
  const LiveSession& session() const { return session_; }
  LiveLoop& loop() { return session_.loop(); }
  const LiveLoop& loop() const { return session_.loop(); }
  Controls& controls() { return session_.controls(); }
  const Controls& controls() const { return session_.controls(); }
  GripMeter& grip() { return grip_; }
  Stage& stage() { return *stage_; }
  const Stage& stage() const { return *stage_; }
  std::span<const double> row() const { return rows().front(); }  // the newest row
  // Returns the newest rows of all lanes that run.
  std::vector<std::span<const double>> rows() const { return session_.rows(); }
  // Returns why further lanes cannot come or go now; empty if they can.
  std::string why_lanes_are_fixed() const;

  bool force_armed() const { return loop().snapshot().armed(); }
  // Controls the virtual arm's time. Returns why it cannot be changed, for people; empty if it can.
  std::string why_time_is_fixed() const;
  bool paused() const { return controls().paused && why_time_is_fixed().empty(); }
  void pause(bool paused) { controls().paused = paused; }
  void step(std::uint32_t ticks) { controls().steps += ticks; }
  // Returns "paused" or "1/10 speed"; empty at the usual pace.
  std::string pace_text() const;
  // Returns why the tip cannot pick anything up, for people; empty if it can.
  std::string why_no_magnet() const;
  // Switches the magnet at the tip on or off.
  void toggle_magnet();
  // Puts the arm at rest in the middle. Only shows a notice during a recording.
  void start_over();

  // Returns whether a recording runs or is being opened: its world must not change.
  bool recording() const { return session_.recording(); }
  // Returns false while the last recording is still being opened or closed.
  bool may_record();
  // Begins a recording to `file`. `replaces`: the complete recording may replace an existing file.
  void record(const RunPlan& plan, const std::filesystem::path& file, bool replaces = false);
  void stop_recording() { session_.stop_recording(); }
  // Returns whether a stopped recording is not complete yet.
  bool closing() const { return session_.closing(); }
  const Recorded& last_recording() const { return session_.last_recording(); }
  // Completes the recording after the loop has been closed; waits. Errors: FileError.
  void complete_recording() { session_.complete_recording(); }
  // Returns the file of a recording that has just ended, once.
  std::optional<std::filesystem::path> take_recorded() { return std::exchange(recorded_, {}); }

  // Receives the rows of every tick of the loop, and the tick's number.
  LiveSession::TakeTick on_row;

  // Queue for work on devices, which may hang. Files have another queue, so they never wait for it.
  TaskQueue& device_tasks() { return device_tasks_; }
  // Closes a device beside the window.
  void let_go(std::unique_ptr<Device> device);
  // Writes something beside the window, and shows a notice on the outcome.
  void save_beside(std::function<PlotNotice()> work);
  // Returns the last file that save_beside() wrote, once; empty: none.
  std::filesystem::path take_written() { return std::exchange(written_, {}); }

  // Sends the controls with the parameters of these lanes to the loop, and its rows to the plots;
  // to be called once a frame.
  void update(std::span<const Parameters> lanes);
  // Returns true once after the loop has become unstable.
  bool became_unstable();
  // Marks in the plots that a setting changes with the next update().
  void mark(const std::string& label, const std::string& key);
  // Moment of a note, which stands in the plots and in the recording, if one runs. Errors of
  // note(): FileError for a text that is too long.
  struct Moment {
    double time = 0;                        // on the history's axis [s]
    std::optional<std::uint64_t> row = {};  // of the recording
    const Recorder* recording = nullptr;
  };
  Moment now() const;
  void note(const Moment& at, const std::string& text);
  // Closes the loop and drops all pictures; to be called before the OpenGL context goes.
  void drop_pictures();

 private:
  std::unique_ptr<Stage> make_stage(ArmDescription arm, SceneDocument document,
                                    const MeshModels& models, const Parameters& p,
                                    double shown) const;
  void tell(const RecordingNews& news);
  void follow_saving();
  void set_marks();
  void watch_loop();

  Notices& notices_;
  TaskQueue device_tasks_, file_tasks_;
  LiveSession session_;
  GripMeter grip_{session_};
  std::unique_ptr<Stage> stage_;
  std::vector<PlotMark> changes_;  // marks whose time is not known yet
  bool was_diverged_ = false, was_running_ = false;
  std::vector<std::future<PlotNotice>> saving_;
  std::filesystem::path written_;
  std::optional<std::filesystem::path> recorded_;
};

}  // namespace limpid
