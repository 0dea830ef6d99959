// A measured hand, as text and as JSON, for `limpid analyze --grip-of` and `limpid run`.
#pragma once

#include <nlohmann/json.hpp>

#include "app/run/measured_hand.h"

namespace limpid {

void print_measured(const MeasuredHand& hand);
nlohmann::ordered_json measured_json(const MeasuredHand& hand);
// Units of the numbers, by their keys.
nlohmann::ordered_json measured_units();

}  // namespace limpid
