// Lanes: runs side by side on one hand, each with settings of its own.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>

namespace limpid {

// Number of runs that one hand can lead at once.
inline constexpr std::size_t kMostLanes = 3;
inline constexpr std::size_t kMainLane = 0, kTwinLane = 1;

// Returns a lane's name in files, channels and messages: "" (the first), "twin", "lane3".
inline std::string lane_name(std::size_t lane) {
  if (lane == kMainLane) return "";
  return lane == kTwinLane ? "twin" : "lane" + std::to_string(lane + 1);
}

// Returns a lane's number as a word: "first", "second", "third".
inline const char* lane_ordinal(std::size_t lane) {
  constexpr std::array kOrdinals{"first", "second", "third"};
  static_assert(kOrdinals.size() == kMostLanes);
  return kOrdinals.at(lane);
}

// Rows of the same ticks, one piece for each lane; all of the same length.
using LaneRows = std::span<const std::span<const double>>;

}  // namespace limpid
