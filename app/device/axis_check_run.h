// The check of a device's axes as it goes on: a thread of its own drives the device, the window
// shows how far it has come and may end it.
#pragma once

#include <atomic>
#include <chrono>

#include "core/dynamics/arm_description.h"
#include "core/realtime/realtime.h"
#include "core/tick/safety_limits.h"
#include "devices/hid/axis_check.h"

namespace limpid {

// What window and check tell one another; any thread's.
struct AxisCheckProgress {
  std::atomic<int> axis{0};
  std::atomic<AxisStage> stage{AxisStage::resting};
  std::atomic<bool> cancel{false};
  std::atomic<std::chrono::steady_clock::time_point> window_seen{std::chrono::steady_clock::now()};

  void see_window() { window_seen = std::chrono::steady_clock::now(); }
};

// Drives the device, which nobody else uses meanwhile, until the check is done or cancelled, or the
// window has been silent for 0.4 s; it is without torque then. The force at the tip stays within
// its limit, and any other limit of `limits` ends the check. `arm`: that the device is taken for,
// of as many joints. Not for the window's thread. `ask`: see become_realtime().
AxisCheck run_axis_check(Device& device, const ArmDescription& arm, const SafetyLimits& limits,
                         AxisCheckProgress& progress, const AskForPriority& ask);

// What came of it, for people.
std::string report_of(const AxisCheck& check);

}  // namespace limpid
