// Points where a convex solid meets a flat face: a plane, a face of a hull, or an end of a
// cylinder.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "core/math/sizes.h"

namespace limpid {

// A cylinder; with round ends beyond its length, a capsule; without a length, a ball.
struct Rod {
  Vec3 center = Vec3::Zero();   // [m]
  Vec3 axis = Vec3::UnitZ();    // unit
  double radius = 0, half = 0;  // half: of its length [m]
  bool round_ends = false;

  double reach(const Vec3& way) const;  // from its centre, along a unit vector [m]
};

// A flat side of a hull, in the hull's frame.
struct HullFace {
  Vec3 center = Vec3::Zero();   // [m]
  Vec3 normal = Vec3::UnitZ();  // out of the hull, unit
  std::array<Vec3, 2> along = {Vec3::UnitX(), Vec3::UnitY()};
  std::vector<Vec2> outline = {};  // its corners in their order about the normal, from center [m]
};

// The solid between corners, as a box.
struct Hull {
  Pose pose;
  std::span<const Vec3> corners;         // in its frame [m]
  Vec3 center = Vec3::Zero();            // any point inside [m]
  std::span<const HullFace> faces = {};  // empty: they are not known
};

using Convex = std::variant<Rod, Hull>;

// A flat face; the solid is below.
struct Face {
  enum class Bounds : std::uint8_t { none, polygon, circle };

  Vec3 center = Vec3::Zero();   // [m]
  Vec3 normal = Vec3::UnitZ();  // out of the solid, unit
  Bounds bounds = Bounds::none;
  // Across the normal, unit; their cross product is the normal.
  std::array<Vec3, 2> along = {Vec3::UnitX(), Vec3::UnitY()};
  std::span<const Vec2> outline = {};  // of a polygon: its corners in their order, from center [m]
  double radius = 0;                   // of a circle [m]

  double above(const Vec3& point) const { return normal.dot(point - center); }  // [m]
  bool over(const Vec3& point) const;  // whether it is above or below the face itself
  Vec3 corner(std::size_t number) const;
};

// Returns the face of a hull across `normal`: through the corners that are furthest along it, and
// all that are so within `same` [m]. Corners that are so near an edge of the face are none of it.
HullFace hull_face(std::span<const Vec3> corners, const Vec3& normal, double same);
// Returns the six faces of a box. `half`: of its edges [m].
std::vector<HullFace> faces_of_box(const Vec3& half);
// Returns the face of a hull that is furthest from a solid, or in which the solid is least deep.
// The hull has faces.
Face face_of_hull(const Convex& solid, const Hull& hull);
// Returns how far a solid is above the plane of a face; negative: how deep in it [m].
double height_above(const Convex& solid, const Face& face);
// Returns the end of a cylinder that is towards a solid; nothing if its side is further from it.
std::optional<Face> end_of_cylinder(const Convex& solid, const Rod& cylinder);

struct FacePoints {
  struct Point {
    Vec3 at = Vec3::Zero();       // on the solid [m]
    Vec3 normal = Vec3::UnitZ();  // out of the face's solid, unit
    double distance = 0;          // negative: inside [m]

    Vec3 on_other() const { return at - distance * normal; }  // the opposite point [m]
  };
  std::array<Point, 4> points{};
  std::size_t count = 0;
  bool sure = true;  // false: other places of the two may be deeper

  void add(const Vec3& at, const Vec3& normal, double distance) {
    points[count++] = {at, normal, distance};
  }
  std::span<const Point> all() const { return std::span(points).first(count); }
};

// Takes the points of two solids as those of the second on the first.
void turn_round(FacePoints& points);

// Returns four of the points, or all if they are fewer: one of the deepest, the furthest from it,
// the one that makes the largest triangle with both, and the one that adds most to the triangle.
// Points inside go before others.
FacePoints widest_of(std::span<const FacePoints::Point> points);

// Finds the points in which a solid is at most `near` from a face [m], four of them at most.
// Nothing: the solid meets something else than the face, as an edge or a corner.
//
// Points move steadily with the solid, and each is the deepest of its surroundings: so springs
// there have an energy that depends on the pose alone. A rod that lies has the lowest points of
// both ends, or the places where it goes over edges. A cylinder that stands has the lowest point of
// its rim, the opposite one, and those in the middle between them; across edges also those where
// the rim and the edges cross. A hull has its corners.
std::optional<FacePoints> points_on_face(const Convex& solid, const Face& face, double near);

// Finds the points in which the sides of two rods are at most `near` apart, normals out of the
// second: where their axes are nearest, or if they are parallel at both ends of what they share.
// Nothing: an end meets the other one.
std::optional<FacePoints> points_of_sides(const Rod& one, const Rod& two, double near);

// Finds the points in which two hulls with faces are at most `near` apart, normals out of the
// second: corners over the face that the hulls are furthest from, if all that are near are over it;
// else corners of both over faces that lie on each other, and where edges of these cross, which are
// not sure. Nothing: they meet otherwise, as with edges that stand up.
std::optional<FacePoints> points_of_hulls(const Hull& one, const Hull& two, double near);

// Returns the points of a rod's end that may be the lowest ones on a face with this normal: one if
// the rod lies, four of its rim if it stands. `end`: the middle of the end [m].
struct EndPoints {
  std::array<Vec3, 4> at;  // [m]
  std::size_t count;

  std::span<const Vec3> all() const { return std::span(at).first(count); }
};
EndPoints end_points(const Rod& rod, const Vec3& end, const Vec3& normal);

}  // namespace limpid
