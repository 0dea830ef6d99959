#include "core/touch/solid_touch.h"

#include <algorithm>
#include <cmath>

namespace limpid {
namespace {

// Distance beyond which nothing touches within a tick [m].
constexpr double kReach = 0.02;
// Height of the free place above the surfaces that hold it [m].
constexpr double kAbove = 2e-6;
// Distance within which two solids meet [m]: below it a gap or a step is none.
constexpr double kMeet = 1e-6;
// Difference of distances that says nothing [m]. Where two differ by less, the solids' nearest
// points are within kMeet of each other.
constexpr double kTied = 1e-11;
// Cosines: of normals that are the same, of one that faces the other way, and of one that is
// opposite.
constexpr double kSame = 0.99, kAway = -0.5, kOpposite = -0.99;
constexpr double kOne = 1 - 1e-9;  // cosine of normals that differ by rounding
constexpr int kLifts = 4;          // rounds of lifting out of several solids

Surface distance_to(const Solid& solid, const Vec3& point) {
  return std::visit(
      [&](const auto& shape) { return limpid::distance_to(shape, solid.pose, point); },
      solid.shape);
}

// Largest coordinate of a shape along a unit vector of its frame.
double extent(const Plane&, const Vec3&) { return 0; }
double extent(const Sphere& sphere, const Vec3&) { return sphere.radius; }
double extent(const Box& box, const Vec3& n) { return n.cwiseAbs().dot(box.size / 2); }
double extent(const Cylinder& cylinder, const Vec3& n) {
  return cylinder.radius * n.head<2>().norm() + cylinder.length / 2 * std::abs(n.z());
}
double extent(const Capsule& capsule, const Vec3& n) {
  return capsule.radius + capsule.length / 2 * std::abs(n.z());
}

// Plane that touches the solid on the side of a unit vector of its frame.
Surface plane_at(const Solid& solid, const Vec3& side, const Vec3& point) {
  const Vec3 normal = solid.pose.linear() * side;
  const double h = std::visit([&](const auto& shape) { return extent(shape, side); }, solid.shape);
  return {normal.dot(point - solid.pose.translation()) - h, normal};
}

// Visits the normals of the faces nearest to a point inside, in the shape's frame. Round shapes
// have only one, the nearest.
template <class Visit>
void faces(const Box&, const Vec3&, const Visit& visit) {
  for (int axis = 0; axis < 3; ++axis) {
    visit(Vec3(Vec3::Unit(axis)));
    visit(Vec3(-Vec3::Unit(axis)));
  }
}
template <class Visit>
void faces(const Cylinder&, const Vec3& p, const Visit& visit) {
  const double r = p.head<2>().norm();
  if (r > 0) visit(Vec3(p.x() / r, p.y() / r, 0));
  visit(Vec3(Vec3::UnitZ()));
  visit(Vec3(-Vec3::UnitZ()));
}
template <class S, class Visit>
void faces(const S&, const Vec3&, const Visit&) {}

// Surface of a solid nearest to a point inside, or to one that has gone through, of those that do
// not face away from `side`. `nearest`: of all.
Surface on_side(const Solid& solid, const Vec3& point, const Surface& nearest, const Vec3& side) {
  const double along = (solid.pose.linear() * side).dot(nearest.normal);
  if (side.isZero(0) || along >= (nearest.distance < 0 ? kAway : kOpposite)) return nearest;
  Surface best = plane_at(solid, side, point);
  if (nearest.distance >= 0) return best;
  const Vec3 p = solid.pose.linear().transpose() * (point - solid.pose.translation());
  const auto take = [&](const Vec3& normal) {
    if (normal.dot(side) < kAway) return;
    const Surface face = plane_at(solid, normal, point);
    if (face.distance > best.distance) best = face;
  };
  std::visit([&](const auto& shape) { faces(shape, p, take); }, solid.shape);
  return best;
}

}  // namespace

void SolidTouch::forget() {
  std::ranges::fill(sides_, Side{});
  recoverable_ = true;
}

std::span<const SolidTouch::Near> SolidTouch::find(std::span<const Solid> solids, const Vec3& from,
                                                   const Vec3& to) {
  const bool ball = from == to;
  bool held = false;
  count_ = 0;
  recoverable_ = true;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    Near& n = near_[count_];
    std::visit(
        [&](const auto& shape) {
          const Pose& pose = solids[i].pose;
          n.point = ball ? from : nearest_on_segment(shape, pose, from, to);
          n.surface = limpid::distance_to(shape, pose, n.point);
        },
        solids[i].shape);
    Side& side = sides_[i];
    if (!(radius_ - n.surface.distance > -kReach) && !side.holds) {
      side = {};
      continue;
    }
    held = held || side.holds;
    n.solid = i;
    n.counts = true;
    n.inside = n.surface.distance < 0;
    ++count_;
  }
  free_ = from;
  // Inside of one solid alone the free place is not needed.
  const bool alone = count_ == 1 && near_[0].surface.distance < 0;
  if (ball && held && !alone) lift_out(solids, true);
  for (Near& n : near()) choose(solids, n, ball);
  hide_covered(solids, ball);
  for (const Near& n : near()) {
    sides_[n.solid] = {solids[n.solid].pose.linear().transpose() * n.surface.normal,
                       n.counts && n.surface.distance < 0};
  }
  return near();
}

