#include "devices/registry/hid_devices.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <optional>

#include "devices/hid/hid_device.h"
#include "devices/hid/hid_error.h"
#include "devices/hid/hidapi_transport.h"
#include "devices/hid/protocols/protocols.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = 4096;  // of a file in sysfs

std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(kMostBytes, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

// Of "KEY=value" lines.
std::string value_of(const std::string& uevent, const std::string& key) {
  const std::string text = "\n" + uevent;
  const auto found = text.find("\n" + key + "=");
  if (found == std::string::npos) return {};
  const auto start = found + key.size() + 2;
  return text.substr(start, text.find('\n', start) - start);
}

struct Product {
  unsigned vendor = 0;
  std::string id;
};

// HID_ID=bus:vendor:product in hexadecimal, HID_UNIQ=serial number.
Product product_of(const std::string& uevent) {
  const std::string hid = value_of(uevent, "HID_ID");
  unsigned bus = 0, vendor = 0, product = 0;
  if (std::sscanf(hid.c_str(), "%x:%x:%x", &bus, &vendor, &product) != 3) return {};
  const std::string serial = value_of(uevent, "HID_UNIQ");
  return {vendor,
          fmt::format("{:04x}:{:04x}{}{}", vendor, product, serial.empty() ? "" : ":", serial)};
}

std::optional<ReportDescriptor> read_descriptor(const fs::path& path) {
  const std::string bytes = read_file(path);
  try {
    return parse_report_descriptor(
        {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  } catch (const HidError&) {
    return std::nullopt;
  }
}

std::string what_is_missing(const std::string& path, const fs::path& udev_rule) {
  if (access(path.c_str(), R_OK | W_OK) == 0) return {};
  if (access(path.c_str(), F_OK) != 0) return fmt::format("{} does not exist", path);
  return fmt::format(
      "no permission for {}: run 'sudo cp {} /etc/udev/rules.d/ && sudo udevadm control --reload' "
      "and plug it in again",
      path, udev_rule.string());
}

// The node's number is the device's, whatever names lead to it.
std::string hid_claim_key(const FoundDevice& found) {
  struct stat is {};
  if (stat(found.place.path.c_str(), &is) != 0 || !S_ISCHR(is.st_mode)) {
    return "hidraw:" + found.place.path;
  }
  return fmt::format("hidraw:{}:{}", major(is.st_rdev), minor(is.st_rdev));
}

std::unique_ptr<Device> open_hid_device(const FoundDevice& found, const PidSettings& settings,
                                        const AskForPriority& ask, DeviceClaim claim) {
  return open_hid_device_on(found, open_hidraw, settings, ask, std::move(claim));
}

}  // namespace

std::unique_ptr<Device> open_hid_device_on(const FoundDevice& found, const OpenTransport& open,
                                           const PidSettings& settings, const AskForPriority& ask,
                                           DeviceClaim claim) {
  try {
    auto transport = open(found.place.path);
    const auto descriptor = parse_report_descriptor(transport->report_descriptor());
    const HidProtocolEntry* entry = find_protocol(descriptor, transport->vendor());
    // Another device may have come to this path since the list was made.
    if (entry == nullptr || &entry->kind != found.kind) throw HidError("it has been unplugged");
    auto protocol = entry->make(descriptor, settings);
    return std::make_unique<HidDevice>(std::move(transport), std::move(protocol), found.place, ask,
                                       std::move(claim));
  } catch (const HidError& error) {
    throw HidError(fmt::format("{}: {}", found.place.name, error.what()));
  }
}

std::vector<FoundDevice> list_hid_devices(const fs::path& udev_rule, const HidRoots& roots) {
  std::vector<FoundDevice> found;
  std::error_code error;  // no such folder: no devices
  for (fs::directory_iterator entry(roots.sysfs, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path device = entry->path() / "device";
    const auto descriptor = read_descriptor(device / "report_descriptor");
    const std::string uevent = read_file(device / "uevent");
    const Product product = product_of(uevent);
    const HidProtocolEntry* protocol =
        descriptor ? find_protocol(*descriptor, static_cast<std::uint16_t>(product.vendor))
                   : nullptr;
    if (protocol == nullptr) continue;
    std::string missing = protocol->objection(*descriptor);
    const std::string path = (roots.dev / entry->path().filename()).string();
    if (missing.empty()) missing = what_is_missing(path, udev_rule);
    found.push_back({{value_of(uevent, "HID_NAME"), product.id, path},
                     &protocol->kind,
                     missing,
                     open_hid_device,
                     hid_claim_key});
  }
  std::sort(found.begin(), found.end(),
            [](const FoundDevice& a, const FoundDevice& b) { return a.place.path < b.place.path; });
  return found;
}

}  // namespace limpid
