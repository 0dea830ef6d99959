// Reports on meshes with faults, and meshes that are refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/touch/triangle_mesh.h"
#include "tests/support/meshes.h"

namespace limpid {
namespace {

using test::Triangles;

TEST(Health, OfClosedBodiesIsSpotless) {
  for (const Triangles& body : {test::icosphere(2), test::torus(12, 7, 1, 0.3),
                                test::box(Vec3(1, 2, 3)), test::box(Vec3(0.1, 0.1, 0.01), 9)}) {
    const auto mesh = body.mesh();
    EXPECT_TRUE(mesh->health().closed());
    EXPECT_EQ(mesh->health().text(), "");
    EXPECT_EQ(mesh->triangles(), body.count());
    EXPECT_GT(mesh->bytes(), body.count() * 36);
    EXPECT_GE(mesh->build_seconds(), 0);
  }
}

TEST(Health, CountsOpenEdgesOddOnesAndWhatHasNoArea) {
  EXPECT_EQ(test::sheet(4, 1).mesh()->health().open_edges, 16u);

  Triangles missing = test::icosphere(1);
  missing.indices.resize(missing.indices.size() - 3);
  EXPECT_EQ(missing.mesh()->health().open_edges, 3u);
  EXPECT_EQ(missing.mesh()->health().text(),
            "3 open edges: the mesh is touched like a thin sheet, on both sides");

  Triangles turned = test::icosphere(1);
  std::swap(turned.indices[0], turned.indices[1]);
  EXPECT_EQ(turned.mesh()->health().odd_edges, 3u);
  EXPECT_FALSE(turned.mesh()->health().closed());

  Triangles fin = test::icosphere(0);  // a third triangle on an edge
  fin.vertices.emplace_back(5.0f, 5.0f, 5.0f);
  fin.add(0, 11, 12);
  EXPECT_EQ(fin.mesh()->health().odd_edges, 1u);
  EXPECT_EQ(fin.mesh()->health().open_edges, 2u);

  Triangles poor = test::icosphere(0);
  poor.add(3, 3, 4);
  poor.vertices.push_back((poor.vertices[0] + poor.vertices[1]) / 2);
  poor.add(0, 12, 1);
  const auto mesh = poor.mesh();
  EXPECT_EQ(mesh->health().degenerate, 2u);
  EXPECT_TRUE(mesh->health().closed());
  EXPECT_EQ(mesh->health().text(), "2 triangles with zero area ignored");
  EXPECT_EQ(mesh->triangles(), 20u);
}

// A ring of round section, computed all the way round: the vertices of its two seams are there
// twice. It stays open by `apart` along its length [rad].
Triangles ring_with_seams(int along, int round, double scale, double apart = 0) {
  const double pi = std::numbers::pi;
  return test::grid(along, round).mapped([&](const Vec3& p) {
    const double a = (2 * pi - apart) * p.x(), b = 2 * pi * p.y();
    const double far = 1 + 0.3 * std::cos(b);
    return Vec3(scale * Vec3(far * std::cos(a), far * std::sin(a), 0.3 * std::sin(b)));
  });
}

TEST(Health, OfASeamThatIsOffByRoundingIsSpotless) {
  for (const double scale : {1.0, 0.02, 300.0}) {
    const Triangles ring = ring_with_seams(24, 16, scale);
    const auto seam = [&](int i) { return ring.vertices[static_cast<std::size_t>(24 * 17 + i)]; };
    int differ = 0;
    for (int i = 0; i < 16; ++i) differ += ring.vertices[static_cast<std::size_t>(i)] != seam(i);
    ASSERT_GT(differ, 8) << "sin 2 pi is no zero";
    const auto mesh = ring.mesh();
    EXPECT_EQ(mesh->health().text(), "") << scale;
    EXPECT_TRUE(mesh->health().closed());
    EXPECT_EQ(mesh->triangles(), ring.count());
    EXPECT_LE(mesh->radius(), 1.3 * scale * (1 + 1e-6));
  }
}

TEST(Health, OfATrueGapSaysSo) {
  const double diagonal = std::hypot(2.6, 2.6, 0.6);
  for (const double gap : {1e-2, 1e-5, 1e-6}) {  // relative to the diagonal, at the inner side
    const auto mesh = ring_with_seams(24, 16, 1, gap * diagonal / 0.7).mesh();
    EXPECT_EQ(mesh->health().open_edges, 2u * 16) << gap;
    EXPECT_EQ(mesh->triangles(), 2u * 24 * 16);
  }
}

// In any order, near vertices become one, and triangles thereby without area are left out.
TEST(Health, CountsATriangleThatIsSmallerThanRounding) {
  Triangles body = test::icosphere(1);
  const std::uint32_t corner = body.indices[0],
                      first = static_cast<std::uint32_t>(body.vertices.size());
  body.vertices.emplace_back(body.vertices[corner] + Eigen::Vector3f(2e-8f, 6e-8f, 0));
  body.vertices.emplace_back(body.vertices[corner] + Eigen::Vector3f(6e-8f, 0, 6e-8f));
  body.add(corner, first, first + 1);
  const auto mesh = body.mesh();
  EXPECT_EQ(mesh->health().degenerate, 1u);
  EXPECT_TRUE(mesh->health().closed());
}

void expect_refused(const Triangles& triangles, const std::string& why) {
  try {
    triangles.mesh();
    ADD_FAILURE() << "not refused: " << why;
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(why));
  }
}

TEST(TriangleMesh, RefusesWhatIsNoMesh) {
  expect_refused({}, "no triangles");
  Triangles body = test::icosphere(0);
  body.indices.pop_back();
  expect_refused(body, "not a multiple of 3");
  body = test::icosphere(0);
  body.indices[7] = 12;
  expect_refused(body, "index 12 of 12 vertices");
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -2e9f}) {
    body = test::icosphere(0);
    body.vertices[3].y() = bad;
    expect_refused(body, "not finite or is larger than 1e9");
  }
  body = test::icosphere(0);
  for (Eigen::Vector3f& v : body.vertices) v.z() = v.x() = 0;
  expect_refused(body, "no triangle with an area");
  body.indices.assign(3 * (TriangleMesh::kMostTriangles + 1), 0);
  expect_refused(body, "6000001 triangles; at most 6000000");
}

TEST(TriangleMesh, IsNotBuiltOnceCancelled) {
  const Triangles body = test::icosphere(5);
  const std::atomic<bool> cancel{true}, go_on{false};
  EXPECT_THROW(TriangleMesh(body.vertices, body.indices, &cancel), std::runtime_error);
  EXPECT_EQ(TriangleMesh(body.vertices, body.indices, &go_on).triangles(), body.count());
}

}  // namespace
}  // namespace limpid
