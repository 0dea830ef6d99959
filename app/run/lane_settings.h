// Settings in which lanes or moments of a run differ, those that all lanes share, and names of
// lanes.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/tick/parameters.h"

namespace limpid {

// Returns the settings in which these differ, in the order of the table.
std::vector<const ParameterInfo*> differing(const Parameters& one, const Parameters& other);
// Gives all settings of the first lane but its ControllerSettings to the other ones.
void share_world(std::span<Parameters> lanes);
// Refuses a setting that all lanes share, as one of a single lane. `instead`: how all of them get
// it. Errors: ParameterError. It takes no notice of a key that does not exist.
void check_of_one_lane(std::string_view key, const std::string& instead);
// Returns the law that a further lane begins with, beside those that are there already: the first
// of standard, predictive and proposed that none of them has.
CouplingKind law_beside(std::span<const Parameters> lanes);
// Names lanes by what they differ in: their laws, or else a setting.
std::vector<std::string> lane_names(std::span<const Parameters> lanes);

}  // namespace limpid
