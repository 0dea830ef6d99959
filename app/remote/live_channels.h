// Channels by name over the control socket: those of plots, and those that sessions have.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/plot/trace_channels.h"

namespace limpid {

// A number as the socket has it: null for what is none.
nlohmann::json number(double x);

// A channel that a client asks for by its name. A session's vector comes as a list: "hand/torque"
// of all joints, "device/tip" as x, y, z. A plot's channel, "hand/torque.1", comes as a number.
struct LiveChannel {
  std::vector<int> parts = {};              // of TraceChannels, if it is made of these
  std::optional<Column> column = {};        // else one of the row as it is
  std::optional<std::size_t> derived = {};  // else a place in kDerivedInfo
  bool vector = false;

  // None for a name that neither plots nor sessions have.
  static std::optional<LiveChannel> find(const TraceChannels& channels, const std::string& name);

  // The unit, or a list where a vector's numbers have several.
  nlohmann::json unit(const TraceChannels& channels) const;
  // `values`: of all of `channels` in this row. Null in place of what is no number.
  nlohmann::json value(const TraceChannels& channels, std::span<const double> row,
                       std::span<const double> values) const;
};

}  // namespace limpid
