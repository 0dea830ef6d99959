// A triangle mesh that can be asked, at 1 kHz, what is nearest and what lies between two points.
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

// What edges of a mesh say about it: where triangles meet, and how many.

struct EdgeCount {
  std::size_t open = 0;  // of one triangle only
  std::size_t odd = 0;   // of more than two triangles, or of two that disagree
};
// `corners`: three names a triangle, each less than `names`.
EdgeCount count_edges(std::span<const std::uint32_t> corners, std::size_t names);

// A place on a mesh.
struct MeshPoint {
  Vec3 point = Vec3::Zero();   // [mesh units]
  Vec3 normal = Vec3::Zero();  // of its triangle, unit, to the side of counter-clockwise corners
  double distance = 0;         // from where the question was asked
  std::uint32_t triangle = kNone;  // a hint for the next question; says nothing else

  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
};

// What was found wrong with a mesh and mended, or lived with.
struct MeshHealth {
  std::size_t degenerate = 0;  // triangles without an area, left out
  std::size_t open_edges = 0;  // of one triangle only
  std::size_t odd_edges = 0;   // of more than two triangles, or of two that disagree
  bool closed() const { return open_edges == 0 && odd_edges == 0; }
  std::string text() const;  // one line for people; empty: nothing to say
};

// Does not change once built; questions come from any thread, allocate nothing and never throw.
// Coordinates are those given, less `middle()`: small numbers keep their precision.
class TriangleMesh {
 public:
  static constexpr std::size_t kMostTriangles = 6'000'000;

  // Three indices a triangle. `cancel`, if given, ends the work early with std::runtime_error.
  // Errors: std::invalid_argument saying what was found and what is allowed.
  TriangleMesh(std::span<const Eigen::Vector3f> vertices, std::span<const std::uint32_t> indices,
               const std::atomic<bool>* cancel = nullptr);
  ~TriangleMesh();
  TriangleMesh(const TriangleMesh&) = delete;
  TriangleMesh& operator=(const TriangleMesh&) = delete;

  // The nearest place not further than `within`; false if there is none. `hint`: the triangle of
  // an answer nearby makes it faster, and changes nothing else.
  bool nearest(const Vec3& at, double within, std::uint32_t hint, MeshPoint& out) const noexcept;
  // The first place on the way from `from` to `to`; false if the way is free.
  bool crossing(const Vec3& from, const Vec3& to, MeshPoint& out) const noexcept;
  // Is a point on the side that the surface around it turns its back to?
  bool behind(const Vec3& at) const noexcept;

  std::size_t triangles() const { return indices_.size() / 3; }
  std::array<Vec3, 3> corners(std::size_t triangle) const {
    const auto i = static_cast<std::uint32_t>(triangle);
    return {corner(i, 0), corner(i, 1), corner(i, 2)};
  }
  const Vec3& middle() const { return middle_; }
  double radius() const { return radius_; }  // of a ball around the middle that holds it
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

// The point of triangle abc nearest to p (Ericson, Real-Time Collision Detection, 5.1.5).
Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace limpid
