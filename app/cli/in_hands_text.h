// Stability in a range of hands, as text and as JSON, for `limpid analyze --grip`.
#pragma once

#include <nlohmann/json.hpp>
#include <span>

#include "app/run/hand_range.h"

namespace limpid {

void print_in_hands(const InHands& found, std::span<const CouplingKind> told);
nlohmann::ordered_json in_hands_json(const InHands& found);
// Units of the numbers, by their keys.
nlohmann::ordered_json in_hands_units();

}  // namespace limpid
