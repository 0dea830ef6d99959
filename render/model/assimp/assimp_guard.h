// A look through a file before assimp spends time and memory on it.
#pragma once

#include <span>
#include <string>

namespace limpid {

// Throws std::runtime_error where a PLY or Collada file says that it has more of something than
// fits into it, or a PLY is cut off in its header.
void guard_counts(std::span<const unsigned char> bytes, const std::string& kind);

}  // namespace limpid
