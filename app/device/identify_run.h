// The identification of a device as it goes on: a thread of its own moves the device, somebody
// watches how far it has come and may end it.
#pragma once

#include <atomic>
#include <chrono>
#include <vector>

#include "core/realtime/realtime.h"
#include "devices/identify/excitation.h"
#include "devices/identify/motion_record.h"

namespace limpid {

// What watcher and motion tell one another; any thread's.
struct IdentifyProgress {
  std::atomic<double> time{0}, duration{1};  // [s]
  std::atomic<ExcitationStage> stage{ExcitationStage::approach};
  std::atomic<int> joint{0};
  std::atomic<bool> cancel{false};
  std::atomic<std::chrono::steady_clock::time_point> seen{std::chrono::steady_clock::now()};

  void see() { seen = std::chrono::steady_clock::now(); }
};

// How punctually a device reports, as its readings arrive.
struct ReadingTimes {
  double rate = 0;                    // [Hz]
  std::vector<double> intervals;      // between neighbouring readings [s]
  double p50 = 0, p99 = 0, most = 0;  // of them [s]
};

struct IdentifyRun {
  ExcitationEnd end = ExcitationEnd::cancelled;
  ForceState objection = ForceState::on;  // where a limit or the device ended it
  int joint = 0;                          // that did not follow, where something held it
  MotionRecord record;                    // as far as it came
  ReadingTimes timing;
};

// The plan within limits that somebody set for the device.
ExcitationPlan within(ExcitationPlan plan, const SafetyLimits& limits);

// Drives the device, which nobody else uses meanwhile, until the motion is done, cancelled or
// ended, or its watcher has been silent; it is without torque then. Not for the window's thread.
// `ask`: see become_realtime().
IdentifyRun run_identification(Device& device, const ArmDescription& arm,
                               const ExcitationPlan& plan, IdentifyProgress& progress,
                               const AskForPriority& ask);
// The same with a simulated device, as fast as it goes.
IdentifyRun simulate_identification(Device& device, const ArmDescription& arm,
                                    const ExcitationPlan& plan, IdentifyProgress& progress);

}  // namespace limpid
