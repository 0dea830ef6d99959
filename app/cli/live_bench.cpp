#include "app/cli/live_bench.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <utility>

#include "app/base/interrupt.h"
#include "app/cli/progress.h"
#include "app/live/rtkit.h"
#include "app/run/own_world.h"
#include "app/run/replay.h"
#include "devices/files/atomic_file.h"
#include "devices/files/scene/scene_file.h"

namespace limpid {
namespace {

constexpr double kGlance = 0.05;           // interval of looking for input while the loop runs [s]
constexpr double kLongestWait = 20;        // longest wait for force [s]
constexpr double kMostWithoutForce = 0.1;  // of a task's duration
constexpr double kWorthSaying = 0.005;     // shortest time worth a message [s]
constexpr double kBreath = 1;              // wait before a task without a question [s]

// "connected devices: socket:springs, 1234:5678:9".
std::string those_there(const DeviceHub& hub) {
  std::string ids;
  for (const FoundDevice& found : hub.found()) {
    if (!found.missing.empty()) continue;
    ids += (ids.empty() ? "connected devices: " : ", ") + found.place.id;
  }
  return ids.empty() ? "no device is connected" : ids;
}

}  // namespace

void LiveOptions::add(CLI::App& command) {
  command
      .add_option_function<std::string>(
          "--live", [this](const std::string& id) { device = id; },
          "use a real device moved by your hand, not a recorded motion: the device's id, as "
          "`limpid devices` lists it; default: the device in use")
      ->type_name("[ID]")
      ->expected(0, 1);
  command.add_flag("--yes", yes, "with --live: begin without a question");
}

void LiveOptions::say_unused() const {
  if (!yes || device) return;
  fmt::print(stderr,
             "limpid: note: --yes changes nothing here: only --live asks a question before it "
             "begins\n");
}

void choose_device(const std::string& id, DeviceHub& hub, const std::string& otherwise) {
  std::string wanted = id.empty() ? hub.in_use() : id;
  if (const std::string named = device_named(wanted); !named.empty()) wanted = named;
  hub.take(DeviceHub::look(wanted));
  if (wanted.empty() && hub.found().size() == 1) wanted = hub.found().front().place.id;
  if (wanted.empty()) {
    throw UsageError("no device is chosen; `limpid devices` lists the devices' ids" + otherwise);
  }
  hub.use(wanted);
  hub.take(hub.found());
  if (hub.present() == nullptr) {
    throw UsageError(fmt::format("{}: is not connected; {}", wanted, those_there(hub)));
  }
  if (!hub.refusal().empty()) throw UsageError(hub.refusal());
}

std::unique_ptr<Device> open_device(const std::string& id, DeviceHub& hub,
                                    const std::string& otherwise) {
  choose_device(id, hub, otherwise);
  const auto refuse = [&] [[noreturn]] {
    throw UsageError(
        fmt::format("{}: the axes must be checked before the device may push; start limpid, choose "
                    "the device in the Device panel and press \"Check the axes\"",
                    hub.present()->place.name));
  };
  if (hub.needs_check() && hub.present()->missing.empty()) refuse();
  try {
    return hub.opening()();
  } catch (const UncheckedError&) {
    refuse();
  }
}

ArmDescription arm_of_device(const DeviceTraits& traits, const DeviceHub& hub,
                             const InputOptions& input) {
  std::optional<ArmDescription> named;
  if (!input.device.empty() && device_named(input.device).empty()) named = arm_of(input);
  TakenArm taken = hub.arm_for(traits, named ? &*named : nullptr);
  fmt::print(stderr, "limpid: {}\n", taken.why);
  if (!traits.made_by.empty()) {
    fmt::print(stderr, "limpid: {} is driven by {}\n", traits.name, traits.made_by);
  }
  return std::move(taken.arm);
}

LiveBench::LiveBench(const LiveOptions& options, const InputOptions& input) : yes_(options.yes) {
  DeviceHub hub(device_store_file(), by_rtkit());
  std::unique_ptr<Device> device = open_device(*options.device, hub, "");
  const DeviceTraits& traits = device->traits();
  name_ = traits.name;
  if (!traits.pushes) throw UsageError(name_ + ": has no motors");
  if (!yes_ && isatty(STDIN_FILENO) == 0) {
    throw UsageError(
        "a person must allow the device to push, but there is no terminal to ask in; needed: "
        "--yes, or a terminal");
  }
  plan_.arm = arm_of_device(traits, hub, input);
  const std::filesystem::path scene =
      input.scene.empty() ? scene_of_device(plan_.arm) : std::filesystem::path(input.scene);
  plan_.document = read_scene(scene, plan_.arm);
  plan_.models = build_meshes(plan_.document);
  const DeviceNotes& notes = hub.notes(hub.in_use());
  Parameters usual = make_parameters(input, plan_.arm);
  notes.compensation.give(usual);  // as in the window
  plan_.parameters = make_parameters(input, usual);
  plan_.hand.source = "device: " + device_text(traits);
  limits_ = notes.limits;
  catch_interrupts();
  run_ = std::make_unique<LiveRun>(plan_, limits_, std::move(device), by_rtkit());
  plan_.parameters = run_->taken(plan_.parameters);  // as verdicts and recordings use them
}

void LiveBench::touch(const SceneDocument& document) {
  plan_.document = document;
  run_->touch(document.scene);
}

// Prints the instruction and waits for Enter, while the loop runs without force.
bool LiveBench::ask(const std::string& instruction) {
  fmt::print("{}\n", instruction);
  if (yes_) return run_->pass(kBreath, interrupted);
  return await_enter(fmt::format("{} will push. Enter begins, Ctrl-C ends: ", name_),
                     [this] { return run_->pass(kGlance, interrupted); });
}

// Waits for force; `full`: until it has faded in. Returns false if stopped.
bool LiveBench::await_force(bool full) {
  run_->arm();
  std::string said;
  for (double waited = 0; waited < kLongestWait; waited += kGlance) {
    if (!run_->pass(kGlance, interrupted)) return false;
    const ForceState state = run_->now().force_state;
    if (full ? run_->now().arming == Arming::on : state == ForceState::on) return true;
    if (const std::string why = explain(state); why != said && waited > 0.5) {
      fmt::print(stderr, "limpid: waiting for force: {}\n", said = why);
    }
  }
  throw std::runtime_error(fmt::format("{}: gets no force: {}", name_, said));
}

std::unique_ptr<Recorder> LiveBench::recorder(const LiveTask& task, const Parameters& p) const {
  RunPlan plan = plan_;
  plan.parameters = run_->taken(p);
  SessionInfo info = session_info(plan);
  info.safety = limits_text(limits_);
  return std::make_unique<Recorder>(task.out, info, plan.parameters, task.force,
                                    Recorder::kLiveRoom);
}

// Refuses a task mostly without force, which shows nothing of a coupling.
void LiveBench::WithoutForce::judge(double seconds) const {
  if (time <= kWorthSaying) return;
  fmt::print(stderr, "limpid: {:.2f} s were without force: {}\n", time, explain(why));
  if (time > seconds * kMostWithoutForce) {
    throw std::runtime_error("the device was without force for too long; repeat the trial");
  }
}

bool LiveBench::lead(const LiveTask& task, double T, const LiveRun::Row& row, WithoutForce& off) {
  Progress progress({.title = "live", .whole = task.seconds, .unit = "s", .rate = ""});
  const RowLayout layout = plan_.layout();
  double time = 0;
  return run_->pass(task.seconds, interrupted, [&](std::span<const double> tick) {
    progress.at(time += T);
    const double state = layout.in(tick, Column::force_state)[0];
    if (state != 0) {
      off.time += T;
      off.why = static_cast<ForceState>(state);
    }
    if (row) row(tick);
  });
}

bool LiveBench::carry_out(const LiveTask& task, const Parameters& p, const LiveRun::Row& row) {
  // Opened before the hand is asked for anything; without results it replaces no file.
  auto recording = task.out.empty() ? nullptr : recorder(task, p);
  const auto end = [&] {
    run_->cut();
    if (std::exchange(recording, nullptr)) {
      std::error_code none;
      std::filesystem::remove(part_of(task.out), none);
    }
    return run_->finish_recording();
  };
  run_->set(p);
  WithoutForce off;
  bool whole = false;
  std::uint64_t lost = 0;
  try {
    // A recording begins with all of the force: before that its first rows would be missing.
    whole = ask(task.instruction) && await_force(task.measure_grip || recording != nullptr);
    if (whole && recording) run_->record(std::move(recording));
    if (whole && task.measure_grip) run_->measure_grip();
    whole = whole && lead(task, p.tick, row, off);
    lost = end();
  } catch (...) {
    end();  // keeps what was recorded
    throw;
  }
  if (lost > 0) {
    throw std::runtime_error(fmt::format("{} ticks are missing from {}: the disk was too slow",
                                         lost, task.out.string()));
  }
  if (whole && run_->now().diverged) throw std::runtime_error("the coupling became unstable");
  if (whole) off.judge(task.seconds);
  return whole;
}

}  // namespace limpid
