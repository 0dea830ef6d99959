// Which haptic devices there are, whatever way leads to them, and what keeps them from being used.
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
  // How it is opened, once it is claimed; see open_device().
  std::unique_ptr<Device> (*open)(const FoundDevice& found, const PidSettings& settings,
                                  const AskForPriority& ask, DeviceClaim claim) = nullptr;
  // Names the physical thing, for its claim: the same by whatever way it was found.
  std::string (*claim_key)(const FoundDevice& found) = nullptr;
  std::string in_use_by = {};  // another program, for people; empty: none (device_claim.h)
};

// What is looked for, and where.
struct DeviceSearch {
  std::filesystem::path udev_rule = {};  // assets/udev/70-limpid.rules, for messages on permissions
  std::string wanted = {};               // id of the device in use, if it says where to look for it
  bool services = true;                  // also asks programs; not for every second
};

// Of devices that push, two with one id cannot be told apart, nor what is remembered of them: says
// so of each.
void refuse_doubles(std::vector<FoundDevice>& all);

// All that there are now.
std::vector<FoundDevice> list_devices(const DeviceSearch& search);

// Claims it and connects to it: the only way to a device. Throws HidError; where another program
// has the device, nothing is opened and nothing sent. `settings` matter to uncalibrated devices
// only.
std::unique_ptr<Device> open_device(const FoundDevice& found, const PidSettings& settings = {},
                                    const AskForPriority& ask = {});

// The HID devices that are plugged in.
//
// From the kernel's own files, which everybody may read: a device is listed with its kind even
// where there is no permission to open it. Plugging in and out shows at the next call.

// Where to look; other than the system's own for tests.
struct HidRoots {
  std::filesystem::path sysfs = "/sys/class/hidraw";
  std::filesystem::path dev = "/dev";
};

// `udev_rule` as in DeviceSearch. Sorted by path. Devices that cannot be read or understood are
// left out.
std::vector<FoundDevice> list_hid_devices(const std::filesystem::path& udev_rule,
                                          const HidRoots& roots = {});

// Throws HidError.
using OpenTransport = std::function<std::unique_ptr<HidTransport>(const std::string& path)>;

// What was found, through the transport that `open` gives for its path; FoundDevice::open goes
// through the kernel's. Throws HidError if a device of another kind is there by now.
std::unique_ptr<Device> open_hid_device_on(const FoundDevice& found, const OpenTransport& open,
                                           const PidSettings& settings, const AskForPriority& ask,
                                           DeviceClaim claim);

// The Inverse3s that a Haply Inverse Service has (inverse_protocol.h).

// Which one is meant, as its id and options say it: inverse3[:ID][@HOST[:PORT]].
struct InverseName {
  std::string id;  // as the service has it; empty: the first there
  ServiceAddress address;

  std::string text() const;
};

// Nothing where the words name no Inverse3. Throws HidError where they do, but not as above.
std::optional<InverseName> inverse_name(const std::string& words);

// Those of the service on this computer, where it usually is, and of the one that `wanted` is at.
// A wanted one that is not there is among them, with what it lacks. Connects to services: not for
// every second, each takes that as a session of its own.
std::vector<FoundDevice> list_inverse_devices(const std::optional<InverseName>& wanted,
                                              const ServiceAddress& usual = {});

// Devices that are programs: each listens on a socket of its own, NAME.device in a folder that only
// this user may write to, and gives it this name once it listens. See transports.h for what
// such a program has to do.

// $XDG_RUNTIME_DIR/limpid; empty where that is not set: then there are none.
std::filesystem::path socket_folder();

// Those that somebody listens on, sorted by path; without connecting to them.
std::vector<FoundDevice> list_socket_devices(const std::filesystem::path& folder);

}  // namespace limpid
