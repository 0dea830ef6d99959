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

// Row of a lane, and the values of all channels in it, as recordings have them: places of contacts
// that touch nothing are not numbers.
struct LiveRow {
  std::vector<double> row, values;

  LiveRow(const TraceChannels& channels, std::span<const double> of_lane, std::size_t lane);
};

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
  // The channel's value in `row`; null for what is not finite.
  nlohmann::json value(const TraceChannels& channels, const LiveRow& row) const;
};

}  // namespace limpid
