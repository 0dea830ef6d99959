// Summaries of runs and recordings as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/run/summary.h"

namespace limpid {

// The numbers of Summary::text(), each with its unit in its name; "unstable_at_s" only of a run
// that became unstable.
nlohmann::ordered_json summary_json(const Summary& summary);

// With the numbers of each lane, "runs", and the sentences to warn of, "warnings".
nlohmann::ordered_json runs_json(const std::vector<const Summary*>& lanes,
                                 const std::vector<std::string>& warnings);

}  // namespace limpid
