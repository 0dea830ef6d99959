// A loop with a device in the arm's place and no window: led from a command.
#pragma once

#include <functional>

#include "app/live/live_loop.h"
#include "app/run/simulate.h"

namespace limpid {

class LiveRun {
 public:
  // The plan's arm in its world with its parameters, from now on; without force. Errors: as
  // LiveLoop::open().
  LiveRun(const RunPlan& plan, const SafetyLimits& limits, std::unique_ptr<Device> device,
          AskForPriority ask);

  void arm() { loop_.arm(); }
  void cut() { loop_.cut(); }
  void set(const Parameters& parameters) { controls_.parameters = parameters; }
  // See LiveLoop.
  Parameters taken(const Parameters& p) const { return loop_.taken(p); }
  // Another scene for the same arm.
  void touch(const Scene& scene);

  using Row = std::function<void(std::span<const double>)>;
  // Lets it go on for so long, or until `stop`; false if that came first. Nobody else says that
  // somebody is there: force fades soon after this has returned. Errors: std::runtime_error where
  // the loop has ended, or the device is gone and does not come back within a second.
  bool pass(double seconds, const std::atomic<bool>& stop, const Row& row = {});

  void record(std::unique_ptr<Recorder> recorder) { loop_.record(std::move(recorder)); }
  // Returns the rows that found no room. Errors: FileError.
  std::uint64_t finish_recording();

  const Snapshot& now() const { return loop_.snapshot(); }

 private:
  void check();
  void drain(const Row& row);

  ArmDescription arm_;
  Controls controls_;
  LiveLoop loop_;
  std::vector<double> rows_;
  nanoseconds seen_{0};  // when the device answered last
};

}  // namespace limpid
