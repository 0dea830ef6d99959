// A live loop without a window, led by programs on the control socket.
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/base/tasks.h"
#include "app/live/live_loop.h"
#include "app/remote/remote.h"
#include "app/run/simulate.h"
#include "devices/device.h"

namespace limpid {

// A client's request to open files; empty: what is open stays, or its default.
struct OpenRequest {
  std::string scene, arm, tip, session, hand;
};

class ServedSession {
 public:
  struct World {
    RunPlan plan;      // arm, scene, settings, hand
    bool led = false;  // led by the plan's hand; else nobody holds the virtual arm
  };
  struct Options {
    // Reads the world of the files; called on a thread beside the loop. `now`: present settings,
    // kept if the arm stays.
    std::function<World(const OpenRequest& asked, const Parameters& now)> open;
    // Draws a row of the plan into a file; called beside the loop.
    std::function<void(const std::filesystem::path& png, const RunPlan&, std::span<const double>)>
        draw;
    std::filesystem::path folder;  // for recordings without a name
    AskForPriority ask;
  };

  // `device` takes the arm's place, within `limits`; null: the virtual arm. Errors: as
  // LiveLoop::open().
  ServedSession(World world, std::unique_ptr<Device> device, const SafetyLimits& limits,
                Options options);
  ~ServedSession();  // completes a recording

  bool realtime() const { return loop_.status().realtime.realtime(); }
  // The verbs and state for programs. Valid as long as this.
  RemoteHost host();
  // Cuts the force; from any thread.
  void cut() { loop_.cut(); }
  // Call once a turn, at least every SafetyLimits::kSilence / 4. Passes the new rows to `remote`.
  // Errors: std::runtime_error if the loop has ended.
  void turn(Remote& remote);

 private:
  struct Recording {
    std::future<std::unique_ptr<Recorder>> opening;
    std::future<void> closing;
    std::filesystem::path file;
    std::uint64_t rows = 0, dropped = 0;  // dropped: rows that found no room
    std::string failure;
    std::string trouble;  // why it ended by itself, for people; empty: it did not
    bool complete = false;
  };

  void begin(World world, bool hand_waits);
  nlohmann::json state() const;
  void set(const Parameters& p, bool of_twin);
  Answer open(const Keys& keys);
  Answer record(const Keys& keys);
  Answer stop();
  Answer start_over();
  Answer mark(const Keys& keys);
  Answer twin(const Keys& keys);
  Answer picture(const Keys& keys);
  nlohmann::json place() const;
  void follow_recording();
  bool recording() const { return loop_.recording() || recording_.opening.valid(); }
  void watch_buttons();
  std::string source() const;

  Options options_;
  World world_;
  Controls controls_;
  Parameters highest_;  // highest limits: a person's choice
  TraceChannels channels_;
  std::vector<double> rows_, newest_;  // rows drained; the last of them with its twin
  std::uint64_t tick_ = 0;             // of newest_
  bool reopened_ = false;
  Recording recording_;
  // Work for a client that may have gone; one of each kind at a time.
  std::shared_ptr<std::future<World>> opening_;
  std::shared_ptr<std::future<bool>> drawing_;
  ButtonPresses buttons_;
  std::optional<Parameters> of_twin_;
  TaskQueue recordings_, files_;  // beside the loop
  LiveLoop loop_;                 // last, to be destroyed first
};

}  // namespace limpid
