// A live session without a window, led by programs on the control socket.
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/base/tasks.h"
#include "app/live/live_session.h"
#include "app/remote/remote.h"
#include "app/run/simulate.h"
#include "devices/device.h"

namespace limpid {

// A client's request to open files; empty: what is open stays, or its default.
struct OpenRequest {
  std::string scene, arm, tip, session, hand;
};

// Returns why a recording's tick is refused; empty if it is not. A tick that takes the computer
// from everything else is allowed only if a person has chosen it.
std::string refused_tick(const RunPlan& plan, double chosen);

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

  bool realtime() const { return loop().status().realtime.realtime(); }
  // The verbs and state for programs. Valid as long as this.
  RemoteHost host();
  // Cuts the force; from any thread.
  void cut() { loop().cut(); }
  // Call once a turn, at least every SafetyLimits::kSilence / 4. Passes the new rows to `remote`.
  // Errors: std::runtime_error if the loop has ended.
  void turn(Remote& remote);

 private:
  void begin(World world, bool hand_waits);
  nlohmann::json state() const;
  Answer open(const Keys& keys);
  Answer record(const Keys& keys);
  Answer stop();
  Answer start_over();
  Answer mark(const Keys& keys);
  Answer twin(const Keys& keys);
  Answer picture(const Keys& keys);
  nlohmann::json place() const;
  LiveLoop& loop() { return session_.loop(); }
  const LiveLoop& loop() const { return session_.loop(); }
  Controls& controls() { return session_.controls(); }
  const Controls& controls() const { return session_.controls(); }
  void watch_buttons();
  std::string source() const;

  Options options_;
  World world_;
  Parameters highest_;  // highest limits: a person's choice
  TraceChannels channels_;
  bool reopened_ = false;
  bool told_ = false;  // the failure of the last recording, to a client that stopped it
  // Work for a client that may have gone; one of each kind at a time.
  std::shared_ptr<std::future<World>> opening_;
  std::shared_ptr<std::future<bool>> drawing_;
  ButtonPresses buttons_;
  TaskQueue files_;      // beside the loop
  LiveSession session_;  // last, to be destroyed first
};

}  // namespace limpid
