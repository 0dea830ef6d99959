// From a glTF primitive's indices to plain triangles over the vertices it uses.
#pragma once

#include <span>
#include <vector>

#include "render/model/gltf_accessor.h"
#include "render/model/model.h"

namespace limpid {

struct Triangles {
  std::vector<std::uint32_t> corners;  // three a triangle, strips and fans taken apart
  std::size_t looked_at = 0;
};

// Triangles that name a vertex twice are left out. Throws std::runtime_error naming the file when
// there are more than `most` to look at.
Triangles read_triangles(GltfAccessor& file, const tinygltf::Primitive& primitive,
                         std::size_t vertices, std::size_t most);

// Several primitives may share one long list of vertices, of which each uses a few.
class VertexUse {
 public:
  // Which of `count` vertices are used, in order of use; `corners` become places in that list.
  const std::vector<std::uint32_t>& renumber(std::vector<std::uint32_t>& corners,
                                             std::size_t count);

 private:
  std::vector<std::uint32_t> place_, used_;
};

}  // namespace limpid
