#include "devices/registry/device_list.h"

#include <fmt/format.h>

#include <iterator>

#include "devices/hid/hid_error.h"
#include "devices/registry/hid_devices.h"
#include "devices/registry/inverse_devices.h"
#include "devices/registry/socket_devices.h"

namespace limpid {
namespace {

std::vector<FoundDevice> of_services(const DeviceSearch& search) {
  if (!search.services) return {};
  try {
    return list_inverse_devices(inverse_name(search.wanted));
  } catch (const HidError&) {  // a name that nobody could have given it
    return list_inverse_devices({});
  }
}

// Each way by which devices come in, in the order of the list.
using ListDevices = std::vector<FoundDevice> (*)(const DeviceSearch& search);
constexpr ListDevices kWaysIn[] = {
    [](const DeviceSearch& search) { return list_hid_devices(search.udev_rule); },
    [](const DeviceSearch&) { return list_socket_devices(socket_folder()); },
    of_services,
};

// Where nobody can tell, opening it says why.
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

std::vector<FoundDevice> list_devices(const DeviceSearch& search) {
  std::vector<FoundDevice> all;
  for (const ListDevices list : kWaysIn) {
    auto found = list(search);
    all.insert(all.end(), std::make_move_iterator(found.begin()),
               std::make_move_iterator(found.end()));
  }
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
