#include "app/device/device_hub.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/assets.h"
#include "devices/files/file_error.h"
#include "devices/files/urdf_file.h"
#include "devices/hid/hid_error.h"

namespace limpid {

const char* name(HidKind kind) {
  switch (kind) {
    case HidKind::space_mouse: return "SpaceMouse";
    case HidKind::pid_joystick: return "PID force-feedback joystick";
    case HidKind::raw: return "raw HID haptic device";
  }
  return "";
}

ArmDescription arm_for(const DeviceTraits& traits, const ArmDescription& present) {
  ArmDescription arm = present;
  if (present.dof() != traits.dof) {
    const char* file = traits.dof == 2 ? "joystick.urdf" : traits.dof == 3 ? "omni.urdf" : nullptr;
    if (file == nullptr) {
      throw FileError(
          fmt::format("{} has {} joints; start Limpid with --device FILE.urdf, an arm of as many",
                      traits.name, traits.dof));
    }
    arm = read_urdf(data_dir() / "assets/devices" / file);
  }
  for (std::size_t i = 0; i < arm.joints.size() && i < traits.effort.size(); ++i) {
    arm.joints[i].effort = std::min(arm.joints[i].effort, traits.effort[i]);
  }
  return arm;
}

DeviceHub::DeviceHub(std::filesystem::path file, AskForPriority ask)
    : file_(std::move(file)), ask_(std::move(ask)), book_(load_device_book(file_, complaint_)) {}

void DeviceHub::look() { found_ = list_hid_devices(data_dir() / "assets/udev/70-limpid.rules"); }

const FoundDevice* DeviceHub::present() const {
  const auto same = [&](const FoundDevice& each) { return each.place.id == book_.in_use; };
  const auto device = std::ranges::find_if(found_, same);
  return device == found_.end() ? nullptr : &*device;
}

void DeviceHub::use(const std::string& id) { book_.in_use = id; }

std::unique_ptr<Device> DeviceHub::open() {
  const FoundDevice* device = present();
  if (device == nullptr) throw HidError(fmt::format("{} is not connected", book_.in_use));
  if (!device->missing.empty()) {
    throw HidError(fmt::format("{}: {}", device->place.name, device->missing));
  }
  const DeviceNotes& known = notes(book_.in_use);
  return std::make_unique<AdjustedDevice>(open_hid_device(*device, known.pid, ask_), known.axes);
}

}  // namespace limpid
