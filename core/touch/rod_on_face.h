// Points where a cylinder or a capsule meets a flat face: a plane, or the face of a box.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "core/math/sizes.h"

namespace limpid {

// A cylinder, or with round ends a capsule, which are beyond its length.
struct Rod {
  Vec3 center = Vec3::Zero();   // [m]
  Vec3 axis = Vec3::UnitZ();    // unit
  double radius = 0, half = 0;  // half: of its length [m]
  bool round_ends = false;
};

// A rectangle that is solid below; without edges it is a plane.
struct Face {
  Vec3 center = Vec3::Zero();                                // [m]
  Vec3 normal = Vec3::UnitZ();                               // out of the solid, unit
  std::array<Vec3, 2> along = {Vec3::Zero(), Vec3::Zero()};  // of its edges, unit
  std::array<double, 2> half = {0, 0};                       // of its edges [m]
  bool edges = false;

  double above(const Vec3& point) const { return normal.dot(point - center); }  // [m]
  bool over(const Vec3& point) const;  // whether it is above or below the rectangle
};

// Returns the face of a box that is furthest from a rod, or in which the rod is least deep.
// `turned`: the box's axes as columns; `half`: of its edges [m].
Face face_towards(const Rod& rod, const Vec3& center, const Mat3& turned, const Vec3& half);
// Least height of a rod above the plane of a face [m].
double height_above(const Rod& rod, const Face& face);

struct RodPoints {
  struct Point {
    Vec3 at = Vec3::Zero();       // on the rod [m]
    Vec3 normal = Vec3::UnitZ();  // out of the face's solid, unit
    double distance = 0;          // negative: inside [m]
  };
  std::array<Point, 4> points{};
  std::size_t count = 0;

  void add(const Vec3& at, const Vec3& normal, double distance) {
    points[count++] = {at, normal, distance};
  }
};

// Finds the points in which a rod is at most `near` from the face [m]. They move steadily with the
// rod, and each is the deepest of its surroundings: so springs there have an energy that depends on
// the rod's pose alone. Lying, these are the lowest points of both ends, or the places where the
// rod goes over edges; standing on an end, the lowest point of its rim, the opposite one, and those
// in the middle between them. Nothing: the rod meets something else than the face, as a corner.
std::optional<RodPoints> rod_on_face(const Rod& rod, const Face& face, double near);

}  // namespace limpid
