// Names of all channels that a loop has.
#pragma once

#include <optional>
#include <string>

#include "app/plot/trace_channels.h"

namespace limpid {

// Returns the channel of nearly that name, of recordings ("hand/torque") and of plots; none if
// nothing resembles it.
std::optional<std::string> meant_channel(const TraceChannels& channels, const std::string& name);

}  // namespace limpid
