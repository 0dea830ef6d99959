// Points where a convex solid meets a flat face: a plane, a face of a box, or an end of a cylinder.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>

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

// The solid between corners, as a box.
struct Hull {
  Pose pose;
  std::span<const Vec3> corners;  // in its frame [m]
  Vec3 center = Vec3::Zero();     // any point inside [m]

  double reach(const Vec3& way) const;
};

using Convex = std::variant<Rod, Hull>;

// A flat face; the solid is below.
struct Face {
  enum class Bounds : std::uint8_t { none, rectangle, circle };

  Vec3 center = Vec3::Zero();   // [m]
  Vec3 normal = Vec3::UnitZ();  // out of the solid, unit
  Bounds bounds = Bounds::none;
  std::array<Vec3, 2> along = {Vec3::UnitX(), Vec3::UnitY()};  // across the normal, unit
  std::array<double, 2> half = {0, 0};  // of a rectangle's edges; of a circle: its radius [m]

  double above(const Vec3& point) const { return normal.dot(point - center); }  // [m]
  bool over(const Vec3& point) const;  // whether it is above or below the face itself
};

// Returns the face of a box that is furthest from a solid, or in which the solid is least deep.
// `half`: of the box's edges [m].
Face face_of_box(const Convex& solid, const Pose& box, const Vec3& half);
// Returns the end of a cylinder that is towards a solid; nothing if its side is further from it.
std::optional<Face> end_of_cylinder(const Convex& solid, const Rod& cylinder);

struct FacePoints {
  struct Point {
    Vec3 at = Vec3::Zero();       // on the solid [m]
    Vec3 normal = Vec3::UnitZ();  // out of the face's solid, unit
    double distance = 0;          // negative: inside [m]
  };
  std::array<Point, 4> points{};
  std::size_t count = 0;

  void add(const Vec3& at, const Vec3& normal, double distance) {
    points[count++] = {at, normal, distance};
  }
  std::span<const Point> all() const { return std::span(points).first(count); }
};

// Returns four of the points, or all if they are fewer: the deepest, the furthest from it, and
// those that make the largest triangles with both on either side. Points inside go before others.
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

// Returns the points of a rod's end that may be the lowest ones on a face with this normal: one if
// the rod lies, four of its rim if it stands. `end`: the middle of the end [m].
struct EndPoints {
  std::array<Vec3, 4> at;  // [m]
  std::size_t count;

  std::span<const Vec3> all() const { return std::span(at).first(count); }
};
EndPoints end_points(const Rod& rod, const Vec3& end, const Vec3& normal);

}  // namespace limpid
