#include "render/model/gltf_triangles.h"

#include <limits>

namespace limpid {
namespace {

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

}  // namespace

Triangles read_triangles(GltfAccessor& file, const tinygltf::Primitive& primitive,
                         std::size_t vertices, std::size_t most) {
  Elements e;
  std::size_t count = vertices;
  if (primitive.indices >= 0) {
    e = file.elements(primitive.indices);
    if (e.components != 1) file.refuse("indices must be single numbers");
    count = e.count;
  }
  const auto vertex = [&](std::size_t i) {
    const std::uint32_t k =
        primitive.indices >= 0 ? file.index(e, i) : static_cast<std::uint32_t>(i);
    if (k >= vertices)
      file.refuse("index " + std::to_string(k) + " is outside of the mesh's " +
                  std::to_string(vertices) + " vertices");
    return k;
  };
  const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES;
  const bool fan = primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
  if (!list && !fan && primitive.mode != TINYGLTF_MODE_TRIANGLE_STRIP)
    file.refuse("a mesh is drawn in the unknown mode " + std::to_string(primitive.mode));
  if (list && count % 3 != 0) file.refuse("indices do not make whole triangles");
  const std::size_t made = list ? count / 3 : count < 3 ? 0 : count - 2;
  if (made > most) file.refuse("has more than 6 million triangles over all nodes");
  Triangles out{{}, made};
  out.corners.reserve(3 * made);
  for (std::size_t i = 0; i < made; ++i) {
    // In a strip every second triangle is turned over.
    const std::size_t odd = i % 2;
    const std::uint32_t a = vertex(list ? 3 * i : fan ? 0 : i);
    const std::uint32_t b = vertex(list ? 3 * i + 1 : fan ? i + 1 : i + 1 + odd);
    const std::uint32_t c = vertex(list ? 3 * i + 2 : fan ? i + 2 : i + 2 - odd);
    if (a != b && b != c && c != a) out.corners.insert(out.corners.end(), {a, b, c});
  }
  return out;
}

const std::vector<std::uint32_t>& VertexUse::renumber(std::vector<std::uint32_t>& corners,
                                                      std::size_t count) {
  if (place_.size() < count) place_.resize(count, kUnused);
  used_.clear();
  for (std::uint32_t& corner : corners) {
    std::uint32_t& place = place_[corner];
    if (place == kUnused) {
      place = static_cast<std::uint32_t>(used_.size());
      used_.push_back(corner);
    }
    corner = place;
  }
  for (const std::uint32_t vertex : used_) place_[vertex] = kUnused;
  return used_;
}

}  // namespace limpid
