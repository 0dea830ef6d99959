// Channels by name over the control socket: channels of plots and of sessions.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/plot/trace_channels.h"

namespace limpid {

// `x` in JSON: null if it is not finite.
nlohmann::json number(double x);

// A channel by its name. A session's vector is a list: "hand/torque" of all joints, "device/tip" as
// x, y, z. A plot's channel, "hand/torque.1", is a number.
struct LiveChannel {
  std::vector<int> parts = {};              // of TraceChannels, if made of these
  std::optional<Column> column = {};        // else a column of the row
  std::optional<std::size_t> derived = {};  // else an index of kDerivedInfo
  bool vector = false;

  // Finds a channel of plots or sessions; none if there is no such name.
  static std::optional<LiveChannel> find(const TraceChannels& channels, const std::string& name);

  // The unit; a list if a vector has several.
  nlohmann::json unit(const TraceChannels& channels) const;
  // The channel's value in `row`; null for what is not finite. `values`: of all of `channels`.
  nlohmann::json value(const TraceChannels& channels, std::span<const double> row,
                       std::span<const double> values) const;
};

}  // namespace limpid
