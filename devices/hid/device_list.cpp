#include "devices/hid/device_list.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>

#include "devices/hid/hid_device.h"
#include "devices/hid/hid_transport.h"
#include "devices/hid/inverse_protocol.h"
#include "devices/hid/protocols.h"
#include "devices/hid/raw_protocol.h"
#include "devices/hid/transports.h"
#include "devices/hid/vendor_devices.h"

namespace limpid {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = 4096;  // longest file in sysfs

std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(kMostBytes, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

// The value of `key` in "KEY=value" lines.
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

// Product in HID_ID=bus:vendor:product in hexadecimal, and HID_UNIQ=serial number.
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
      "and plug the device in again",
      path, udev_rule.string());
}

// Key of a HID device: the number of its node, whatever names lead to it.
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

constexpr int kLook = 300;      // longest wait for a service when looking for devices [ms]
constexpr int kConnect = 1000;  // longest wait for a service that is used [ms]
constexpr std::string_view kKey = "inverse3";

constexpr DeviceKind kInverseKind{.key = "inverse3",
                                  .name = "Haply Inverse3",
                                  .use = "has a tip that moves in three directions; gives force",
                                  .pushes = true,
                                  .arm = "inverse3.urdf",
                                  .service = true};

bool is_port(const std::string& text) {
  unsigned port = 0;
  const char* end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, port);
  return error == std::errc{} && at == end && port >= 1 && port <= 65535;
}

std::unique_ptr<Device> open_inverse(const FoundDevice& found, const PidSettings&,
                                     const AskForPriority& ask, DeviceClaim claim) {
  try {
    const auto name = inverse_name(found.place.id);
    return std::make_unique<HidDevice>(open_web_socket(name.value().address, kConnect),
                                       std::make_unique<InverseProtocol>(name->id),
                                       HidPlace{found.place.name, found.place.id, ""}, ask,
                                       std::move(claim));
  } catch (const HidError& error) {
    throw HidError(fmt::format("{}: {}", found.place.name, error.what()));
  }
}

std::vector<std::string> ids_at(const ServiceAddress& address) {
  const auto service = open_web_socket(address, kLook);
  Report first(HidTransport::kMaxMessage);
  const int size = service->read(first, kLook);
  return inverse_ids(std::span(first).first(static_cast<std::size_t>(std::max(size, 0))));
}

// Key of an Inverse3. A name without an id means the service's first device, and claims that one.
std::string inverse_claim_key(const FoundDevice& found) {
  const InverseName name = inverse_name(found.place.id).value();
  std::string id = name.id;
  if (id.empty()) {
    const std::vector<std::string> ids = ids_at(name.address);
    if (!ids.empty()) id = ids.front();
  }
  return fmt::format("inverse3:{}:{}", resolved(name.address), id);
}

FoundDevice entry(const InverseName& name, bool only, const std::string& missing) {
  const std::string place = name.address.text();
  const std::string which = only || name.id.empty() ? "" : " " + name.id;
  return {{fmt::format("Haply Inverse3{} ({})", which, place), name.text(), place},
          &kInverseKind,
          missing,
          open_inverse,
          inverse_claim_key};
}

constexpr DeviceKind kSocketKind{
    .key = "socket",
    .name = "device on a socket",
    .use = "has joints of its own; gives force if its description says so"};

// Returns whether somebody listens on a socket; a program that has ended leaves its socket behind.
// The kernel's error tells, if a connection of another type is asked for; the program does not
// notice.
bool somebody_listens(const fs::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string text = path.string();
  if (text.size() >= sizeof(address.sun_path)) return true;  // opening it says what is wrong
  text.copy(address.sun_path, text.size());
  const int file = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (file < 0) return true;
  const int result = connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof(address));
  const bool refused = result < 0 && errno == ECONNREFUSED;
  close(file);
  return !refused;
}

std::string socket_claim_key(const FoundDevice& found) {
  std::error_code error;
  const fs::path path = fs::canonical(found.place.path, error);
  return "socket:" + (error ? found.place.path : path.string());
}

std::unique_ptr<Device> open_socket_device(const FoundDevice& found, const PidSettings&,
                                           const AskForPriority& ask, DeviceClaim claim) {
  try {
    // No path for a guardian is needed: the end of this process closes the connection.
    return std::make_unique<HidDevice>(
        open_socket(found.place.path), std::make_unique<RawProtocol>(),
        HidPlace{found.place.name, found.place.id, ""}, ask, std::move(claim));
  } catch (const HidError& error) {
    throw HidError(fmt::format("{}: {}", found.place.name, error.what()));
  }
}

std::vector<FoundDevice> of_services(const DeviceSearch& search) {
  if (!search.services) return {};
  try {
    return list_inverse_devices(inverse_name(search.wanted));
  } catch (const HidError&) {  // `wanted` is malformed
    return list_inverse_devices({});
  }
}

// Every way by which devices are found, in the order of the list.
using ListDevices = std::vector<FoundDevice> (*)(const DeviceSearch& search);
constexpr ListDevices kWaysIn[] = {
    [](const DeviceSearch& search) { return list_hid_devices(search.udev_rule); },
    [](const DeviceSearch&) { return list_socket_devices(socket_folder()); },
    of_services,
    [](const DeviceSearch& search) {
      return search.services ? list_vendor_devices(ask_vendors(), search.wanted)
                             : std::vector<FoundDevice>();
    },
};

