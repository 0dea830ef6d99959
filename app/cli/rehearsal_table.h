// What identification is worth on a simulated device, as a table.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "devices/identify/unlike_device.h"

namespace limpid {

// Runs each law that takes eta as the file has the device, with the gains that suit that,
// and as it was found, with the gains, the delay and the compensation that follow from it. Prints
// what came of it; the same as JSON.
nlohmann::ordered_json rehearse_and_print(const ArmDescription& truth, const Unlikeness& bench,
                                          const ArmDescription& guess, const ArmDescription& found);

}  // namespace limpid
