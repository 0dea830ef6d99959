// Which haptic devices there are, whatever way leads to them, and what keeps them from being used.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/realtime/realtime.h"
#include "devices/device.h"
#include "devices/hid/hid_device.h"
#include "devices/hid/protocols/protocols.h"

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

// All that there are now.
std::vector<FoundDevice> list_devices(const DeviceSearch& search);

// Claims it and connects to it: the only way to a device. Throws HidError; where another program
// has the device, nothing is opened and nothing sent. `settings` matter to uncalibrated devices
// only.
std::unique_ptr<Device> open_device(const FoundDevice& found, const PidSettings& settings = {},
                                    const AskForPriority& ask = {});

}  // namespace limpid