// The program that uses a device; empty if nobody can tell, as opening it then says why.
std::string user_of(const FoundDevice& found) {
  try {
    return claimed_by(found.claim_key(found));
  } catch (const HidError&) {
    return {};
  }
}

DeviceClaim claim(const FoundDevice& found) {
  try {
    return DeviceClaim(found.claim_key(found));
  } catch (const HidError& error) {
    throw HidError(fmt::format("{}: {}", found.place.name, error.what()));
  }
}

}  // namespace

std::unique_ptr<Device> open_hid_device_on(const FoundDevice& found, const OpenTransport& open,
                                           const PidSettings& settings, const AskForPriority& ask,
                                           DeviceClaim claim) {
  try {
    auto transport = open(found.place.path);
    const std::string id = transport->id();
    const auto descriptor = parse_report_descriptor(transport->report_descriptor());
    const HidProtocolEntry* entry = find_protocol(descriptor, transport->vendor());
    // Another device may have come to this path since the list was made.
    if (entry == nullptr || &entry->kind != found.kind || (!id.empty() && id != found.place.id)) {
      throw HidError("the device has been unplugged");
    }
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

std::string InverseName::text() const {
  return fmt::format("{}{}{}@{}", kKey, id.empty() ? "" : ":", id, address.text());
}

std::optional<InverseName> inverse_name(const std::string& words) {
  if (!words.starts_with(kKey)) return std::nullopt;
  std::string rest = words.substr(kKey.size());
  if (!rest.empty() && rest[0] != ':' && rest[0] != '@') return std::nullopt;  // e.g. a file
  InverseName name;
  const auto refuse = [&] [[noreturn]] {
    throw HidError(
        fmt::format("\"{}\" is not the name of a device; allowed: inverse3[:ID][@HOST[:PORT]], "
                    "with a port from 1 to 65535",
                    words));
  };
  const auto place = rest.find('@');
  if (rest.starts_with(":")) {
    name.id = rest.substr(1, place == std::string::npos ? place : place - 1);
    if (name.id.empty()) refuse();
  }
  if (place == std::string::npos) return name;
  const std::string address = rest.substr(place + 1);
  const auto colon = address.rfind(':');
  name.address.host = address.substr(0, colon);
  if (colon != std::string::npos) name.address.port = address.substr(colon + 1);
  if (name.address.host.empty() || !is_port(name.address.port)) refuse();
  return name;
}

std::vector<FoundDevice> list_inverse_devices(const std::optional<InverseName>& wanted,
                                              const ServiceAddress& usual) {
  std::vector<ServiceAddress> places{usual};
  if (wanted && wanted->address != usual) places.push_back(wanted->address);
  std::vector<FoundDevice> found;
  for (const ServiceAddress& place : places) {
    const bool here = wanted && wanted->address == place;
    std::string missing = here && wanted->id.empty() ? "the service reports no Inverse3"
                                                     : "the service does not have this device";
    std::vector<std::string> ids;
    try {
      ids = ids_at(place);
    } catch (const HidError& error) {
      missing = fmt::format("no Haply Inverse Service at {}", error.what());
    }
    for (const std::string& id : ids) found.push_back(entry({id, place}, ids.size() == 1, {}));
    const bool there =
        here && (wanted->id.empty() ? !ids.empty() : std::ranges::count(ids, wanted->id) > 0);
    if (here && !there) found.push_back(entry(*wanted, false, missing));
  }
  return found;
}

fs::path socket_folder() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  return runtime != nullptr && *runtime != '\0' ? fs::path(runtime) / "limpid" : fs::path();
}

std::vector<FoundDevice> list_socket_devices(const fs::path& folder) {
  std::vector<FoundDevice> found;
  std::error_code error;  // no such folder: no devices
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path& path = entry->path();
    if (path.extension() != ".device" || !somebody_listens(path)) continue;
    const std::string name = path.stem().string();
    found.push_back({{name, "socket:" + name, path.string()},
                     &kSocketKind,
                     {},
                     open_socket_device,
                     socket_claim_key});
  }
  std::ranges::sort(found, {}, [](const FoundDevice& one) { return one.place.path; });
  return found;
}

void refuse_doubles(std::vector<FoundDevice>& all) {
  for (FoundDevice& each : all) {
    const auto same =
        std::ranges::count(all, each.place.id, [](const FoundDevice& one) { return one.place.id; });
    if (same < 2 || each.kind->leads_hand || !each.missing.empty()) continue;
    each.missing =
        fmt::format("{} devices have the id {}: unplug all but one", same, each.place.id);
  }
}

std::vector<FoundDevice> list_devices(const DeviceSearch& search) {
  std::vector<FoundDevice> all;
  for (const ListDevices list : kWaysIn) {
    auto found = list(search);
    all.insert(all.end(), std::make_move_iterator(found.begin()),
               std::make_move_iterator(found.end()));
  }
  refuse_doubles(all);
  for (FoundDevice& each : all) {
    if (each.missing.empty()) each.in_use_by = user_of(each);
  }
  return all;
}

std::unique_ptr<Device> open_device(const FoundDevice& found, const PidSettings& settings,
                                    const AskForPriority& ask) {
  return found.open(found, settings, ask, claim(found));
}

}  // namespace limpid
