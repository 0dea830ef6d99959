// Names and sizes that writer and reader of session files agree on.
#pragma once

#include <cstdint>

#include "core/tick/row.h"

namespace limpid {

inline constexpr const char* kSessionFormat = "limpid-session";
// In version 1 joints that slide counted in units of 0.1 m, and contacts that were not there were
// at zero. Both are read.
inline constexpr int kSessionVersion = 2;
inline constexpr std::size_t kSettingLength = 120;
inline constexpr const char* kEventRowPath = "/events/row";
inline constexpr const char* kTwinGroup = "twin";  // of the second run, if there is one
inline constexpr const char* kRoundingPath = "/check/rounding";
inline constexpr const char* kJointTypes = "joint_types";  // attribute of the root
inline constexpr const char* kSlidingType = "prismatic";   // URDF's words
inline constexpr const char* kTurningType = "revolute";
inline constexpr const char* kEventSettingPath = "/events/setting";

// What a row reads as that was announced but never written, in recordings of the first edition: a
// not-a-number that no arithmetic makes.
inline constexpr std::uint64_t kNeverWritten = 0x7ff8'6c69'6d70'6964;

// The same below a group: a session's datasets stand at the root, a twin's in a group of its own.
inline const char* within_group(const char* path) { return path + 1; }

inline std::size_t column_index(Column c) { return static_cast<std::size_t>(c); }

}  // namespace limpid
