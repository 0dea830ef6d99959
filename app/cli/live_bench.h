// Real devices in commands: the device, its arm and world, and the prompts that lead a hand.
#pragma once

#include "app/cli/options.h"
#include "app/device/device_hub.h"
#include "app/live/live_run.h"

namespace CLI {
class App;
}

namespace limpid {

// Options --live and --yes: the device, and whether it may push without a question.
struct LiveOptions {
  std::optional<std::string> device;  // id; empty: the one in use, or the only one; none: no device
  bool yes = false;

  // Declares --live and --yes.
  void add(CLI::App& command);
  // Prints a note on --yes without --live, which changes nothing.
  void say_unused() const;
};

// Makes the device of this id the hub's, as open_device() does. Errors: UsageError.
void choose_device(const std::string& id, DeviceHub& hub, const std::string& otherwise);

// Opens the device of this id; empty: the one in use, or the only one. `otherwise` is added to the
// message that none is chosen. Errors: UsageError, HidError.
std::unique_ptr<Device> open_device(const std::string& id, DeviceHub& hub,
                                    const std::string& otherwise);

// The arm that the device in use is taken for, with a note on stderr; or the arm of --device in
// `input`. Errors: as taken_arm().
ArmDescription arm_of_device(const DeviceTraits& traits, const DeviceHub& hub,
                             const InputOptions& input);

// A task for the hand, and its recording.
struct LiveTask {
  std::string instruction;
  double seconds = 10;
  std::filesystem::path out = {};  // session of the task; empty: none
  bool force = false;              // may replace `out`
  bool measure_grip = false;       // by an excitation from its begin on
};

class LiveBench {
 public:
  // Opens the device; its world is that of --scene, or one within its reach. Errors: UsageError,
  // FileError, HidError.
  LiveBench(const LiveOptions& options, const InputOptions& input);

  const RunPlan& plan() const { return plan_; }  // arm, world and parameters
  // Asks, arms, records, and takes the force away again; `row` receives every tick. False if
  // interrupted. Errors: FileError; std::runtime_error without force or device.
  bool carry_out(const LiveTask& task, const Parameters& p, const LiveRun::Row& row = {});
  // Sets another scene for the tasks that follow.
  void touch(const SceneDocument& document);

 private:
  // Time without force during a task, and its last reason.
  struct WithoutForce {
    double time = 0;  // [s]
    ForceState why = ForceState::on;

    void judge(double seconds) const;
  };

  bool ask(const std::string& instruction);
  bool await_force(bool full);
  bool lead(const LiveTask& task, double T, const LiveRun::Row& row, WithoutForce& off);
  std::unique_ptr<Recorder> recorder(const LiveTask& task, const Parameters& p) const;

  bool yes_;
  RunPlan plan_;
  SafetyLimits limits_;
  std::string name_;  // of the device
  std::unique_ptr<LiveRun> run_;
};

}  // namespace limpid
