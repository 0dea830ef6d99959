// A triangle mesh with queries at 1 kHz: the nearest place, and the first one between two points.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/math/sizes.h"

namespace limpid {

struct EdgeCount {
  std::size_t open = 0;  // of one triangle only
  std::size_t odd = 0;   // of more than two triangles, or of two that disagree
};
// Counts the edges at which triangles do not meet in pairs. `corners`: three names a triangle, each
// less than `names`.
EdgeCount count_edges(std::span<const std::uint32_t> corners, std::size_t names);

// A place on a mesh.
struct MeshPoint {
  Vec3 point = Vec3::Zero();   // [mesh units]
  Vec3 normal = Vec3::Zero();  // of its triangle, unit, to the side of counter-clockwise corners
  double distance = 0;         // from the point of the query
  std::uint32_t triangle = kNone;  // hint for the next query, without other meaning

  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
};

// Defects found in a mesh, mended or tolerated.
struct MeshHealth {
  std::size_t degenerate = 0;  // triangles without an area, left out
  std::size_t open_edges = 0;  // of one triangle only
  std::size_t odd_edges = 0;   // of more than two triangles, or of two that disagree
  bool closed() const { return open_edges == 0 && odd_edges == 0; }
  std::string text() const;  // one line for people; empty: nothing to say
};

// A mesh that does not change once built. Queries may come from any thread; they allocate nothing
// and never throw. Coordinates are the given ones less `middle()`: small numbers keep their
// precision.
class TriangleMesh {
 public:
  static constexpr std::size_t kMostTriangles = 6'000'000;

  // indices: three a triangle. `cancel`, if given, ends the work early with std::runtime_error.
  // Errors: std::invalid_argument that says what was found and what is allowed.
  TriangleMesh(std::span<const Eigen::Vector3f> vertices, std::span<const std::uint32_t> indices,
               const std::atomic<bool>* cancel = nullptr);
  ~TriangleMesh();
  TriangleMesh(const TriangleMesh&) = delete;
  TriangleMesh& operator=(const TriangleMesh&) = delete;

  // Finds the nearest place not further than `within`; false if there is none. `hint`: the triangle
  // of an answer nearby, which only makes it faster.
  bool nearest(const Vec3& at, double within, std::uint32_t hint, MeshPoint& out) const noexcept;
  // Finds the first place on the way from `from` to `to`; false if the way is free.
  bool crossing(const Vec3& from, const Vec3& to, MeshPoint& out) const noexcept;
  // True if the surface nearest to the point turns its back to it.
  bool behind(const Vec3& at) const noexcept;

  std::size_t triangles() const { return indices_.size() / 3; }
  std::array<Vec3, 3> corners(std::size_t triangle) const {
    const auto i = static_cast<std::uint32_t>(triangle);
    return {corner(i, 0), corner(i, 1), corner(i, 2)};
  }
  const Vec3& middle() const { return middle_; }
  double radius() const { return radius_; }  // of a ball around the middle that holds the mesh
  const MeshHealth& health() const { return health_; }
  std::size_t bytes() const;  // of memory, the search tree included
  double build_seconds() const { return build_seconds_; }

 private:
  struct Tree;

  Vec3 corner(std::uint32_t triangle, int k) const {
    return places_[indices_[3 * std::size_t{triangle} + static_cast<std::size_t>(k)]]
        .cast<double>();
  }
  void keep_triangles(std::span<const Eigen::Vector3f> vertices,
                      std::span<const std::uint32_t> indices);

  std::vector<Eigen::Vector3f> places_;  // of corners
  std::vector<std::uint32_t> indices_;   // of places, three a triangle
  Vec3 middle_ = Vec3::Zero();
  double radius_ = 0;
  MeshHealth health_;
  double build_seconds_ = 0;
  std::unique_ptr<Tree> tree_;
};

// Point of triangle abc nearest to p (Ericson, Real-Time Collision Detection, 5.1.5).
Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace limpid
