// Edges of a triangle mesh: the directions in which a body can touch them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/touch/triangle_mesh.h"

namespace limpid {

// An edge is touched only from the directions that neither of its two triangles is nearer to, its
// Voronoi region: of an edge between triangles in one plane, or of a groove, from none. So is a
// corner, from the directions that none of its edges leans to. Collision detection that looks at
// each triangle alone finds contacts there; they are none.
class MeshEdges {
 public:
  explicit MeshEdges(std::shared_ptr<const TriangleMesh> mesh);

  // True if a triangle can be touched at a place by something in this direction, unit. Corners and
  // place as the mesh has them, `size` times as large; a place within `near` of an edge is on it.
  bool touchable(std::uint32_t triangle, double size, const Vec3& place, const Vec3& direction,
                 double near) const;

  // True if a place is on an edge that sticks out, or at a border.
  bool sharp(std::uint32_t triangle, double size, const Vec3& place, double near) const;

 private:
  // An edge of a triangle near a place: its number, its direction, and the way to the corner
  // beyond, across it; zero: none is beyond.
  struct Edge {
    std::size_t number = 3;  // 3: no edge is near
    Vec3 along = Vec3::Zero(), beyond = Vec3::Zero();
  };
  Edge edge_at(std::uint32_t triangle, const Vec3& normal, const Vec3& place, double near) const;
  // True if one of the edges that meet at a corner of a triangle leans to a direction.
  bool leans(std::uint32_t triangle, std::size_t corner, const Vec3& direction) const;

  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  std::shared_ptr<const TriangleMesh> mesh_;
  // By triangle: the triangle beyond the edge from corner k to the next; kNone if it is not one.
  std::vector<std::array<std::uint32_t, 3>> beyond_;
};

}  // namespace limpid