// Lifts the free place out of the solids that hold the probe: by the sides they had, else by the
// surfaces found. A solid into which it is lifted, or slid, is entered on its own side.
void SolidTouch::lift_out(std::span<const Solid> solids, bool by_sides) {
  bool moved = true;
  for (int round = 0; moved && round < kLifts; ++round) {
    moved = false;
    for (const Near& n : near()) {
      const Solid& solid = solids[n.solid];
      const Side& side = sides_[n.solid];
      Surface s{};
      if (by_sides && side.holds) {
        s = plane_at(solid, side.normal, free_);
      } else if (by_sides) {
        s = distance_to(solid, free_);
        if (!(s.distance < 0)) continue;
        s = entered(solids, n, s);
      } else {
        if (!(n.surface.distance < 0)) continue;
        s = {n.surface.distance + n.surface.normal.dot(free_ - n.point), n.surface.normal};
      }
      if (s.distance >= kAbove / 2) continue;
      free_ += (kAbove - s.distance) * s.normal;
      moved = true;
    }
  }
}

// Chooses the surface of a near solid that holds the probe.
void SolidTouch::choose(std::span<const Solid> solids, Near& near, bool ball) {
  const Solid& solid = solids[near.solid];
  const Side& side = sides_[near.solid];
  const Surface nearest = near.surface;
  const auto is_side = [&](const Surface& s) {
    return (solid.pose.linear() * side.normal).dot(s.normal) > kSame;
  };
  const bool lifted = ball && free_ != near.point;
  if (lifted && side.holds && nearest.distance >= 0) {
    // The point has left the solid: by another face, or below it where it is thin.
    const Surface plane = plane_at(solid, side.normal, near.point);
    if (plane.distance < 0 && is_side(distance_to(solid, free_))) near.surface = plane;
  } else if (lifted && !side.holds) {
    Surface seen = distance_to(solid, free_);
    if (seen.distance < 0) seen = entered(solids, near, seen);
    if (seen.normal.dot(nearest.normal) < kOne) {
      near.surface = {seen.distance + seen.normal.dot(near.point - free_), seen.normal};
    }
  } else {
    near.surface = on_side(solid, near.point, nearest, side.normal);
    const bool turned = near.surface.distance < 0 && !is_side(near.surface);
    // Before a side is known, solids that overlap are left each on its own.
    const Asked asked = side.normal.isZero(0) ? Asked::not_inside : Asked::all;
    if (turned && count_ > 1 && covered(solids, near, near.point, near.surface, asked)) {
      near.surface = side.holds ? plane_at(solid, side.normal, near.point)
                                : exposed(solids, near, near.point, near.surface, asked);
    }
  }
  recoverable_ = recoverable_ && near.surface.normal.dot(nearest.normal) > kSame;
}

// Surface of a solid by which the free place has just come in. `nearest`: of all.
Surface SolidTouch::entered(std::span<const Solid> solids, const Near& near,
                            const Surface& nearest) {
  const Surface s = on_side(solids[near.solid], free_, nearest, sides_[near.solid].normal);
  if (!covered(solids, near, free_, s, Asked::all)) return s;
  return exposed(solids, near, free_, s, Asked::all);
}

// True if another solid covers the place of a surface that is nearest to a point inside.
bool SolidTouch::covered(std::span<const Solid> solids, const Near& near, const Vec3& point,
                         const Surface& surface, Asked asked) {
  const Vec3 place = point - (surface.distance - kMeet) * surface.normal;
  return std::ranges::any_of(this->near(), [&](const Near& other) {
    if (other.solid == near.solid) return false;
    const Solid& solid = solids[other.solid];
    if (asked == Asked::not_inside && distance_to(solid, point).distance < 0) return false;
    return distance_to(solid, place).distance <= 0;
  });
}

// Nearest face of a solid that no other one covers; `else_`, if all are covered.
Surface SolidTouch::exposed(std::span<const Solid> solids, const Near& near, const Vec3& point,
                            const Surface& else_, Asked asked) {
  const Solid& solid = solids[near.solid];
  const Vec3& side = sides_[near.solid].normal;
  Surface best = else_;
  bool found = false;
  const Vec3 p = solid.pose.linear().transpose() * (point - solid.pose.translation());
  const auto take = [&](const Vec3& normal) {
    if (normal.dot(side) < kAway) return;
    const Surface face = plane_at(solid, normal, point);
    if ((found && face.distance <= best.distance) || covered(solids, near, point, face, asked)) {
      return;
    }
    best = face;
    found = true;
  };
  std::visit([&](const auto& shape) { faces(shape, p, take); }, solid.shape);
  return best;
}

// Hides solids whose nearest point, seen from the free place, another solid holds that is nearer.
// Two that hold the point both push if they face different ways: it is in a corner of them.
void SolidTouch::hide_covered(std::span<const Solid> solids, bool ball) {
  if (count_ < 2) return;
  free_ = near_[0].point;
  const bool inside =
      std::ranges::any_of(near(), [](const Near& n) { return n.surface.distance < 0; });
  if (ball && inside) lift_out(solids, false);
  for (Near& n : near()) {
    n.seen = ball && inside ? distance_to(solids[n.solid], free_) : n.surface;
  }
  const auto half_space = [&](const Near& n) {
    return std::holds_alternative<Plane>(solids[n.solid].shape);
  };
  const auto apart = [&](const Near& a, const Near& b) {
    if (half_space(a) && half_space(b)) return true;
    return a.inside && b.inside && a.surface.normal.dot(b.surface.normal) < kSame;
  };
  for (Near& n : near()) {
    if (n.seen.distance < 0) continue;
    const Vec3 place = (ball ? free_ : n.point) - n.seen.distance * n.seen.normal;
    for (const Near& other : near()) {
      const double further = n.seen.distance - other.seen.distance;
      const bool nearer = further > kTied || (further >= -kTied && other.solid < n.solid);
      if (!nearer || !other.counts || other.seen.distance < 0 || apart(n, other) ||
          distance_to(solids[other.solid], place).distance > kMeet) {
        continue;
      }
      n.counts = false;
      n.by = other.solid;
      break;
    }
  }
}

}  // namespace limpid
