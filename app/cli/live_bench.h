// Real devices in commands: the device, its arm and its world, and the prompts that lead a hand.
#pragma once

#include "app/cli/options.h"
#include "app/device/device_hub.h"
#include "app/live/live_run.h"

namespace CLI {
class App;
}

namespace limpid {

// Which device, and whether to ask before it may push.
struct LiveOptions {
  std::optional<std::string> device;  // its id; empty: the one in use, or the only one; none: no
                                      // device
  bool yes = false;

  // Declares --live and --yes.
  void add(CLI::App& command);
};

// Makes the device of this id the hub's, as open_device() does. Errors: UsageError.
void choose_device(const std::string& id, DeviceHub& hub, const std::string& otherwise);

// Of this id; empty: the one in use, or the only one. `otherwise`: what is said beside that none is
// chosen. Errors: UsageError, HidError.
std::unique_ptr<Device> open_device(const std::string& id, DeviceHub& hub,
                                    const std::string& otherwise);

// The arm that the device in use is taken for, which it says on stderr; the arm of `input`, if that
// names one by --device. Errors: as taken_arm().
ArmDescription arm_of_device(const DeviceTraits& traits, const DeviceHub& hub,
                             const InputOptions& input);

// What a hand is asked to do, and what is recorded of it.
struct LiveTask {
  std::string instruction;
  double seconds = 10;
  std::filesystem::path out = {};  // its session; empty: none
  bool force = false;              // replaces it
};

class LiveBench {
 public:
  // Opens the device; its world is that of --scene, or one within its reach. Errors: UsageError,
  // FileError, HidError.
  LiveBench(const LiveOptions& options, const InputOptions& input);

  const RunPlan& plan() const { return plan_; }  // arm, world and parameters
  // Asks, arms, records, and takes the force away again; `row` sees every tick. False if it was
  // interrupted. Errors: FileError, std::runtime_error where there is no force, or the device goes.
  bool carry_out(const LiveTask& task, const Parameters& p, const LiveRun::Row& row = {});
  // Another scene for the tasks that follow.
  void touch(const SceneDocument& document);

 private:
  // Of a task: how long, and why last.
  struct WithoutForce {
    double time = 0;  // [s]
    ForceState why = ForceState::on;

    void judge(double seconds) const;
  };

  bool ask(const std::string& instruction);
  bool await_force();
  bool lead(const LiveTask& task, double T, const LiveRun::Row& row, WithoutForce& off);
  std::unique_ptr<Recorder> recorder(const LiveTask& task, const Parameters& p) const;

  bool yes_;
  RunPlan plan_;
  SafetyLimits limits_;
  std::string name_;  // of the device
  std::unique_ptr<LiveRun> run_;
};

}  // namespace limpid
