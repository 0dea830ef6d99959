// What a scene may hold: for its file, and for whoever edits it.
#pragma once

#include <cstddef>

#include "devices/files/toml_reader.h"

namespace limpid::scene_limits {

inline constexpr std::size_t kMostContacts = 64;
inline constexpr std::size_t kMostProbes = 64;                        // with the tip
inline constexpr std::size_t kLargestModel = std::size_t{512} << 20;  // [bytes]

inline constexpr Range kPosition{-10, 10, false, "m"};
inline constexpr Range kAngle{-100, 100, false, "rad"};
inline constexpr Range kLength{0, 10, true, "m"};
inline constexpr Range kRadius{0, 1, false, "m"};
inline constexpr Range kStiffness{0, 1e6, true, "N/m"};
inline constexpr Range kDamping{0, 1000, false, "N s/m"};
inline constexpr Range kFriction{0, 1, false, ""};
inline constexpr Range kJointStiffness{0, 1e6, true, "N m/rad"};
inline constexpr Range kScale{0, 1e4, true, ""};
inline constexpr Range kDirection{-1e6, 1e6, false, ""};

}  // namespace limpid::scene_limits
