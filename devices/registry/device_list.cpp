#include "devices/registry/device_list.h"

#include <iterator>

#include "devices/registry/hid_devices.h"
#include "devices/registry/socket_devices.h"

namespace limpid {
namespace {

// Each way by which devices come in, in the order of the list.
using ListDevices = std::vector<FoundDevice> (*)(const std::filesystem::path& udev_rule);
constexpr ListDevices kWaysIn[] = {
    [](const std::filesystem::path& udev_rule) { return list_hid_devices(udev_rule); },
    [](const std::filesystem::path&) { return list_socket_devices(socket_folder()); },
};

}  // namespace

std::vector<FoundDevice> list_devices(const std::filesystem::path& udev_rule) {
  std::vector<FoundDevice> all;
  for (const ListDevices list : kWaysIn) {
    auto found = list(udev_rule);
    all.insert(all.end(), std::make_move_iterator(found.begin()),
               std::make_move_iterator(found.end()));
  }
  return all;
}

std::unique_ptr<Device> open_device(const FoundDevice& found, const PidSettings& settings,
                                    const AskForPriority& ask) {
  return found.open(found, settings, ask);
}

}  // namespace limpid
