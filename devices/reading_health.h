// What a reading says of a device's health, for whoever judges whether its motors may push.
#pragma once

#include "core/tick/safety.h"
#include "devices/device.h"

namespace limpid {

// `here`: read() said that the device is there. `dt`: since the reading before [s]. `silence`:
// since its watcher last answered [s]. `lapses`: how many of the device's are known of; none: all
// are news.
inline DeviceHealth health_of(const DeviceReading& reading, bool here, bool guarded, double dt,
                              double silence, std::optional<std::uint32_t>& lapses) {
  DeviceHealth health{.guarded = guarded,
                      .hand = reading.hand,
                      .fault = reading.fault,
                      .lost = !here,
                      .age = reading.age,
                      .gap = dt > SafetyLimits::kGap || (here && lapses != reading.lapses),
                      .silence = silence};
  if (reading.count == 0) health.age = SafetyLimits::kStaleReading * 2;
  if (here) lapses = reading.lapses;
  return health;
}

}  // namespace limpid
