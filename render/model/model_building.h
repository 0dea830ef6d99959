// What every reader of models needs: limits, normals, parts.
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

// Indices by how their triangles look.
using IndicesByFinish = std::map<Finish, std::vector<std::uint32_t>>;

// The lists as parts of the model, each emptied once it is there.
void join_parts(Model& model, IndicesByFinish& lists);

// Vertices of no normal (zero) take the mean direction of their triangles, by their size.
void fill_normals(std::span<Vertex> vertices, std::span<const std::uint32_t> corners);

// Colours for the eye (sRGB) as linear light, which is what a Vertex has.
Eigen::Vector3f linear(const Eigen::Vector3f& srgb);

// Adds a line unless it is there already or there are many.
void add_warning(Model& model, const std::string& what);

}  // namespace limpid
