// A session with a device in the arm's place, led by a command without a window.
#pragma once

#include <functional>

#include "app/live/live_session.h"
#include "app/run/simulate.h"

namespace limpid {

class LiveRun {
 public:
  // Runs the plan's arm in its world with its parameters, without force. Errors: as
  // LiveLoop::open().
  LiveRun(const RunPlan& plan, const SafetyLimits& limits, std::unique_ptr<Device> device,
          AskForPriority ask);

  void arm() { session_.loop().arm(); }
  void cut() { session_.loop().cut(); }
  void measure_grip() { ++session_.controls().probe; }
  void set(const Parameters& parameters) { session_.set(kMainLane, parameters); }
  // Settings as the loop takes them, see LiveLoop.
  Parameters taken(const Parameters& p) const { return session_.loop().taken(p); }
  // Sets another scene for the same arm.
  void touch(const Scene& scene);

  using Row = std::function<void(std::span<const double>)>;
  // Runs for `seconds`, or until `stop`; false if stopped. Force fades soon after it returns, as
  // nothing else tells the loop that somebody is there. Errors: std::runtime_error if the loop has
  // ended, or the device is gone for over a second; FileError if the recording ended by itself.
  bool pass(double seconds, const std::atomic<bool>& stop, const Row& row = {});

  void record(std::unique_ptr<Recorder> recorder) { session_.record(std::move(recorder)); }
  // Returns the number of rows that found no room. Errors: FileError.
  std::uint64_t finish_recording();

  const Snapshot& now() const { return session_.loop().snapshot(); }

 private:
  void check();

  ArmDescription arm_;
  LiveSession session_;
  nanoseconds seen_{0};  // time of the device's last answer
};

}  // namespace limpid
