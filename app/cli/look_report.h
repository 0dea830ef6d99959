// Report on a device that was looked at, as lines and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/live/device_look.h"
#include "core/dynamics/arm_description.h"

namespace limpid {

// A device, and what it was taken for.
struct LookedDevice {
  DeviceTraits traits;
  std::string kind, arm_why;
  ArmDescription arm;
  bool checked = false;  // its axes were, and are adjusted
};

std::string look_text(const LookedDevice& device, const DeviceSeen& seen);
nlohmann::ordered_json look_json(const LookedDevice& device, const DeviceSeen& seen);

}  // namespace limpid
