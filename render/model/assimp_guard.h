// A look through a file before assimp spends memory on it.
#pragma once

#include <span>
#include <string>

#include "render/model/model.h"

namespace limpid {

// Throws std::runtime_error naming the file where a PLY or Collada file says that it has more of
// something than fits into it.
void guard_counts(std::span<const unsigned char> bytes, const std::string& kind,
                  const std::string& name);

// Unit and axis, as far as the format knows any.
void read_conventions(std::span<const unsigned char> bytes, const std::string& kind, Model& model);

}  // namespace limpid
