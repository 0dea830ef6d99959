// List of the haptic devices that can be found by any way, and what keeps them from being used.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/realtime/realtime.h"
#include "devices/device.h"
#include "devices/hid/hid_device.h"
#include "devices/hid/protocols.h"
#include "devices/hid/web_socket.h"

namespace limpid {

struct FoundDevice {
  HidPlace place;
  const DeviceKind* kind = nullptr;
  std::string missing;  // why it cannot be opened and what to do; empty if it can
  // Opens the device once it is claimed; see open_device().
  std::unique_ptr<Device> (*open)(const FoundDevice& found, const PidSettings& settings,
                                  const AskForPriority& ask, DeviceClaim claim) = nullptr;
  // Names the physical device for its claim, the same by whatever way it was found.
  std::string (*claim_key)(const FoundDevice& found) = nullptr;
  std::string in_use_by = {};  // another program, for people; empty if none (device_claim.h)
  std::string version = {};    // of place.library, if it says that without a device
};

// Places and kinds of devices to look for.
struct DeviceSearch {
  std::filesystem::path udev_rule = {};  // assets/udev/70-limpid.rules, for messages on permissions
  std::string wanted = {};               // id of the device in use, if it says where to look for it
  bool services = true;                  // also asks programs; not every second
};

// Marks devices that push and share an id as unusable: neither they nor what is remembered of them
// can be told apart.
void refuse_doubles(std::vector<FoundDevice>& all);

// Lists all devices that there are now.
std::vector<FoundDevice> list_devices(const DeviceSearch& search);

// Claims a device and connects to it: the only way to a device. Throws HidError; if another program
// has the device, nothing is opened and nothing sent. `settings` matter only to uncalibrated
// devices.
std::unique_ptr<Device> open_device(const FoundDevice& found, const PidSettings& settings = {},
                                    const AskForPriority& ask = {});

// Folders to look in; tests have others than the system's.
struct HidRoots {
  std::filesystem::path sysfs = "/sys/class/hidraw";
  std::filesystem::path dev = "/dev";
};

// Lists the HID devices that are plugged in now, sorted by path. It reads the kernel's own files,
// which everybody may read: a device is listed with its kind even without permission to open it.
// Devices that cannot be read or understood are left out. `udev_rule` as in DeviceSearch.
std::vector<FoundDevice> list_hid_devices(const std::filesystem::path& udev_rule,
                                          const HidRoots& roots = {});

// Opens the transport of a path. Throws HidError.
using OpenTransport = std::function<std::unique_ptr<HidTransport>(const std::string& path)>;

// Opens a found device through the transport that `open` gives for its path; FoundDevice::open uses
// the kernel's. Throws HidError if a device of another kind is there by now.
std::unique_ptr<Device> open_hid_device_on(const FoundDevice& found, const OpenTransport& open,
                                           const PidSettings& settings, const AskForPriority& ask,
                                           DeviceClaim claim);

// Name of an Inverse3 of a Haply Inverse Service (inverse_protocol.h), as its id and options give
// it: inverse3[:ID][@HOST[:PORT]].
struct InverseName {
  std::string id;  // as the service has it; empty: the first one
  ServiceAddress address;

  std::string text() const;
};

// Returns nothing if `words` name no Inverse3. Throws HidError if they do, but not in this form.
std::optional<InverseName> inverse_name(const std::string& words);

// Lists the Inverse3s of the service on this computer, at its usual address, and of the service at
// `wanted`. If `wanted` is not found, it is listed with the reason. Connects to services, which
// take that as a session: not for every second.
std::vector<FoundDevice> list_inverse_devices(const std::optional<InverseName>& wanted,
                                              const ServiceAddress& usual = {});

// Folder of devices that are programs, $XDG_RUNTIME_DIR/limpid; empty if that is not set: there are
// no such devices then. Only this user may write to it. Each program listens on a socket of its own
// there, NAME.device, named so once it listens; transports.h says what it has to do.
std::filesystem::path socket_folder();

// Lists the sockets that somebody listens on, sorted by path, without connecting to them.
std::vector<FoundDevice> list_socket_devices(const std::filesystem::path& folder);

}  // namespace limpid
