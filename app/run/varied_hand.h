// Variations of a hand's path, as one person would make them from time to time.
#pragma once

#include <cstdint>

#include "devices/files/session/hand_file.h"

namespace limpid {

// Returns the path as the same person would follow it another time: a little larger or smaller,
// faster or slower, hurrying here and dawdling there, with a tremor of 8 to 12 Hz. The same seeds
// give the same path.
HandPath varied(const HandPath& path, std::uint64_t seed, std::uint64_t variation);

}  // namespace limpid
