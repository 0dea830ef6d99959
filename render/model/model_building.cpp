#include "render/model/model_building.h"

#include <algorithm>
#include <cmath>

namespace limpid {

void join_parts(Model& model, IndicesByFinish& lists) {
  for (auto& [finish, list] : lists) {
    if (list.empty()) continue;
    model.parts.push_back({static_cast<std::uint32_t>(model.indices.size()),
                           static_cast<std::uint32_t>(list.size()), finish});
    if (lists.size() == 1) {
      model.indices = std::move(list);
    } else {
      model.indices.insert(model.indices.end(), list.begin(), list.end());
    }
    list = {};
  }
}

void fill_normals(std::span<Vertex> vertices, std::span<const std::uint32_t> corners) {
  const auto missing = [](const Vertex& v) { return v.normal.squaredNorm() < 0.5f; };
  if (std::none_of(vertices.begin(), vertices.end(), missing)) return;
  std::vector<Eigen::Vector3f> sum(vertices.size(), Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    const auto at = [&](std::size_t k) {
      return Vec3(vertices[corners[i + k]].position.cast<double>());
    };
    const Vec3 a = at(0), n = (at(1) - a).cross(at(2) - a);
    for (std::size_t k = 0; k < 3; ++k) sum[corners[i + k]] += n.cast<float>();
  }
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (!missing(vertices[i])) continue;
    const Vec3 n = sum[i].cast<double>();
    const double length = n.norm();
    vertices[i].normal = length > 0 && std::isfinite(length)
                             ? Eigen::Vector3f((n / length).cast<float>())
                             : Eigen::Vector3f::UnitZ();
  }
}

Eigen::Vector3f linear(const Eigen::Vector3f& srgb) {
  return srgb.unaryExpr([](float c) {
    const float held = std::isfinite(c) ? std::clamp(c, 0.0f, 1.0f) : 0.0f;
    return held <= 0.04045f ? held / 12.92f : std::pow((held + 0.055f) / 1.055f, 2.4f);
  });
}

void add_warning(Model& model, const std::string& what) {
  constexpr std::size_t kMost = 20;
  auto& list = model.warnings;
  if (list.size() < kMost && std::find(list.begin(), list.end(), what) == list.end())
    list.push_back(what);
}

}  // namespace limpid
