#include "core/touch/rod_on_face.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limpid {
namespace {

constexpr double kStands = 0.7;  // rise of a cylinder's axis from which on it stands on an end [-]
constexpr double kLevel = 1e-9;  // slope of an end at which no point is the lowest [-]
constexpr double kCrosses = 0.05;  // least sine of the angle at which a rod goes over an edge [-]
constexpr double kInside = 1e-9;   // points so far beyond an edge are at it [m]

// Direction from the axis to the lowest line of a rod that lies.
Vec3 downwards(const Rod& rod, const Face& face) {
  if (rod.round_ends) return -face.normal;
  return (rod.axis.dot(face.normal) * rod.axis - face.normal).normalized();
}

// Ends of the line that a rod lies on, by its axis [m], and edges where it leaves the face.
struct Line {
  struct End {
    double at;
    int edge = -1;  // -1: its own end
    double side = 0;
  };
  End first, last;
};

// Returns the part of the lowest line that is over the face; nothing if it is beside it.
std::optional<Line> line_over(const Rod& rod, const Face& face, const Vec3& down) {
  Line line{{-rod.half}, {rod.half}};
  if (!face.edges) return line;
  for (int i = 0; i < 2; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double slope = rod.axis.dot(face.along[k]);
    const double middle = face.along[k].dot(rod.center + rod.radius * down - face.center);
    for (const double side : {-1.0, 1.0}) {  // side * (middle + slope s) <= half
      const double room = face.half[k] + kInside - side * middle, grows = side * slope;
      if (room + std::abs(grows) * rod.half < 0) return std::nullopt;
      if (room >= std::abs(grows) * rod.half) continue;
      const double at = room / grows;
      if (grows > 0 && at < line.last.at) line.last = {at, i, side};
      if (grows < 0 && at > line.first.at) line.first = {at, i, side};
    }
  }
  if (line.first.at > line.last.at) return std::nullopt;
  return line;
}

// Adds the point where the rod's side goes over an edge; false if it meets a corner or an end.
bool add_crossing(const Rod& rod, const Face& face, const Line::End& end, double near,
                  RodPoints& found) {
  const auto own = static_cast<std::size_t>(end.edge), other = 1 - own;
  const Vec3& e = face.along[other];
  const Vec3 edge = face.center + end.side * face.half[own] * face.along[own];
  Vec3 normal = e.cross(rod.axis);
  const double sine = normal.norm();
  if (sine < kCrosses) return false;
  normal *= (normal.dot(face.normal) < 0 ? -1 : 1) / sine;
  const Vec3 way = rod.center - edge;
  const double cosine = e.dot(rod.axis);
  const double at = (cosine * way.dot(e) - way.dot(rod.axis)) / (sine * sine);
  const Vec3 nearest = rod.center + at * rod.axis;
  if (std::abs(at) > rod.half || std::abs(e.dot(nearest - edge)) > face.half[other]) return false;
  const double distance = normal.dot(way) - rod.radius;
  if (distance <= near) found.add(nearest - rod.radius * normal, normal, distance);
  return true;
}

std::optional<RodPoints> lying(const Rod& rod, const Face& face, double near) {
  const Vec3 down = downwards(rod, face);
  const auto line = line_over(rod, face, down);
  if (!line) return std::nullopt;
  RodPoints found;
  for (const Line::End& end : {line->first, line->last}) {
    const Vec3 at = rod.center + end.at * rod.axis + rod.radius * down;
    const double distance = face.above(at);
    if (end.edge >= 0 && distance <= near + rod.radius) {
      if (!add_crossing(rod, face, end, near, found)) return std::nullopt;
    } else if (distance <= near) {
      found.add(at, face.normal, distance);
    }
  }
  return found;
}

std::optional<RodPoints> standing(const Rod& rod, const Face& face, double near) {
  const double rise = rod.axis.dot(face.normal);
  const Vec3 center = rod.center - std::copysign(rod.half, rise) * rod.axis;
  Vec3 down = rise * rod.axis - face.normal;
  const double slope = down.norm();
  down = slope > kLevel ? Vec3(down / slope) : rod.axis.unitOrthogonal();
  const Vec3 across = rod.axis.cross(down);
  RodPoints found;
  for (const Vec3& way : {down, Vec3(-down), across, Vec3(-across)}) {
    const Vec3 at = center + rod.radius * way;
    const double distance = face.above(at);
    if (distance > near) continue;
    if (!face.over(at)) return std::nullopt;
    found.add(at, face.normal, distance);
  }
  return found;
}

}  // namespace

bool Face::over(const Vec3& point) const {
  if (!edges) return true;
  const Vec3 way = point - center;
  return std::abs(along[0].dot(way)) <= half[0] + kInside &&
         std::abs(along[1].dot(way)) <= half[1] + kInside;
}

double height_above(const Rod& rod, const Face& face) {
  const double rise = std::min(1.0, std::abs(rod.axis.dot(face.normal)));
  const double side = rod.round_ends ? 1 : std::sqrt(1 - rise * rise);
  return face.above(rod.center) - rise * rod.half - side * rod.radius;
}

Face face_towards(const Rod& rod, const Vec3& center, const Mat3& turned, const Vec3& half) {
  Face furthest;
  double most = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    for (const double side : {-1.0, 1.0}) {
      const Vec3 normal = side * turned.col(i);
      const Face face{.center = center + half[i] * normal,
                      .normal = normal,
                      .along = {turned.col(j), turned.col(k)},
                      .half = {half[j], half[k]},
                      .edges = true};
      const double height = height_above(rod, face);
      if (height <= most) continue;
      most = height;
      furthest = face;
    }
  }
  return furthest;
}

std::optional<RodPoints> rod_on_face(const Rod& rod, const Face& face, double near) {
  if (height_above(rod, face) > near) return RodPoints{};
  const bool stands = !rod.round_ends && std::abs(rod.axis.dot(face.normal)) > kStands;
  return stands ? standing(rod, face, near) : lying(rod, face, near);
}

}  // namespace limpid
