// Recordings for tests, made by the loop itself.
#pragma once

#include <algorithm>
#include <vector>

#include "app/run/simulate.h"
#include "tests/support/built_in.h"
#include "tests/support/rows.h"

namespace limpid::test {

// A plan of a run: the program's arm, one of its scenes and the first seconds of one of its hands.
inline RunPlan plan(const char* scene, const char* hand_file, double seconds) {
  RunPlan plan;
  plan.arm = omni();
  plan.document = omni_document(scene);
  plan.hand = hand(hand_file);
  plan.rows = static_cast<std::uint64_t>(seconds / plan.parameters.tick);
  return plan;
}

inline Rows rows_of(const RunPlan& plan) {
  Rows rows(plan.layout());
  simulate(plan, {}, [&](std::span<const double> row, LaneChanges) {
    rows.add(row);
    return true;
  });
  return rows;
}

inline Rows rows_of(const Session& session) {
  Rows rows(session.layout);
  for (std::size_t k = 0; k < session.size(); ++k) rows.add(session.row(k));
  return rows;
}

}  // namespace limpid::test
