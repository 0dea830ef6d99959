// The HID devices that are plugged in.
//
// From the kernel's own files, which everybody may read: a device is listed with its kind even
// where there is no permission to open it. Plugging in and out shows at the next call.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "devices/registry/device_list.h"

namespace limpid {

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

}  // namespace limpid
