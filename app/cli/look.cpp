#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/base/folders.h"
#include "app/base/interrupt.h"
#include "app/cli/commands.h"
#include "app/cli/live_bench.h"
#include "app/cli/look_report.h"
#include "app/cli/options.h"
#include "app/cli/progress.h"
#include "app/device/device_hub.h"
#include "app/live/live_run.h"
#include "app/live/rtkit.h"
#include "app/run/fitted_gains.h"
#include "app/run/replay.h"
#include "devices/files/scene/scene_file.h"

namespace limpid {
namespace {

constexpr double kLookSeconds = 20, kMostLookSeconds = 86'400;  // [s]

struct LookOptions {
  std::string device;  // id; empty: the one in use, or the only one
  std::string record;
  double seconds = kLookSeconds;
  bool force = false, json = false;
};

// A device opened without need of a check, and how it is to be recorded.
struct Look {
  LookedDevice device;
  std::unique_ptr<Device> opened;
  SafetyLimits limits;
  RunPlan plan;
};

Look open_to_look(const LookOptions& options) {
  Look look;
  DeviceHub hub(device_store_file(), by_rtkit());
  choose_device(options.device, hub, "");
  const FoundDevice& found = *hub.present();
  if (found.kind->leads_hand) {
    throw UsageError(fmt::format(
        "{}: moves the hand of the virtual arm and has no joints to record; `limpid` uses it",
        found.place.id));
  }
  const DeviceNotes& notes = hub.notes(hub.in_use());
  look.opened = hub.open_to_look();
  look.device.traits = look.opened->traits();
  look.device.kind = found.kind->name;
  look.device.checked = notes.checked;
  TakenArm taken = hub.arm_for(look.device.traits);
  look.device.arm = taken.arm;
  look.device.arm_why = taken.why;
  look.limits = notes.limits;
  look.plan.arm = std::move(taken.arm);
  look.plan.document = read_scene(data_dir() / "assets/scenes/free.toml", look.plan.arm);
  look.plan.parameters = fitted(look.plan.arm);
  look.plan.hand.source = "device without force: " + device_text(look.device.traits);
  return look;
}

// How a look ended.
struct LookEnd {
  bool whole = false;
  double seconds = 0;
  std::string wrong;  // sentence; empty: nothing went wrong
};

void announce(const std::string& name, double seconds) {
  fmt::print(stderr,
             "limpid: {} is read for {:.3g} s and gets no force: the device never pushes. Move "
             "each joint slowly to both of its ends, hold the device still for a second, press its "
             "buttons; Ctrl-C ends the reading.\n",
             name, seconds);
}

// Records the device. Whatever ends it, what was seen is kept.
LookEnd record_look(Look& look, const LookOptions& options,
                    const std::shared_ptr<DeviceSeen>& seen) {
  LookEnd end;
  seen->noting = false;  // what is told is of the time that is recorded
  LiveRun run(look.plan, look.limits, std::make_unique<OnlyLooked>(std::move(look.opened), seen),
              by_rtkit());
  look.plan.parameters = run.taken(look.plan.parameters);
  SessionInfo info = session_info(look.plan);
  info.safety = limits_text(look.limits);
  auto recorder = std::make_unique<Recorder>(options.record, info, look.plan.parameters,
                                             options.force, Recorder::kLiveRoom);
  announce(look.device.traits.name, options.seconds);
  run.record(std::move(recorder));
  seen->noting = true;
  Progress progress({.title = "look", .whole = options.seconds, .unit = "s", .rate = ""});
  try {
    end.whole = run.pass(options.seconds, interrupted, [&](std::span<const double>) {
      progress.at(end.seconds += look.plan.parameters.tick);
    });
  } catch (const std::exception& error) {
    end.wrong = error.what();
  }
  seen->noting = false;
  try {
    const std::uint64_t lost = run.finish_recording();
    if (lost > 0 && end.wrong.empty()) {
      end.wrong =
          fmt::format("{} ticks are missing from {}: the disk was too slow", lost, options.record);
    }
  } catch (const FileError& error) {
    end.wrong = error.what();
  }
  return end;
}

int run_look(const LookOptions& options) {
  Look look = open_to_look(options);
  catch_interrupts();
  const auto seen = std::make_shared<DeviceSeen>();
  LookEnd end = record_look(look, options, seen);
  if (seen->readings() == 0 && end.wrong.empty()) end.wrong = "no reading came";
  const bool recorded = std::filesystem::exists(options.record);
  if (options.json) {
    nlohmann::ordered_json json = look_json(look.device, *seen);
    json["seconds"] = end.seconds;
    json["recorded"] = nullptr;
    if (recorded) json["recorded"] = options.record;
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else {
    fmt::print("{}", look_text(look.device, *seen));
    if (recorded) fmt::print("recorded {:.3f} s in {}\n", end.seconds, options.record);
  }
  if (!end.wrong.empty()) {
    throw std::runtime_error(
        fmt::format("{}: after {:.3f} s: {}", look.device.traits.id, end.seconds, end.wrong));
  }
  if (!end.whole) fmt::print(stderr, "limpid: stopped at {:.3f} s\n", end.seconds);
  return end.whole ? 0 : 1;
}

}  // namespace

Command declare_look(CLI::App& devices) {
  auto* command = devices.add_subcommand(
      "look", "reads a device for some time and records the readings; the device gets no force");
  auto options = std::make_shared<LookOptions>();
  command->add_option("DEVICE", options->device,
                      "the device's id, as `limpid devices` lists it; default: the device in use");
  command->add_option("--record", options->record, "the session file that is written")
      ->required()
      ->type_name("OUT.h5");
  require_above_zero(command
                         ->add_option("--seconds", options->seconds,
                                      "how long to read; Ctrl-C ends the reading earlier")
                         ->type_name("S")
                         ->capture_default_str(),
                     kMostLookSeconds, "s");
  command->add_flag("--force", options->force, "replace OUT.h5 if it exists");
  command->add_flag("--json", options->json, "one JSON object on standard output");
  command->footer(
      "Force is off and cannot be armed: no torque is sent to the device. The device's axes need "
      "no check before.\nThe arm is the one that the device reports, or that was identified or "
      "chosen for the device; otherwise a\nbuilt-in arm with the same number of joints. Send the "
      "session to Limpid's authors if they do not know your\ndevice.");
  return [options] { return run_look(*options); };
}

}  // namespace limpid
