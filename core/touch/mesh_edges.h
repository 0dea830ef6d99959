// What edges of a mesh say about it: where triangles meet, and how many.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/sizes.h"

namespace limpid {

// Vertices at the same place have one name: the number of the first of them. One that is not
// finite is alone.
std::vector<std::uint32_t> names_of(const std::vector<Eigen::Vector3f>& places);

struct EdgeCount {
  std::size_t open = 0;  // of one triangle only
  std::size_t odd = 0;   // of more than two triangles, or of two that disagree
};
// `corners`: three names a triangle, each less than `names`.
EdgeCount count_edges(std::span<const std::uint32_t> corners, std::size_t names);

}  // namespace limpid
