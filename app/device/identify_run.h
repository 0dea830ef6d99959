// The identification of a device on a thread of its own, which a watcher follows and may cancel.
#pragma once

#include <atomic>
#include <chrono>
#include <vector>

#include "core/realtime/realtime.h"
#include "devices/identify/excitation.h"
#include "devices/identify/motion_record.h"

namespace limpid {

// Exchange between watcher and motion; for any thread.
struct IdentifyProgress {
  std::atomic<double> time{0}, duration{1};  // [s]
  std::atomic<ExcitationStage> stage{ExcitationStage::approach};
  std::atomic<int> joint{0};
  std::atomic<bool> cancel{false};
  std::atomic<std::chrono::steady_clock::time_point> seen{std::chrono::steady_clock::now()};

  void see() { seen = std::chrono::steady_clock::now(); }
};

// Punctuality of the device's reports.
struct ReadingTimes {
  double rate = 0;                    // [Hz]
  std::vector<double> intervals;      // between successive readings [s]
  double p50 = 0, p99 = 0, most = 0;  // of `intervals` [s]
};

struct IdentifyRun {
  ExcitationEnd end = ExcitationEnd::cancelled;
  ForceState objection = ForceState::on;  // the limit, or the device's fault, that ended it
  int joint = 0;                          // that was held and did not follow
  MotionRecord record;                    // up to the end
  Eigen::VectorXd warmth;                 // by which cold motors were warmed up [-]
  ReadingTimes timing;
};

// Narrows the plan to a person's limits for the device.
ExcitationPlan within(ExcitationPlan plan, const SafetyLimits& limits);

// Drives the device, which nobody else may use meanwhile, until the motion is done, cancelled or
// ended, or its watcher is silent; leaves it without torque. Not for the window's thread. `ask`:
// see become_realtime().
IdentifyRun run_identification(Device& device, const ArmDescription& arm,
                               const ExcitationPlan& plan, IdentifyProgress& progress,
                               const AskForPriority& ask);
// Runs a simulated device likewise, as fast as possible.
IdentifyRun simulate_identification(Device& device, const ArmDescription& arm,
                                    const ExcitationPlan& plan, IdentifyProgress& progress);

}  // namespace limpid
