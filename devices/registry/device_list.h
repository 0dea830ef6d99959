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
  // How it is opened; see open_device().
  std::unique_ptr<Device> (*open)(const FoundDevice& found, const PidSettings& settings,
                                  const AskForPriority& ask) = nullptr;
};

// What is looked for, and where.
struct DeviceSearch {
  std::filesystem::path udev_rule = {};  // assets/udev/70-limpid.rules, for messages on permissions
  std::string wanted = {};               // id of the device in use, if it says where to look for it
  bool services = true;                  // also asks programs; not for every second
};

// All that there are now.
std::vector<FoundDevice> list_devices(const DeviceSearch& search);

// Connects to it. Throws HidError. `settings` matter to uncalibrated devices only.
std::unique_ptr<Device> open_device(const FoundDevice& found, const PidSettings& settings = {},
                                    const AskForPriority& ask = {});

}  // namespace limpid
