// Common parts of all readers of models: limits, normals, parts.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "render/model/model.h"

namespace limpid {

inline constexpr std::size_t kMostVertices = 8'000'000;
inline constexpr std::size_t kMostTriangles = 6'000'000;
inline constexpr std::size_t kMostNodes = 1'000'000;
inline constexpr int kDeepestNode = 256;
inline constexpr float kFarthest = 1e6f;  // from the origin, of the model's units

inline constexpr const char* kNoTriangles =
    "contains no triangles; points and lines cannot be touched";

// Indices, sorted by the look of their triangles.
using IndicesByFinish = std::map<Finish, std::vector<std::uint32_t>>;

// Adds the lists to the model as parts; empties each once it is there.
void join_parts(Model& model, IndicesByFinish& lists);

// Gives vertices without a normal (zero) the mean direction of their triangles, weighted by size.
void fill_normals(std::span<Vertex> vertices, std::span<const std::uint32_t> corners);

// Converts colours for the eye (sRGB) to linear light, as in Vertex.
Eigen::Vector3f linear(const Eigen::Vector3f& srgb);

// Adds a line unless it is there already or there are many.
void add_warning(Model& model, const std::string& what);

}  // namespace limpid
