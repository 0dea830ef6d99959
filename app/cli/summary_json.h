// Summaries of runs and recordings as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "app/run/summary.h"

namespace limpid {

// Numbers of Summary::text(), with units in their names; "unstable_at_s" only for a run that became
// unstable.
nlohmann::ordered_json summary_json(const Summary& summary);

// The numbers of each lane, "runs", and warnings in sentences, "warnings". `at_limit`: time of each
// lane with a motor at its limit [s]; empty where that is not known.
nlohmann::ordered_json runs_json(const std::vector<const Summary*>& lanes,
                                 const std::vector<std::string>& warnings,
                                 std::span<const double> at_limit);

}  // namespace limpid
