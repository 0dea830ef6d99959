// The check of a device's axes on a thread of its own, which the window follows and may cancel.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>

#include "core/dynamics/arm_description.h"
#include "core/realtime/realtime.h"
#include "core/tick/safety_limits.h"
#include "devices/hid/axis_check.h"

namespace limpid {

// Why a check ended before it was done.
enum class CheckEnd : std::uint8_t { none, stopped, no_window, gone, open_hand, fault, stale };

// Exchange between window and check; for any thread.
struct AxisCheckProgress {
  std::atomic<int> axis{0};
  ArmDescription arm;  // that the device is taken for, once the check has begun
  std::atomic<bool> begun{false};
  std::atomic<AxisStage> stage{AxisStage::resting};
  std::atomic<bool> cancel{false};
  std::atomic<CheckEnd> end{CheckEnd::none};
  Eigen::VectorXd warmth;  // by which cold motors were warmed up; once the check has ended [-]
  std::atomic<std::chrono::steady_clock::time_point> window_seen{std::chrono::steady_clock::now()};

  void see_window() { window_seen = std::chrono::steady_clock::now(); }
};

// Drives the device, which nobody else may use meanwhile, until the check is done or cancelled, or
// the window has been silent for 0.4 s; leaves it without torque. The force at the tip stays within
// its limit; any other limit of `limits` ends the check. `arm`: the arm that the device is taken
// for, with as many joints. Not for the window's thread. `ask`: see become_realtime().
AxisCheck run_axis_check(Device& device, const ArmDescription& arm, const SafetyLimits& limits,
                         AxisCheckProgress& progress, const AskForPriority& ask);

// Result of a check, for people; with `end`, why it was interrupted.
std::string report_of(const AxisCheck& check, CheckEnd end = CheckEnd::none);

}  // namespace limpid
