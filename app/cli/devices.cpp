#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/cli/commands.h"
#include "app/cli/options.h"
#include "app/device/device_hub.h"
#include "app/run/provenance.h"

namespace limpid {
namespace {

void print_json(const DeviceHub& hub) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const FoundDevice& found : hub.found()) {
    list.push_back({{"id", found.place.id},
                    {"name", found.place.name},
                    {"kind", found.kind->name},
                    {"path", found.place.path},
                    {"in_use", found.place.id == hub.in_use()},
                    {"in_use_by", found.in_use_by},
                    {"missing", found.missing}});
  }
  const nlohmann::ordered_json json{{"provenance", provenance("", std::nullopt)},
                                    {"devices", list}};
  fmt::print("{}\n", json.dump(2));
}

void print_text(const DeviceHub& hub) {
  fmt::print(
      "virtual arm\n  built in; any URDF chain of 1 to 32 joints (--device), driven by "
      "the mouse or a recorded hand\n");
  for (const FoundDevice& found : hub.found()) {
    fmt::print("{}\n  {}, {} at {}{}\n  {}\n", found.place.name, found.kind->name, found.place.id,
               found.place.path, found.place.id == hub.in_use() ? ", in use" : "",
               found.missing.empty() ? found.kind->use : found.missing);
    if (!found.in_use_by.empty()) fmt::print("  in use by {}\n", found.in_use_by);
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
  auto* command = app.add_subcommand("devices", "what is connected, what can drive it");
  command->footer(
      "Known are the 3Dconnexion SpaceMouse family, joysticks and wheels with USB PID force "
      "feedback,\nand devices that speak Limpid's open raw-HID protocol "
      "(devices/hid/raw_protocol.h),\nalso programs that do so on a socket, "
      "$XDG_RUNTIME_DIR/limpid/NAME.device\n(assets/python/limpid_device.py), and the Inverse3s of "
      "a "
      "Haply Inverse Service at localhost:10001,\nor where the id of the one in use says: "
      "inverse3:ID@HOST:PORT.");
  auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "one JSON object on standard output");
  return [json] { return devices(*json); };
}

}  // namespace limpid
