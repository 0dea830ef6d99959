#include "render/model/simplify.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace limpid {
namespace {

// Clusters of vertices: all in one cell of a grid that face the same eighth of all directions, so
// that the two sides of a sheet and the faces at a sharp edge stay apart.
class Clusters {
 public:
  Clusters(const std::vector<Vertex>& vertices, const Eigen::AlignedBox3d& box, double cells)
      : vertices_(vertices), corner_(box.min()), per_meter_(cells / box.sizes().maxCoeff()) {
    of_.reserve(vertices.size());
    for (const Vertex& v : vertices) {
      const auto next = static_cast<std::uint32_t>(numbers_.size());
      of_.push_back(numbers_.try_emplace(key(v), next).first->second);
    }
  }

  std::size_t count() const { return numbers_.size(); }

  // For each vertex the one that stands for its cluster: the nearest to the middle.
  std::vector<std::uint32_t> representatives() const {
    std::vector<Vec3> sum(count(), Vec3::Zero());
    std::vector<double> size(count()), nearest(count(), 1e300);
    std::vector<std::uint32_t> chosen(count()), out(of_.size());
    for (std::size_t i = 0; i < of_.size(); ++i) {
      sum[of_[i]] += vertices_[i].position.cast<double>();
      ++size[of_[i]];
    }
    for (std::size_t i = 0; i < of_.size(); ++i) {
      const std::uint32_t k = of_[i];
      const double off = (vertices_[i].position.cast<double>() - sum[k] / size[k]).squaredNorm();
      if (off < nearest[k]) nearest[k] = off, chosen[k] = static_cast<std::uint32_t>(i);
    }
    for (std::size_t i = 0; i < of_.size(); ++i) out[i] = chosen[of_[i]];
    return out;
  }

 private:
  std::uint64_t key(const Vertex& v) const {
    std::uint64_t key = 0;
    for (int i = 0; i < 3; ++i) {
      const double cell = (static_cast<double>(v.position[i]) - corner_[i]) * per_meter_;
      key = (key << 18) | static_cast<std::uint64_t>(std::clamp(cell, 0.0, 262143.0));
    }
    for (int i = 0; i < 3; ++i) key = (key << 1) | (v.normal[i] < 0 ? 1u : 0u);
    return key;
  }

  const std::vector<Vertex>& vertices_;
  Vec3 corner_;
  double per_meter_;
  std::unordered_map<std::uint64_t, std::uint32_t> numbers_;
  std::vector<std::uint32_t> of_;
};

}  // namespace

void add_coarse(Model& model, std::size_t triangles) {
  model.coarse.clear();
  model.coarse_parts.clear();
  const Eigen::AlignedBox3d box = model.bounds();
  if (model.indices.size() / 3 < 2 * triangles || !(box.sizes().maxCoeff() > 0)) return;
  // A surface meets a grid in about as many cells as the square of its resolution, and has two
  // triangles a vertex.
  constexpr double kProbe = 64;
  const auto wanted = static_cast<double>(triangles / 2);
  const auto met = static_cast<double>(Clusters(model.vertices, box, kProbe).count());
  const double cells = std::clamp(kProbe * std::sqrt(wanted / met), 8.0, 4096.0);
  const auto stand_in = Clusters(model.vertices, box, cells).representatives();
  for (const Part& part : model.parts) {
    const auto first = static_cast<std::uint32_t>(model.coarse.size());
    for (std::uint32_t i = part.first; i < part.first + part.count; i += 3) {
      const std::uint32_t a = stand_in[model.indices[i]], b = stand_in[model.indices[i + 1]],
                          c = stand_in[model.indices[i + 2]];
      if (a != b && b != c && c != a) model.coarse.insert(model.coarse.end(), {a, b, c});
    }
    const auto count = static_cast<std::uint32_t>(model.coarse.size()) - first;
    model.coarse_parts.push_back({first, count, part.material});
  }
}

}  // namespace limpid
