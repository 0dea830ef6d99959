// The coarse version of a large model; the library chooses its triangles.
#include "render/model/simplify.h"

#include <gtest/gtest.h>

namespace limpid {
namespace {

using Eigen::Vector3f;

// A square of side 1 made of 2 side^2 triangles, with vertices of their own if `apart`.
void add_square(Model& model, const Vector3f& corner, const Vector3f& u, const Vector3f& v,
                std::uint32_t side, bool apart = false) {
  const auto at = [&](std::uint32_t x, std::uint32_t y) {
    const float step = 1 / static_cast<float>(side);
    return Vertex{corner + step * (static_cast<float>(x) * u + static_cast<float>(y) * v),
                  u.cross(v)};
  };
  Part part{static_cast<std::uint32_t>(model.indices.size()), 6 * side * side};
  const auto first = static_cast<std::uint32_t>(model.vertices.size());
  const auto corner_of = [&](std::uint32_t x, std::uint32_t y) {
    if (!apart) return first + y * (side + 1) + x;
    model.vertices.push_back(at(x, y));
    return static_cast<std::uint32_t>(model.vertices.size() - 1);
  };
  for (std::uint32_t y = 0; !apart && y <= side; ++y)
    for (std::uint32_t x = 0; x <= side; ++x) model.vertices.push_back(at(x, y));
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x)
      for (const auto& [dx, dy] : {std::pair(0u, 0u), {1, 0}, {0, 1}, {1, 0}, {1, 1}, {0, 1}})
        model.indices.push_back(corner_of(x + dx, y + dy));
  model.parts.push_back(part);
}

// Area of the triangles, negative where they face away from their first vertex' normal.
float outward_area(const Model& model, const std::vector<std::uint32_t>& indices) {
  float twice = 0;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const Vertex &a = model.vertices[indices[i]], &b = model.vertices[indices[i + 1]],
                 &c = model.vertices[indices[i + 2]];
    twice += a.normal.dot((b.position - a.position).cross(c.position - a.position));
  }
  return twice / 2;
}

const Vector3f kX = Vector3f::UnitX(), kY = Vector3f::UnitY(), kZ = Vector3f::UnitZ();

TEST(Simplify, LeavesModelsOfLessThanTwiceAsManyAlone) {
  Model model;
  add_square(model, {0, 0, 0}, kX, kY, 10);
  add_coarse(model, 101);
  EXPECT_TRUE(model.coarse.empty() && model.coarse_parts.empty());
  add_coarse(model, 100);
  EXPECT_FALSE(model.coarse.empty());
}

TEST(Simplify, KeepsSharpEdgesSharp) {
  Model model;
  for (const auto& [corner, u, v] : {std::tuple(Vector3f(0, 0, 1), kX, kY),
                                     {Vector3f(0, 0, 0), kY, kX},
                                     {Vector3f(1, 0, 0), kY, kZ},
                                     {Vector3f(0, 0, 0), kZ, kY},
                                     {Vector3f(0, 1, 0), kZ, kX},
                                     {Vector3f(0, 0, 0), kX, kZ}})
    add_square(model, corner, u, v, 40);
  model.parts = {{0, static_cast<std::uint32_t>(model.indices.size())}};
  add_coarse(model, 2000);
  EXPECT_GT(model.coarse.size() / 3, 12u);
  EXPECT_LT(model.coarse.size() / 3, 4000u);
  EXPECT_NEAR(outward_area(model, model.coarse), 6, 0.01);
  for (std::size_t i = 0; i < model.coarse.size(); i += 3) {
    const auto normal = [&](std::size_t k) { return model.vertices[model.coarse[i + k]].normal; };
    EXPECT_EQ(normal(0), normal(1));
    EXPECT_EQ(normal(0), normal(2));
  }
}

TEST(Simplify, MergesSingleTrianglesToo) {
  Model model;
  add_square(model, {0, 0, 0}, kX, kY, 150, true);
  add_coarse(model, 20'000);
  EXPECT_GT(model.coarse.size() / 3, 10'000u);
  EXPECT_LT(model.coarse.size() / 3, 40'000u);
  EXPECT_NEAR(outward_area(model, model.coarse), 1, 0.05);
}

TEST(Simplify, KeepsAPartOfFewTrianglesAndEachPartsMaterial) {
  Model model;
  add_square(model, {0, 0, 0}, kX, kY, 100);
  add_square(model, {0, 0, 0.5}, kX, kY, 1);
  model.parts[1].material.color = 7;
  add_coarse(model, 1000);
  ASSERT_EQ(model.coarse_parts.size(), 2u);
  EXPECT_EQ(model.coarse_parts[0].first, 0u);
  EXPECT_LT(model.coarse_parts[0].count / 3, 2000u);
  EXPECT_EQ(model.coarse_parts[1].first, model.coarse_parts[0].count);
  EXPECT_EQ(model.coarse_parts[1].count / 3, 2u);
  EXPECT_EQ(model.coarse_parts[1].material.color, 7);
  EXPECT_EQ(model.coarse.size(), model.coarse_parts[0].count + 6u);
}

}  // namespace
}  // namespace limpid
