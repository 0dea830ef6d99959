#include "core/touch/face_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limpid {
namespace {

constexpr double kStands = 0.7;  // rise of a cylinder's axis from which on it stands on an end [-]
constexpr double kLevel = 1e-9;  // slope of an end at which no point is the lowest [-]
constexpr double kCrosses = 0.05;  // least sine of the angle at which a rod goes over an edge [-]
constexpr double kInside = 1e-9;   // points so far beyond an edge are at it [m]
// Cosine and sine of the lowest point of a rim, of the opposite one, and of those between.
constexpr std::array<std::array<double, 2>, 4> kWays{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

Vec2 across(const Face& face, const Vec3& way) {
  return {face.along[0].dot(way), face.along[1].dot(way)};
}
Vec3 in_space(const Face& face, const Vec2& way) {
  return way.x() * face.along[0] + way.y() * face.along[1];
}

double height_above(const Convex& solid, const Face& face) {
  return std::visit([&](const auto& s) { return face.above(s.center) - s.reach(-face.normal); },
                    solid);
}

// A place on the border of a face, and the border's direction there.
struct Border {
  Vec3 at, along;
};

// End of the line on which a rod lies: its own, or where the line leaves the face.
struct LineEnd {
  double at;  // by the rod's axis [m]
  std::optional<Border> border = {};
};
struct Line {
  LineEnd first, last;
};

// Returns the part of a rod's lowest line that is over a face; nothing if it is beside it.
std::optional<Line> line_over(const Rod& rod, const Face& face, const Vec3& down) {
  Line line{{-rod.half}, {rod.half}};
  const Vec2 start = across(face, rod.center + rod.radius * down - face.center);
  const Vec2 slope = across(face, rod.axis);
  const auto cut = [&](double at, bool last, const Vec2& border, const Vec2& along) {
    LineEnd& end = last ? line.last : line.first;
    if (last ? at >= end.at : at <= end.at) return;
    end = {at, Border{face.center + in_space(face, border), in_space(face, along)}};
  };
  if (face.bounds == Face::Bounds::rectangle) {
    for (int i = 0; i < 2; ++i) {
      const double half = face.half[static_cast<std::size_t>(i)];
      const double most = std::abs(slope[i]) * rod.half;
      if (std::abs(start[i]) > half + kInside + most) return std::nullopt;
      if (std::abs(start[i]) + most <= half + kInside) continue;
      for (const double side : {-1.0, 1.0}) {
        if (half - side * start[i] >= most) continue;
        const double at = (side * half - start[i]) / slope[i];
        cut(at, side * slope[i] > 0, side * half * Vec2::Unit(i), Vec2::Unit(1 - i));
      }
    }
  } else if (face.bounds == Face::Bounds::circle) {
    const double out = start.squaredNorm() - face.half[0] * face.half[0];
    const double a = slope.squaredNorm(), b = start.dot(slope);
    if (out > 0 && (a == 0 || b * b < a * out)) return std::nullopt;
    if (a > 0) {
      const double root = std::sqrt(std::max(0.0, b * b - a * out));
      for (const double side : {-1.0, 1.0}) {
        const double at = (side * root - b) / a;
        const Vec2 there = start + at * slope;
        cut(at, side > 0, there, Vec2(-there.y(), there.x()).normalized());
      }
    }
  }
  if (line.first.at > line.last.at) return std::nullopt;
  return line;
}

// Adds the point where the rod's side goes over a border; false if it meets a corner or an end.
bool add_crossing(const Rod& rod, const Face& face, const Border& border, double near,
                  FacePoints& found) {
  Vec3 normal = border.along.cross(rod.axis);
  const double sine = normal.norm();
  if (sine < kCrosses) return false;
  normal *= (normal.dot(face.normal) < 0 ? -1 : 1) / sine;
  const Vec3 way = rod.center - border.at;
  const double cosine = border.along.dot(rod.axis);
  const double at = (cosine * way.dot(border.along) - way.dot(rod.axis)) / (sine * sine);
  if (std::abs(at) > rod.half) return false;
  const Vec3 nearest = rod.center + at * rod.axis;
  if (face.bounds == Face::Bounds::rectangle && !face.over(nearest - normal.dot(way) * normal))
    return false;
  const double distance = normal.dot(way) - rod.radius;
  if (distance <= near) found.add(nearest - rod.radius * normal, normal, distance);
  return true;
}

bool stands(const Rod& rod, const Vec3& normal) {
  return !rod.round_ends && std::abs(rod.axis.dot(normal)) > kStands;
}

// Direction across the axis to a rod's lowest points; of a capsule straight down.
Vec3 downwards(const Rod& rod, const Vec3& normal) {
  if (rod.round_ends) return -normal;
  const Vec3 way = rod.axis.dot(normal) * rod.axis - normal;
  const double slope = way.norm();
  return slope > kLevel ? Vec3(way / slope) : rod.axis.unitOrthogonal();
}

std::optional<FacePoints> lying(const Rod& rod, const Face& face, double near) {
  const Vec3 down = downwards(rod, face.normal);
  const auto line = line_over(rod, face, down);
  if (!line) return std::nullopt;
  FacePoints found;
  for (const LineEnd& end : {line->first, line->last}) {
    if (rod.half == 0 && found.count > 0) break;  // a ball has one point
    const Vec3 at = rod.center + end.at * rod.axis + rod.radius * down;
    const double distance = face.above(at);
    if (end.border && distance <= near + rod.radius) {
      if (!add_crossing(rod, face, *end.border, near, found)) return std::nullopt;
    } else if (distance <= near) {
      found.add(at, face.normal, distance);
    }
  }
  return found;
}

// widest_of() the points p for which for_each calls visit(p).
template <class ForEach>
FacePoints widest(const ForEach& for_each) {
  constexpr double kApart = 1e-12;  // areas of less are none [m^2]
  FacePoints found;
  // Chooses the point of the largest worth, if that is positive: one inside before one that is
  // apart.
  const auto choose = [&](auto&& worth_of) {
    double most = 0;
    bool inside = false;
    FacePoints::Point best;
    for_each([&](const FacePoints::Point& p) {
      const double worth = worth_of(p);
      const bool in = p.distance < 0;
      if (!(worth > 0) || in < inside || (in == inside && worth <= most)) return;
      most = worth;
      inside = in;
      best = p;
    });
    if (most > 0) found.points[found.count++] = best;
    return most > 0;
  };
  double deepest = std::numeric_limits<double>::infinity();
  for_each([&](const FacePoints::Point& p) { deepest = std::min(deepest, p.distance); });
  using P = FacePoints::Point;
  if (!choose([&](const P& p) { return 1 + deepest - p.distance; })) return found;
  const Vec3 first = found.points[0].at;
  if (!choose([&](const P& p) { return (p.at - first).squaredNorm(); })) return found;
  const Vec3 way = found.points[0].normal.cross(found.points[1].at - first);
  for (const double side : {-1.0, 1.0})
    choose([&](const P& p) { return side * way.dot(p.at - first) - kApart; });
  return found;
}

// Rim of a cylinder's end.
struct Rim {
  Vec3 center, axis, down, across;  // down: to its lowest point
  double radius;

  Vec3 at(double cosine, double sine) const {
    return center + radius * (cosine * down + sine * across);
  }
};

// `center`: the middle of the end [m].
Rim rim_of(const Rod& rod, const Vec3& center, const Vec3& normal) {
  const Vec3 down = downwards(rod, normal);
  return {center, rod.axis, down, rod.axis.cross(down), rod.radius};
}

// Calls visit(point) where a rim crosses the face's border, seen along the normal.
template <class Visit>
void crossings(const Rim& rim, const Face& face, const Visit& visit) {
  // Solves p cos + q sin = c.
  const auto solve = [&](double p, double q, double c) {
    const double size2 = p * p + q * q;
    if (!(c * c < size2)) return;
    for (const double root : {-std::sqrt(size2 - c * c), std::sqrt(size2 - c * c)}) {
      const Vec3 at = rim.at((c * p - q * root) / size2, (c * q + p * root) / size2);
      if (face.bounds == Face::Bounds::circle || face.over(at)) visit(at);
    }
  };
  const Vec2 middle = across(face, rim.center - face.center);
  const Vec2 one = rim.radius * across(face, rim.down), two = rim.radius * across(face, rim.across);
  if (face.bounds == Face::Bounds::rectangle) {
    for (int i = 0; i < 2; ++i) {
      for (const double side : {-1.0, 1.0})
        solve(one[i], two[i], side * face.half[static_cast<std::size_t>(i)] - middle[i]);
    }
  } else if (face.bounds == Face::Bounds::circle) {
    const double out = face.half[0] * face.half[0] - middle.squaredNorm();
    solve(2 * middle.dot(one), 2 * middle.dot(two), out - rim.radius * rim.radius);
  }
}

std::optional<FacePoints> standing(const Rod& rod, const Face& face, double near) {
  const double rise = rod.axis.dot(face.normal);
  const Rim rim = rim_of(rod, rod.center - std::copysign(rod.half, rise) * rod.axis, face.normal);
  FacePoints all;
  std::array<FacePoints::Point, 16> found;
  std::size_t count = 0;
  const auto add = [&](const Vec3& at) {
    const double distance = face.above(at);
    if (distance <= near && count < found.size()) found[count++] = {at, face.normal, distance};
  };
  bool whole = true;
  for (const auto& [cosine, sine] : kWays) {
    const Vec3 at = rim.at(cosine, sine);
    const double distance = face.above(at);
    if (distance > near) continue;
    if (face.over(at)) {
      all.add(at, face.normal, distance);
      add(at);
    } else {
      whole = false;
    }
  }
  if (whole) return all;
  crossings(rim, face, add);
  for (const auto& [cosine, sine] : kWays) {  // the face's corners below the end
    const Vec2 corner =
        face.bounds == Face::Bounds::rectangle
            ? Vec2((cosine + sine) * face.half[0], (cosine - sine) * face.half[1])
            : Vec2(across(face, cosine * rim.down + sine * rim.across).normalized() * face.half[0]);
    const Vec3 below = face.center + in_space(face, corner);
    const Vec3 at = below + rim.axis.dot(rim.center - below) / rise * face.normal;
    if ((at - rim.center).norm() <= rim.radius) add(at);
  }
  const FacePoints points = widest_of(std::span(found).first(count));
  return points.count > 0 ? std::optional(points) : std::nullopt;
}

// Moves two places on axes to where the axes' segments are nearest. a, b: what the way between
// their middles is along each; cosine: of the angle between them.
void nearest_of_segments(double half, double other_half, double a, double b, double cosine,
                         double& at, double& other) {
  at = std::clamp(at, -half, half);
  other = std::clamp(b + cosine * at, -other_half, other_half);
  at = std::clamp(cosine * other - a, -half, half);
}

// Adds the point of a rod's side at `at` on its axis, by the way there from the other one's axis.
bool add_side(const Rod& one, double at, const Vec3& way, double other_radius, double near,
              FacePoints& found) {
  const double away = way.norm();
  if (!(away > 0)) return false;
  const Vec3 normal = way / away;
  const double distance = away - one.radius - other_radius;
  if (distance <= near)
    found.add(one.center + at * one.axis - one.radius * normal, normal, distance);
  return true;
}

std::optional<FacePoints> on_face(const Rod& rod, const Face& face, double near) {
  return stands(rod, face.normal) ? standing(rod, face, near) : lying(rod, face, near);
}

std::optional<FacePoints> on_face(const Hull& hull, const Face& face, double near) {
  const Vec3 normal = hull.pose.linear().transpose() * face.normal;
  const double base = face.above(hull.pose.translation());
  FacePoints few;
  std::size_t count = 0;
  for (const Vec3& corner : hull.corners) {
    const double distance = base + normal.dot(corner);
    if (distance > near) continue;
    const Vec3 at = hull.pose * corner;
    if (!face.over(at)) return std::nullopt;
    if (count++ < few.points.size()) few.add(at, face.normal, distance);
  }
  if (count == few.count) return few;
  return widest([&](auto&& visit) {
    for (const Vec3& corner : hull.corners) {
      const double distance = base + normal.dot(corner);
      if (distance <= near) visit(FacePoints::Point{hull.pose * corner, face.normal, distance});
    }
  });
}

}  // namespace

std::optional<FacePoints> points_of_sides(const Rod& one, const Rod& two, double near) {
  const Vec3 between = one.center - two.center;
  const double cosine = one.axis.dot(two.axis), sine2 = 1 - cosine * cosine;
  const double b = between.dot(two.axis), a = between.dot(one.axis);
  FacePoints found;
  if (sine2 > kCrosses * kCrosses) {
    double at = (cosine * b - a) / sine2, other = (b - cosine * a) / sine2;
    if (std::abs(at) > one.half || std::abs(other) > two.half) {
      if (!one.round_ends || !two.round_ends) return std::nullopt;
      nearest_of_segments(one.half, two.half, a, b, cosine, at, other);
    }
    const Vec3 way = between + at * one.axis - other * two.axis;
    if (!add_side(one, at, way, two.radius, near, found)) return std::nullopt;
    return found;
  }
  const double reach = two.half / std::abs(cosine),
               middle = -b / cosine;  // the other's, on this axis
  const double first = std::max(-one.half, middle - reach),
               last = std::min(one.half, middle + reach);
  if (first > last) {  // beside each other only round ends meet
    if (!one.round_ends || !two.round_ends) return std::nullopt;
    double at = std::clamp(middle, -one.half, one.half), other = 0;
    nearest_of_segments(one.half, two.half, a, b, cosine, at, other);
    const Vec3 way = between + at * one.axis - other * two.axis;
    if (!add_side(one, at, way, two.radius, near, found)) return std::nullopt;
    return found;
  }
  for (const double at : {first, last}) {
    const Vec3 from = between + at * one.axis;
    if (!add_side(one, at, from - from.dot(two.axis) * two.axis, two.radius, near, found))
      return std::nullopt;
  }
  return found;
}

FacePoints widest_of(std::span<const FacePoints::Point> points) {
  return widest([&](auto&& visit) { std::ranges::for_each(points, visit); });
}

EndPoints end_points(const Rod& rod, const Vec3& end, const Vec3& normal) {
  const Rim rim = rim_of(rod, end, normal);
  if (!stands(rod, normal)) return {{rim.at(1, 0)}, 1};
  EndPoints found{{}, kWays.size()};
  std::ranges::transform(kWays, found.at.begin(),
                         [&](const auto& way) { return rim.at(way[0], way[1]); });
  return found;
}

double Rod::reach(const Vec3& way) const {
  const double rise = std::min(1.0, std::abs(axis.dot(way)));
  return rise * half + (round_ends ? 1 : std::sqrt(1 - rise * rise)) * radius;
}

double Hull::reach(const Vec3& way) const {
  const Vec3 own = pose.linear().transpose() * way;
  double most = -std::numeric_limits<double>::infinity();
  for (const Vec3& corner : corners) most = std::max(most, own.dot(corner));
  return most + way.dot(pose.translation() - center);
}

bool Face::over(const Vec3& point) const {
  const Vec2 way = across(*this, point - center);
  switch (bounds) {
    case Bounds::rectangle:
      return std::abs(way.x()) <= half[0] + kInside && std::abs(way.y()) <= half[1] + kInside;
    case Bounds::circle: return way.norm() <= half[0] + kInside;
    case Bounds::none: break;
  }
  return true;
}

Face face_of_box(const Convex& solid, const Pose& box, const Vec3& half) {
  Face furthest;
  double most = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    for (const double side : {-1.0, 1.0}) {
      const Vec3 normal = side * box.linear().col(i);
      const Face face{.center = box.translation() + half[i] * normal,
                      .normal = normal,
                      .bounds = Face::Bounds::rectangle,
                      .along = {box.linear().col(j), box.linear().col(k)},
                      .half = {half[j], half[k]}};
      const double height = height_above(solid, face);
      if (height <= most) continue;
      most = height;
      furthest = face;
    }
  }
  return furthest;
}

std::optional<Face> end_of_cylinder(const Convex& solid, const Rod& cylinder) {
  const Vec3 center = std::visit([](const auto& s) { return s.center; }, solid);
  const Vec3 way = center - cylinder.center;
  const Vec3 normal = std::copysign(1, way.dot(cylinder.axis)) * cylinder.axis;
  Face end{.center = cylinder.center + cylinder.half * normal,
           .normal = normal,
           .bounds = Face::Bounds::circle,
           .half = {cylinder.radius, 0}};
  end.along[0] = normal.unitOrthogonal();
  end.along[1] = normal.cross(end.along[0]);
  const Vec3 beside = way - way.dot(normal) * normal;
  if (const double away = beside.norm(); away > 0) {
    const Face side{.center = cylinder.center + cylinder.radius / away * beside,
                    .normal = beside / away};
    if (height_above(solid, side) > height_above(solid, end)) return std::nullopt;
  }
  return end;
}

std::optional<FacePoints> points_on_face(const Convex& solid, const Face& face, double near) {
  if (const auto* hull = std::get_if<Hull>(&solid)) return on_face(*hull, face, near);
  if (height_above(solid, face) > near) return FacePoints{};
  return on_face(std::get<Rod>(solid), face, near);
}

}  // namespace limpid
