// Which haptic devices are plugged in, and what keeps them from being used.
//
// From the kernel's own files, which everybody may read: a device is listed with its kind even
// where there is no permission to open it. Plugging in and out shows at the next call.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "devices/hid/hid_device.h"
#include "devices/hid/protocols/pid_joystick.h"

namespace limpid {

enum class HidKind : std::uint8_t { space_mouse, pid_joystick, raw };

struct FoundDevice {
  HidPlace place;
  HidKind kind = HidKind::raw;
  std::string missing;  // why it cannot be opened and what to do; empty if it can
};

// Where to look; other than the system's own for tests.
struct HidRoots {
  std::filesystem::path sysfs = "/sys/class/hidraw";
  std::filesystem::path dev = "/dev";
};

// `udev_rule`: the file assets/udev/70-limpid.rules, for the message about permissions. Sorted by
// path. Devices that cannot be read or understood are left out.
std::vector<FoundDevice> list_hid_devices(const std::filesystem::path& udev_rule,
                                          const HidRoots& roots = {});

// Connects to it. Throws HidError. `settings` matter to PID devices only.
std::unique_ptr<HidDevice> open_hid_device(const FoundDevice& found,
                                           const PidSettings& settings = {},
                                           const AskForPriority& ask = {});

}  // namespace limpid
