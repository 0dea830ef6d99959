#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "app/base/folders.h"
#include "app/doctor/doctor.h"
#include "devices/hid/device_list.h"
#include "devices/hid/vendor_devices.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using State = Finding::State;

constexpr const char* kDevicesArea = "devices";
constexpr const char* kRule = "70-limpid.rules";

std::string installed_rule() {
  std::error_code none;
  for (const char* folder :
       {"/etc/udev/rules.d", "/run/udev/rules.d", "/usr/lib/udev/rules.d", "/lib/udev/rules.d"}) {
    const fs::path file = fs::path(folder) / kRule;
    if (fs::exists(file, none)) return file.string();
  }
  return {};
}

Finding rule() {
  const std::string file = installed_rule();
  if (!file.empty()) return {kDevicesArea, "udev rule", State::fine, file, {}, {}};
  std::string source = fmt::format("assets/udev/{}", kRule);
  try {
    source = (data_dir() / source).string();
  } catch (const std::exception&) {  // reported among the files
  }
  return {kDevicesArea,
          "udev rule",
          State::better,
          "not installed",
          "only root may talk to HID devices",
          fmt::format("sudo cp {} /etc/udev/rules.d/ && sudo udevadm control --reload    # then "
                      "plug in again",
                      source)};
}

Finding on_hid() {
  std::error_code none;
  std::size_t nodes = 0;
  for (fs::directory_iterator node("/sys/class/hidraw", none), end; !none && node != end;
       node.increment(none)) {
    ++nodes;
  }
  if (!none)
    return {kDevicesArea, "HID", State::fine, fmt::format("{} hidraw nodes", nodes), {}, {}};
  return {kDevicesArea,
          "HID",
          State::better,
          "the kernel has no /sys/class/hidraw",
          "USB devices cannot be used; devices on sockets can",
          "a kernel with CONFIG_HIDRAW, for example Debian's: sudo apt install linux-image-amd64"};
}

Finding one(const FoundDevice& device) {
  const std::string what = fmt::format("{} ({})", device.place.name, device.place.id);
  const std::string kind = fmt::format("{} at {}", device.kind->name, device.place.path);
  if (device.missing.empty()) return {kDevicesArea, what, State::fine, kind, {}, {}};
  if (device.kind->service || access(device.place.path.c_str(), R_OK | W_OK) == 0) {
    return {kDevicesArea, what, State::better, kind, "this device is ignored", device.missing};
  }
  const std::string mend =
      installed_rule().empty()
          ? "install the udev rule, and plug the device in again"
          : fmt::format(
                "plug the device in again, at the computer itself and not through ssh; if the "
                "device's number is not in {}, add a line for it",
                installed_rule());
  return {kDevicesArea,        what,
          State::broken,       kind + ": " + device.missing.substr(0, device.missing.find(':')),
          "it cannot be used", mend};
}

// A maker's library: nobody without a device of that maker needs it.
Finding library(const VendorLine& line) {
  const std::string what = fmt::format("library for {}", line.back_end);
  if (line.missing.empty()) {
    const std::string version = line.version.empty() ? "" : ", version " + line.version;
    return {kDevicesArea, what, State::fine, line.name + version, {}, {}};
  }
  if (line.absent) {
    return {kDevicesArea, what, State::fine, line.missing, {}, {}};
  }
  return {kDevicesArea, what, State::better, "it cannot be used", "such devices are ignored",
          line.missing};
}

}  // namespace

DoctorFindings look_at_devices() {
  DoctorFindings all{rule(), on_hid()};
  const std::vector<FoundDevice> found = list_devices({.udev_rule = kRule});
  for (const FoundDevice& device : found) all.push_back(one(device));
  for (const VendorLine& line : ask_vendors()) {
    if (!line.is_device) all.push_back(library(line));
  }
  if (found.empty()) {
    all.push_back({kDevicesArea,
                   "haptic device",
                   State::fine,
                   "no device is plugged in; the virtual arm works without one",
                   {},
                   {}});
  }
  return all;
}

}  // namespace limpid
