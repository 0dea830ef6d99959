#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "app/cli/commands.h"
#include "app/cli/live_bench.h"
#include "app/cli/options.h"
#include "app/device/device_hub.h"
#include "app/run/provenance.h"

namespace limpid {
namespace {

constexpr const char* kAskAgain = "unsaid";

// Options that say which arm a device is.
struct ArmOptions {
  std::string device, arm, tip;  // device: id; empty: the one in use, or the only one
};

// Stores the arm of a device. Connects to the device, which alone knows what it is.
int say_arm(const ArmOptions& options) {
  DeviceHub hub(device_store_file(), {});
  const std::string in_use = hub.in_use();
  choose_device(options.device, hub, "");
  if (!hub.may_say_arm()) {
    throw UsageError(
        fmt::format("--arm: {} {}", hub.present()->place.name,
                    hub.notes(hub.in_use()).arm.empty()
                        ? "has no arm to choose: the device reports its arm itself, or has no arm"
                        : "was identified; `limpid identify --forget` removes the identified arm"));
  }
  std::string file = options.arm == kAskAgain ? std::string() : options.arm;
  if (!file.empty() && file != kBuiltInArm) {
    if (!std::filesystem::exists(file)) {
      throw FileError(file + ": no such file" + shipped_hint(file, {"devices"}));
    }
    file = std::filesystem::absolute(file).string();
  }
  const std::unique_ptr<Device> device = hub.open_to_look();
  hub.say_arm(file, file.empty() ? std::string() : options.tip, &device->traits());
  std::string said = "no arm is chosen for this device any more";
  if (!file.empty()) {
    const TakenArm taken = hub.arm_for(device->traits());
    if (!taken.known) throw UsageError("--arm: " + taken.why);
    said = taken.why;
  }
  hub.use(in_use);
  if (const std::string wrong = hub.save(); !wrong.empty()) throw std::runtime_error(wrong);
  fmt::print("{}\n", said);
  return 0;
}

void print_json(DeviceHub& hub) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const FoundDevice& found : hub.found()) {
    list.push_back({{"id", found.place.id},
                    {"name", found.place.name},
                    {"kind", found.kind->name},
                    {"path", found.place.path},
                    {"in_use", found.place.id == hub.in_use()},
                    {"in_use_by", found.in_use_by},
                    {"library", found.place.library},
                    {"library_version", found.version},
                    {"arm", arm_words(hub.notes(found.place.id), *found.kind)},
                    {"missing", found.missing}});
  }
  const nlohmann::ordered_json json{{"provenance", provenance("", std::nullopt)},
                                    {"devices", list}};
  fmt::print("{}\n", json.dump(2));
}

void print_text(DeviceHub& hub) {
  fmt::print(
      "virtual arm\n  built in; any URDF chain of 1 to 32 joints (--device), moved by the mouse or "
      "by a recorded hand motion\n");
  for (const FoundDevice& found : hub.found()) {
    fmt::print("{}\n  {}, {} at {}{}\n  {}\n", found.place.name, found.kind->name, found.place.id,
               found.place.path, found.place.id == hub.in_use() ? ", in use" : "",
               found.missing.empty() ? found.kind->use : found.missing);
    const std::string arm = arm_words(hub.notes(found.place.id), *found.kind);
    if (!arm.empty()) fmt::print("  {}\n", arm);
    if (!found.in_use_by.empty()) fmt::print("  in use by {}\n", found.in_use_by);
    if (!found.place.library.empty()) {
      fmt::print("  driven by {}{}\n", found.place.library,
                 found.version.empty() ? "" : ", version " + found.version);
    }
  }
  if (hub.found().empty()) fmt::print("no haptic device is plugged in\n");
}

int devices(bool json) {
  DeviceHub hub(device_store_file(), {});
  hub.take(DeviceHub::look(hub.in_use()));
  json ? print_json(hub) : print_text(hub);
  if (!hub.complaint().empty()) throw UsageError(hub.complaint());
  return 0;
}

}  // namespace

Command declare_devices(CLI::App& app) {
  auto* command = app.add_subcommand("devices", "lists connected devices and the drivers for them");
  command->footer(
      "Limpid finds these devices: the 3Dconnexion SpaceMouse family, joysticks and wheels with "
      "USB PID force\nfeedback, devices that speak Limpid's open raw-HID protocol "
      "(devices/hid/raw_protocol.h), and programs that\nspeak this protocol on a socket, "
      "$XDG_RUNTIME_DIR/limpid/NAME.device. limpid_device.py is such a program.\nIt simulates a "
      "device. It is in share/doc/limpid/examples, or in assets/python of the sources.\n"
      "Limpid also finds each Inverse3 of a Haply Inverse Service at localhost:10001, or at the "
      "address in the id\nof the device in use: inverse3:ID@HOST:PORT. Touch, Omni and Premium "
      "(OpenHaptics), "
      "omega, delta, sigma,\nlambda and Falcon (Force Dimension) are found where their makers' "
      "libraries are installed: limpid-vendor\nloads the libraries, and `limpid doctor` says which "
      "libraries are missing.\n\nThe arm's joint ranges and link lengths limit what a device's "
      "motors may do. If a device does not report\nits arm, choose the arm once, here or in the "
      "window's Device panel. Until then Limpid uses a built-in arm\nwith the same number of "
      "joints, and gives only little force.");
  auto options = std::make_shared<ArmOptions>();
  auto* arm =
      command
          ->add_option("--arm", options->arm,
                       fmt::format("the device's arm: a URDF, or {}; {}: forget the chosen arm",
                                   kBuiltInArm, kAskAgain))
          ->transform(or_shipped({"devices"}), "", "")
          ->type_name("FILE.urdf");
  command->add_option("--tip", options->tip, "the link of that URDF that the hand holds")
      ->needs(arm);
  command->add_option("DEVICE", options->device,
                      "with --arm: the device's id, as listed here; default: the device in use");
  auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "one JSON object on standard output")->excludes(arm);
  const Command look = declare_look(*command);
  return [options, json, command, look] {
    if (!command->get_subcommands().empty()) {
      if (options->device.empty() && options->arm.empty() && !*json) return look();
      throw UsageError("look: write device and options after `look`");
    }
    if (!options->arm.empty()) return say_arm(*options);
    if (options->device.empty()) return devices(*json);
    throw UsageError(fmt::format(
        "{}: a device can be named only together with --arm, which chooses the device's arm",
        options->device));
  };
}

}  // namespace limpid
