#include "render/model/simplify.h"

#include <meshoptimizer.h>

#include <span>

namespace limpid {
namespace {

// Largest error as a part of the model's size, for small parts that count few triangles.
constexpr float kMostError = 0.01f;

// Returns about `wanted` of these indices, or more. Edges are collapsed, which keeps seams and
// sharp edges; where that does not help, as in a model of single triangles, vertices are merged by
// a grid.
std::vector<std::uint32_t> simplified(const std::vector<Vertex>& vertices,
                                      std::span<const std::uint32_t> indices, std::size_t wanted) {
  std::vector<std::uint32_t> out(indices.size());
  const float* const positions = vertices.front().position.data();
  std::size_t count =
      meshopt_simplify(out.data(), indices.data(), indices.size(), positions, vertices.size(),
                       sizeof(Vertex), wanted, kMostError, 0, nullptr);
  if (count > 2 * wanted) {
    count = meshopt_simplifySloppy(out.data(), indices.data(), indices.size(), positions,
                                   vertices.size(), sizeof(Vertex), wanted, kMostError, nullptr);
  }
  out.resize(count);
  return out;
}

}  // namespace

void add_coarse(Model& model, std::size_t triangles) {
  model.coarse.clear();
  model.coarse_parts.clear();
  const std::size_t all = model.indices.size() / 3;
  if (all < 2 * triangles || !(model.bounds().sizes().maxCoeff() > 0)) return;
  for (const Part& part : model.parts) {
    const auto first = static_cast<std::uint32_t>(model.coarse.size());
    const std::size_t share = 3 * (part.count / 3 * triangles / all);
    const auto coarse =
        simplified(model.vertices, std::span(model.indices).subspan(part.first, part.count), share);
    model.coarse.insert(model.coarse.end(), coarse.begin(), coarse.end());
    model.coarse_parts.push_back({first, static_cast<std::uint32_t>(coarse.size()), part.material});
  }
}

}  // namespace limpid
