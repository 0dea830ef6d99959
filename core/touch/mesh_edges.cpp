#include "core/touch/mesh_edges.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limpid {
namespace {

// Sines below which a direction is a triangle's own, and does not lean to another one.
constexpr double kOwn = 1e-6, kLeans = 1e-4;
// Sine of the angle from which on an edge sticks out.
constexpr double kSharp = 1e-3;
// A place this far beside a corner is on it [m]. Most triangles at a corner that are looked at.
constexpr double kCorner = 1e-6;
constexpr int kMostAround = 64;

Vec3 normal_of(const std::array<Vec3, 3>& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
}

}  // namespace

MeshEdges::MeshEdges(std::shared_ptr<const TriangleMesh> mesh)
    : mesh_(std::move(mesh)), beyond_(mesh_->triangles(), {kNone, kNone, kNone}) {
  // Triangles that meet have the same corners, to the bit.
  using Place = std::array<float, 3>;
  const auto place = [](const Vec3& corner) {
    const Eigen::Vector3f c = corner.cast<float>();
    return Place{c.x(), c.y(), c.z()};
  };
  std::vector<Place> places;
  places.reserve(3 * beyond_.size());
  for (std::size_t t = 0; t < beyond_.size(); ++t) {
    for (const Vec3& corner : mesh_->corners(t)) places.push_back(place(corner));
  }
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  struct Side {
    std::uint64_t edge;
    std::uint32_t triangle, k;
  };
  std::vector<Side> sides;
  sides.reserve(3 * beyond_.size());
  for (std::uint32_t t = 0; t < beyond_.size(); ++t) {
    std::array<std::uint64_t, 3> names{};
    std::ranges::transform(mesh_->corners(t), names.begin(), [&](const Vec3& corner) {
      const auto at = std::ranges::lower_bound(places, place(corner));
      return static_cast<std::uint64_t>(at - places.begin());
    });
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint64_t a = names[k], b = names[(k + 1) % 3];
      sides.push_back({std::min(a, b) << 32 | std::max(a, b), t, k});
    }
  }
  std::ranges::sort(sides, {}, [](const Side& s) { return std::pair(s.edge, s.triangle); });
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t next = i + 1;
    while (next < sides.size() && sides[next].edge == sides[i].edge) ++next;
    if (next - i == 2) {
      beyond_[sides[i].triangle][sides[i].k] = sides[i + 1].triangle;
      beyond_[sides[i + 1].triangle][sides[i + 1].k] = sides[i].triangle;
    }
    i = next;
  }
}

MeshEdges::Edge MeshEdges::edge_at(std::uint32_t triangle, const Vec3& normal, const Vec3& place,
                                   double near) const {
  const auto corners = mesh_->corners(triangle);
  Edge found;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 e = (corners[(k + 1) % 3] - corners[k]).normalized();
    const double inwards = std::abs(normal.cross(e).dot(place - corners[k]));
    if (inwards >= near) continue;
    near = inwards;
    found.number = k;
    found.along = e;
  }
  if (found.number == 3 || beyond_[triangle][found.number] == kNone) return found;
  // The corner of the other triangle that lies off the edge.
  for (const Vec3& corner : mesh_->corners(beyond_[triangle][found.number])) {
    const Vec3 way = corner - corners[found.number];
    const Vec3 across = way - found.along.dot(way) * found.along;
    if (across.squaredNorm() > found.beyond.squaredNorm()) found.beyond = across;
  }
  return found;
}

bool MeshEdges::leans(std::uint32_t triangle, std::size_t corner, const Vec3& direction) const {
  const Vec3 at = mesh_->corners(triangle)[corner];
  // Goes from triangle to triangle about the corner: one way, and where that ends at a border the
  // other way.
  for (const bool forwards : {true, false}) {
    std::uint32_t t = triangle, from = kNone;
    for (int i = 0; i < kMostAround; ++i) {
      const auto corners = mesh_->corners(t);
      const auto k =
          static_cast<std::size_t>(std::find(corners.begin(), corners.end(), at) - corners.begin());
      if (k == 3) break;
      for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3}) {
        const Vec3 edge = corners[other] - at;
        if (direction.dot(edge) > kLeans * edge.norm()) return true;
      }
      const std::uint32_t one = beyond_[t][k], two = beyond_[t][(k + 2) % 3];
      const std::uint32_t next = from == kNone ? (forwards ? one : two) : one == from ? two : one;
      if (next == triangle) return false;
      if (next == kNone) break;
      from = std::exchange(t, next);
    }
  }
  return false;
}

bool MeshEdges::touchable(std::uint32_t triangle, double size, const Vec3& place,
                          const Vec3& direction, double near) const {
  const auto corners = mesh_->corners(triangle);
  const Vec3 normal = normal_of(corners);
  if (direction.cross(normal).squaredNorm() < kOwn * kOwn) return true;
  const Vec3 there = place / size - mesh_->middle();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 way = there - corners[k];
    if (way.squaredNorm() < near * near / (size * size) &&
        (way - direction.dot(way) * direction).norm() < kCorner / size) {
      return !leans(triangle, k, direction);
    }
  }
  const Edge edge = edge_at(triangle, normal, there, near / size);
  return direction.dot(edge.beyond) <= kLeans * edge.beyond.norm();
}

bool MeshEdges::sharp(std::uint32_t triangle, double size, const Vec3& place, double near) const {
  const Vec3 normal = normal_of(mesh_->corners(triangle));
  const Edge edge = edge_at(triangle, normal, place / size - mesh_->middle(), near / size);
  return edge.number < 3 &&
         (edge.beyond.isZero(0) || normal.dot(edge.beyond) < -kSharp * edge.beyond.norm());
}

}  // namespace limpid
