// Runs a plan and records it, as `limpid run --record` does.
#pragma once

#include <filesystem>

#include "app/run/recorder.h"
#include "app/run/simulate.h"
#include "devices/files/session/session.h"

namespace limpid::test {

inline Session recorded(const RunPlan& plan, const std::filesystem::path& out) {
  Recorder recorder(out, session_info(plan), plan.settings(), false, Recorder::kWaitingRoom);
  simulate(plan, {}, [&](std::span<const double> rows, LaneChanges changed) {
    for (std::size_t lane = 0; lane < changed.size(); ++lane) {
      if (changed[lane] != nullptr) recorder.changed(*changed[lane], lane);
    }
    return recorder.push_waiting(rows);
  });
  recorder.finish();
  return read_session(out);
}

}  // namespace limpid::test
