// A running loop with its controls, the rows of all its lanes, and its recording: what the window,
// `limpid serve` and live commands have in common.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/base/tasks.h"
#include "app/live/live_loop.h"
#include "app/run/recorder.h"

namespace limpid {

// The newest recording of a session.
struct Recorded {
  std::filesystem::path file;
  std::uint64_t rows = 0, dropped = 0;  // dropped: rows for which there was no room
  bool complete = false;
  std::string trouble = {};  // why it ended by itself, for people; empty: it did not
  std::string failure = {};  // why it could not be opened or completed; empty: it could
};

// Events of a recording in one turn.
struct RecordingNews {
  bool began = false;        // the loop has it from now on
  bool ended = false;        // the loop has let go of it; its file is being completed
  bool complete = false;     // its file is complete
  std::string note = {};     // about its file system, for people
  std::string failure = {};  // as Recorded's
};

class LiveSession {
 public:
  // `dispose` as LiveLoop's.
  explicit LiveSession(AskForPriority ask, Dispose dispose = {});
  ~LiveSession();  // completes a recording
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;

  // Open another world and its loop, with the virtual arm at rest at `home` [m], or with a device
  // in the arm's place. Nobody holds the arm then. Errors: as LiveLoop::open(); the world of before
  // goes on then.
  void open(const ArmDescription& arm, const Scene& scene, const Parameters& p, const Vec3& home);
  void open(const ArmDescription& arm, const Scene& scene, const Parameters& p,
            std::unique_ptr<Device> device);
  // Gives another state of the scene, or another scene, for the same arm to the loop.
  void touch(const ArmDescription& arm, const Scene& scene);

  LiveLoop& loop() { return loop_; }
  const LiveLoop& loop() const { return loop_; }
  Controls& controls() { return controls_; }
  const Controls& controls() const { return controls_; }
  // Parameters of the lanes that run.
  std::span<const Parameters> lanes() const {
    return std::span(controls_.lanes).first(controls_.lane_count);
  }
  // Sets the settings of a lane that runs, or begins to. All lanes share one hand and one world:
  // those of the first.
  void set(std::size_t lane, const Parameters& p);
  // Ends all lanes from this one on, or lets this one run as well.
  void run_lanes(std::size_t count) { controls_.lane_count = count; }
  // Returns the newest rows of the lanes that run, and the number of their tick; zeros before the
  // first tick of a world.
  std::vector<std::span<const double>> rows() const;
  std::uint64_t tick() const { return tick_; }
  bool ticked() const { return ticked_; }

  using TakeTick = std::function<void(LaneRows rows, std::uint64_t tick)>;
  // Sends the controls to the loop, follows the recording, and passes on the rows of every tick
  // since the last call: NaN where no lane runs. To be called once a turn, at least every
  // SafetyLimits::kSilence / 4.
  RecordingNews turn(const TakeTick& take);

  // Returns whether a recording runs or is being opened: its world must not change.
  bool recording() const { return loop_.recording() || opening_.valid(); }
  bool opening_recording() const { return opening_.valid(); }
  // Returns whether a stopped recording is not complete yet.
  bool closing() const { return loop_.recorder() != nullptr || closing_.valid(); }
  // Begins a recording to `file`, opened beside the loop, of lanes with these parameters.
  // `replaces`: the complete recording may replace an existing file. Preconditions: none is
  // recording or closing. The first row comes once these lanes run.
  void record(SessionInfo about, std::vector<Parameters> lanes, const std::filesystem::path& file,
              bool replaces);
  // Begins a recording that is open already.
  void record(std::unique_ptr<Recorder> recorder);
  void stop_recording() { loop_.stop_recording(); }
  const Recorded& last_recording() const { return last_; }
  // Returns why the last recording could not be completed, once.
  std::string take_failure() { return std::exchange(last_.failure, {}); }
  // Completes the recording, and waits for that. Errors: FileError.
  void complete_recording();

 private:
  RecordingNews follow_recording();
  void pass_on(const TakeTick& take);
  void begin(const Parameters& p, const Vec3& home);

  Controls controls_;
  std::vector<double> rows_, newest_;  // rows drained, and the last ones of all lanes
  std::uint64_t tick_ = 0;
  bool ticked_ = false;  // since open()
  std::future<std::unique_ptr<Recorder>> opening_;
  std::future<void> closing_;
  Recorded last_;
  TaskQueue files_;  // beside the loop
  LiveLoop loop_;    // last, to be destroyed first
};

}  // namespace limpid
