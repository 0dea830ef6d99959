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
constexpr double kLies = 0.8;    // least cosine between the normals of faces that lie on each other
constexpr double kShort = 1e-9;  // edges up to this length are none [m]
constexpr std::size_t kMost = 128;  // points of two faces before the widest are chosen
// Cosine and sine of the lowest point of a rim, of the opposite one, and of those between.
constexpr std::array<std::array<double, 2>, 4> kWays{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

Vec2 across(const Face& face, const Vec3& way) {
  return {face.along[0].dot(way), face.along[1].dot(way)};
}
Vec3 in_space(const Face& face, const Vec2& way) {
  return way.x() * face.along[0] + way.y() * face.along[1];
}

// height_above(), or any height up to `least` if it is at most that.
double height_of(const Rod& rod, const Face& face, double) {
  return face.above(rod.center) - rod.reach(face.normal);
}
double height_of(const Hull& hull, const Face& face, double least) {
  const Vec3 normal = hull.pose.linear().transpose() * face.normal;
  const double base = face.above(hull.pose.translation());
  double height = std::numeric_limits<double>::infinity();
  for (const Vec3& corner : hull.corners) {
    height = std::min(height, base + normal.dot(corner));
    if (height <= least) break;
  }
  return height;
}

Face placed(const HullFace& face, const Pose& pose) {
  return {.center = pose * face.center,
          .normal = pose.linear() * face.normal,
          .bounds = Face::Bounds::polygon,
          .along = {pose.linear() * face.along[0], pose.linear() * face.along[1]},
          .outline = face.outline};
}

// An edge of a polygon: where it begins, its direction, and the one out of the polygon.
struct Edge {
  Vec2 from, along, out;
  double length;
};

// Calls visit(edge) for each edge of a face that is a polygon.
template <class Visit>
void for_each_edge(const Face& face, const Visit& visit) {
  for (std::size_t i = 0; i < face.outline.size(); ++i) {
    const Vec2& from = face.outline[i];
    const Vec2 way = face.outline[(i + 1) % face.outline.size()] - from;
    const double length = way.norm();
    if (length <= kShort) continue;
    const Vec2 along = way / length;
    visit(Edge{from, along, {along.y(), -along.x()}, length});
  }
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
  if (face.bounds == Face::Bounds::polygon) {
    bool beside = false;
    for_each_edge(face, [&](const Edge& edge) {
      const double out = edge.out.dot(start - edge.from), rise = edge.out.dot(slope);
      const double most = std::abs(rise) * rod.half;
      beside = beside || out > kInside + most;
      if (!beside && out + most > kInside) cut(-out / rise, rise > 0, edge.from, edge.along);
    });
    if (beside) return std::nullopt;
  } else if (face.bounds == Face::Bounds::circle) {
    const double out = start.squaredNorm() - face.radius * face.radius;
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
  if (face.bounds == Face::Bounds::polygon && !face.over(nearest - normal.dot(way) * normal))
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
  constexpr double kAlike = 5e-5;    // depths that differ less are alike [m]
  constexpr double kTie = 1e-6;      // worths that differ by this part are alike [-]
  constexpr double kApart = 1e-12;   // areas of less are none [m^2]
  constexpr double kFurther = 1e-3;  // weight of the distance beside that of the area [-]
  FacePoints found;
  // Chooses the point of the largest worth, if that is positive: one inside before one that is
  // apart, the first of those that are alike. So the choice for a body that lies still stays.
  const auto choose = [&](auto&& worth_of) {
    double most = 0;
    bool inside = false;
    FacePoints::Point best;
    for_each([&](const FacePoints::Point& p) {
      const double worth = worth_of(p);
      const bool in = p.distance < 0;
      if (!(worth > 0) || in < inside || (in == inside && worth <= (1 + kTie) * most)) return;
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
  if (!choose([&](const P& p) { return p.distance <= deepest + kAlike ? 1 : 0; })) return found;
  const Vec3 first = found.points[0].at;
  if (!choose([&](const P& p) { return (p.at - first).squaredNorm(); })) return found;
  // Twice the area of a triangle that turns as the points do.
  const Vec3 normal = found.points[0].normal;
  const auto area = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    return normal.dot((b - a).cross(c - a));
  };
  const Vec3 second = found.points[1].at;
  const auto makes = [&](const P& p) {
    const double size = std::abs(area(first, second, p.at));
    // The furthest wins of those on a line, which make the same triangle.
    return size <= kApart ? 0 : size + kFurther * (p.at - first).norm() * (second - first).norm();
  };
  if (!choose(makes)) return found;
  const bool left = area(first, second, found.points[2].at) > 0;
  const std::array<Vec3, 3> corners{first, left ? second : found.points[2].at,
                                    left ? found.points[2].at : second};
  choose([&](const P& p) {
    double beyond = 0;
    for (std::size_t i = 0; i < 3; ++i)
      beyond = std::max(beyond, -area(corners[i], corners[(i + 1) % 3], p.at));
    return beyond - kApart;
  });
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
  if (face.bounds == Face::Bounds::polygon) {
    for_each_edge(face, [&](const Edge& edge) {
      solve(edge.out.dot(one), edge.out.dot(two), edge.out.dot(edge.from - middle));
    });
  } else if (face.bounds == Face::Bounds::circle) {
    const double out = face.radius * face.radius - middle.squaredNorm();
    solve(2 * middle.dot(one), 2 * middle.dot(two), out - rim.radius * rim.radius);
  }
}

std::optional<FacePoints> standing(const Rod& rod, const Face& face, double near) {
  const double rise = rod.axis.dot(face.normal);
  const Rim rim = rim_of(rod, rod.center - std::copysign(rod.half, rise) * rod.axis, face.normal);
  FacePoints all;
  std::array<FacePoints::Point, kMost> found;
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
  const auto add_below = [&](const Vec3& border) {  // of the face, below the end
    const Vec3 at = border + rim.axis.dot(rim.center - border) / rise * face.normal;
    if ((at - rim.center).norm() <= rim.radius) add(at);
  };
  for (std::size_t i = 0; i < face.outline.size(); ++i) add_below(face.corner(i));
  if (face.bounds == Face::Bounds::circle) {
    for (const auto& [cosine, sine] : kWays) {
      const Vec2 way = across(face, cosine * rim.down + sine * rim.across).normalized();
      add_below(face.center + in_space(face, face.radius * way));
    }
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

// An edge in space.
struct Ridge {
  Vec3 from, along;
  double length;
};

// Calls add(at, normal, distance) for the place on `one` where it crosses `two`, above it if `up`
// is up; nothing if the two are parallel, or meet beside each other rather than on each other.
template <class Add>
void add_edges(const Ridge& one, const Ridge& two, const Vec3& up, const Add& add) {
  Vec3 normal = one.along.cross(two.along);
  const double sine = normal.norm();
  if (sine < kCrosses) return;
  normal *= (normal.dot(up) < 0 ? -1 : 1) / sine;
  if (normal.dot(up) < kLies) return;
  const Vec3 way = two.from - one.from;
  const double cosine = one.along.dot(two.along), sine2 = sine * sine;
  const double a = way.dot(one.along), b = way.dot(two.along);
  const double at = (a - cosine * b) / sine2, there = (cosine * a - b) / sine2;
  if (at < 0 || at > one.length || there < 0 || there > two.length) return;
  add(one.from + at * one.along, normal, -normal.dot(way));
}

// The face of a hull that a solid is furthest from, and how far it is above it [m].
struct Furthest {
  const HullFace* face;
  double height;
};
Furthest furthest_face(const Convex& solid, const Hull& hull) {
  Furthest found{hull.faces.data(), -std::numeric_limits<double>::infinity()};
  for (const HullFace& own : hull.faces) {
    const Face plane{.center = hull.pose * own.center, .normal = hull.pose.linear() * own.normal};
    const double height =
        std::visit([&](const auto& s) { return height_of(s, plane, found.height); }, solid);
    if (height > found.height) found = {&own, height};
  }
  return found;
}

// Returns the face of a hull that is turned most against a face.
Face opposite(const Hull& hull, const Face& face) {
  const Vec3 way = hull.pose.linear().transpose() * face.normal;
  const HullFace& own = *std::ranges::min_element(
      hull.faces, {}, [&](const HullFace& each) { return each.normal.dot(way); });
  return placed(own, hull.pose);
}

// Finds where faces that lie on each other meet: the upper one of a hull that is `height` above the
// lower one's, or the other way round. Nothing is deeper than the hull as a whole.
FacePoints points_of_faces(const Face& upper, const Face& lower, double height, double near) {
  std::array<FacePoints::Point, kMost> found;
  std::size_t count = 0;
  const auto add = [&](const Vec3& at, const Vec3& normal, double distance) {
    if (distance > near || distance < height / kLies - near || count == kMost) return;
    found[count++] = {at, normal, distance};
  };
  for (std::size_t i = 0; i < upper.outline.size(); ++i) {
    const Vec3 corner = upper.corner(i);
    if (lower.over(corner)) add(corner, lower.normal, lower.above(corner));
  }
  for (std::size_t i = 0; i < lower.outline.size(); ++i) {
    const Vec3 corner = lower.corner(i);
    const double distance = upper.above(corner);
    if (upper.over(corner)) add(corner - distance * upper.normal, -upper.normal, distance);
  }
  const auto ridge = [](const Face& face, const Edge& edge) {
    return Ridge{face.center + in_space(face, edge.from), in_space(face, edge.along), edge.length};
  };
  for_each_edge(upper, [&](const Edge& edge) {
    const Ridge above = ridge(upper, edge);
    const Vec2 from = across(lower, above.from - lower.center),
               to = from + edge.length * across(lower, above.along);
    for_each_edge(lower, [&](const Edge& border) {
      const bool goes_out = border.out.dot(from - border.from) > 0;
      if (goes_out == (border.out.dot(to - border.from) > 0)) return;  // it stays on one side
      add_edges(above, ridge(lower, border), lower.normal, add);
    });
  });
  return widest_of(std::span(found).first(count));
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

double height_above(const Convex& solid, const Face& face) {
  constexpr double kLeast = -std::numeric_limits<double>::infinity();
  return std::visit([&](const auto& s) { return height_of(s, face, kLeast); }, solid);
}

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

void turn_round(FacePoints& points) {
  for (FacePoints::Point& point : std::span(points.points).first(points.count)) {
    point.at = point.on_other();
    point.normal = -point.normal;
  }
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

Vec3 Face::corner(std::size_t number) const { return center + in_space(*this, outline[number]); }

bool Face::over(const Vec3& point) const {
  const Vec2 way = across(*this, point - center);
  if (bounds == Bounds::circle) return way.norm() <= radius + kInside;
  bool inside = true;
  for_each_edge(*this, [&](const Edge& edge) {
    inside = inside && edge.out.dot(way - edge.from) <= kInside;
  });
  return inside;
}

HullFace hull_face(std::span<const Vec3> corners, const Vec3& normal, double same) {
  HullFace face{.normal = normal};
  face.along[0] = normal.unitOrthogonal();
  face.along[1] = normal.cross(face.along[0]);
  double most = -std::numeric_limits<double>::infinity();
  for (const Vec3& corner : corners) most = std::max(most, normal.dot(corner));
  std::vector<Vec2> all;
  for (const Vec3& corner : corners) {
    if (normal.dot(corner) < most - same) continue;
    all.emplace_back(face.along[0].dot(corner), face.along[1].dot(corner));
  }
  Vec2 middle = Vec2::Zero();
  for (const Vec2& each : all) middle += each / static_cast<double>(all.size());
  face.center = most * normal + middle.x() * face.along[0] + middle.y() * face.along[1];
  // Round about: each corner is the one to the right of which no other one is.
  Vec2 at = *std::ranges::max_element(
      all, {}, [&](const Vec2& each) { return (each - middle).squaredNorm(); });
  const auto turned = [](const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); };
  do {
    face.outline.push_back(at - middle);
    Vec2 next = at;
    for (const Vec2& each : all) {
      const double side = turned(next - at, each - at);
      const bool further = (each - at).squaredNorm() > (next - at).squaredNorm();
      if (next == at || side < -same * (next - at).norm() ||
          (side <= same * (next - at).norm() && further))
        next = each;
    }
    at = next;
  } while (at - middle != face.outline.front() && face.outline.size() < all.size());
  return face;
}

std::vector<HullFace> faces_of_box(const Vec3& half) {
  std::vector<HullFace> faces;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    for (const double side : {-1.0, 1.0}) {
      faces.push_back({.center = side * half[i] * Vec3::Unit(i),
                       .normal = side * Vec3::Unit(i),
                       .along = {Vec3::Unit(j), side * Vec3::Unit(k)},
                       .outline = {{half[j], half[k]},
                                   {-half[j], half[k]},
                                   {-half[j], -half[k]},
                                   {half[j], -half[k]}}});
    }
  }
  return faces;
}

Face face_of_hull(const Convex& solid, const Hull& hull) {
  return placed(*furthest_face(solid, hull).face, hull.pose);
}

std::optional<FacePoints> points_of_hulls(const Hull& one, const Hull& two, double near) {
  const Furthest on_two = furthest_face(one, two), on_one = furthest_face(two, one);
  const double height = std::max(on_two.height, on_one.height);
  if (height > near) return FacePoints{};
  const bool lies = on_two.height >= on_one.height;  // the first on the second's face
  const Face flat = lies ? placed(*on_two.face, two.pose) : placed(*on_one.face, one.pose);
  if (auto corners = on_face(lies ? one : two, flat, near)) {
    if (!lies) turn_round(*corners);
    return corners;
  }
  const Face other = opposite(lies ? one : two, flat);
  if (-flat.normal.dot(other.normal) < kLies) return std::nullopt;
  auto points = points_of_faces(lies ? other : flat, lies ? flat : other, height, near);
  points.sure = false;
  return points.count > 0 ? std::optional(points) : std::nullopt;
}

std::optional<Face> end_of_cylinder(const Convex& solid, const Rod& cylinder) {
  const Vec3 center = std::visit([](const auto& s) { return s.center; }, solid);
  const Vec3 way = center - cylinder.center;
  const Vec3 normal = std::copysign(1, way.dot(cylinder.axis)) * cylinder.axis;
  Face end{.center = cylinder.center + cylinder.half * normal,
           .normal = normal,
           .bounds = Face::Bounds::circle,
           .radius = cylinder.radius};
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
