#include "core/touch/solid_touch.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace limpid {
namespace {

// Distance beyond which nothing touches within a tick [m].
constexpr double kReach = 0.02;
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

// Direction in the world of a remembered side, and the other way round. What is still needs no
// turning.
Vec3 in_world(const Solid& solid, const Vec3& side) {
  return solid.body == BodyContact::kStill ? side : Vec3(solid.pose.linear() * side);
}
Vec3 remembered(const Solid& solid, const Vec3& normal) {
  return solid.body == BodyContact::kStill ? normal
                                           : Vec3(solid.pose.linear().transpose() * normal);
}

// Plane that touches the solid on the side of a unit vector of the world.
Surface plane_at(const Solid& solid, const Vec3& normal, const Vec3& point) {
  const Vec3 side = solid.pose.linear().transpose() * normal;
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

// Face nearest to a point inside, of those that do not face away from `side` and that `may` be;
// `best`, if none is nearer than that one.
template <class May>
std::optional<Surface> nearest_face(const Solid& solid, const Vec3& point, const Vec3& side,
                                    std::optional<Surface> best, const May& may) {
  const Vec3 p = solid.pose.linear().transpose() * (point - solid.pose.translation());
  const auto take = [&](const Vec3& own) {
    const Vec3 normal = solid.pose.linear() * own;
    if (normal.dot(side) < kAway) return;
    const Surface face = plane_at(solid, normal, point);
    if ((!best || face.distance > best->distance) && may(face)) best = face;
  };
  std::visit([&](const auto& shape) { faces(shape, p, take); }, solid.shape);
  return best;
}

// Surface of a solid nearest to a point inside, or to one that has gone through, of those that do
// not face away from `side`. `nearest`: of all.
Surface on_side(const Solid& solid, const Vec3& point, const Surface& nearest, const Vec3& side) {
  const double along = side.dot(nearest.normal);
  if (side.isZero(0) || along >= (nearest.distance < 0 ? kAway : kOpposite)) return nearest;
  const Surface same = plane_at(solid, side, point);
  if (nearest.distance >= 0) return same;
  return *nearest_face(solid, point, side, same, [](const Surface&) { return true; });
}

}  // namespace

void SolidTouch::forget() {
  std::ranges::fill(sides_, Side{});
  recoverable_ = true;
}

void SolidTouch::look(std::span<const Solid> solids, const Vec3& from, const Vec3& to,
                      const Vec3& free) {
  ball_ = from == to;
  bool held = false;
  count_ = 0;
  recoverable_ = true;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    Near& n = near_[count_];
    std::visit(
        [&](const auto& shape) {
          const Pose& pose = solids[i].pose;
          n.point = ball_ ? from : nearest_on_segment(shape, pose, from, to);
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
  free_ = free;
  // Inside of one solid alone the free place is not needed.
  const bool alone = count_ == 1 && near_[0].inside && free == from;
  if (ball_ && (held || free != from) && !alone) lift_out(solids, true);
}

std::span<const SolidTouch::Near> SolidTouch::settle(std::span<const Solid> solids) {
  for (Near& n : nears()) choose(solids, n);
  if (count_ + meshes_.size() > 1) hide_covered(solids);
  for (const Near& n : near()) {
    sides_[n.solid] = {remembered(solids[n.solid], n.surface.normal), n.counts,
                       n.counts && n.surface.distance < 0};
  }
  return near();
}

Vec3 SolidTouch::lifted(std::span<const Solid> solids, Vec3 point, bool whole) const {
  const double out = whole ? radius_ : 0;
  for (const Near& n : near()) {
    const Side& side = sides_[n.solid];
    if (!(whole ? side.counts : side.holds)) continue;
    const Solid& solid = solids[n.solid];
    const Surface s = plane_at(solid, in_world(solid, side.normal), point);
    if (s.distance < out + kAbove / 2) point += (out + kAbove - s.distance) * s.normal;
  }
  return point;
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
        s = plane_at(solid, in_world(solid, side.normal), free_);
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
void SolidTouch::choose(std::span<const Solid> solids, Near& near) {
  const Solid& solid = solids[near.solid];
  const bool holds = sides_[near.solid].holds;
  const Vec3 side = in_world(solid, sides_[near.solid].normal);
  const auto is_side = [&](const Surface& s) { return side.dot(s.normal) > kSame; };
  const bool lifted = ball_ && free_ != near.point;
  if (!lifted && is_side(near.surface)) return;
  const Surface nearest = near.surface;
  if (lifted && holds && nearest.distance >= 0) {
    // The point has left the solid: by another face, or below it where it is thin.
    const Surface plane = plane_at(solid, side, near.point);
    if (plane.distance < 0 && is_side(distance_to(solid, free_))) near.surface = plane;
  } else if (lifted && !holds) {
    Surface seen = distance_to(solid, free_);
    if (seen.distance < 0) seen = entered(solids, near, seen);
    if (seen.normal.dot(nearest.normal) < kOne) {
      near.surface = {seen.distance + seen.normal.dot(near.point - free_), seen.normal};
    }
  } else {
    near.surface = on_side(solid, near.point, nearest, side);
    const bool turned = near.surface.distance < 0 && !is_side(near.surface);
    // Before a side is known, solids that overlap are left each on its own.
    const Asked asked = side.isZero(0) ? Asked::not_inside : Asked::all;
    const bool several = count_ > 1 || !meshes_.empty();
    if (turned && several && covered(solids, near, near.point, near.surface, asked)) {
      near.surface = holds ? plane_at(solid, side, near.point)
                           : exposed(solids, near, near.point, near.surface, asked);
    }
  }
  recoverable_ = recoverable_ && near.surface.normal.dot(nearest.normal) > kSame;
}

// Surface of a solid by which the free place has just come in. `nearest`: of all.
Surface SolidTouch::entered(std::span<const Solid> solids, const Near& near,
                            const Surface& nearest) {
  const Solid& solid = solids[near.solid];
  const Vec3 side = in_world(solid, sides_[near.solid].normal);
  const Surface s = on_side(solid, free_, nearest, side);
  if (side.dot(s.normal) > kSame || !covered(solids, near, free_, s, Asked::all)) return s;
  return exposed(solids, near, free_, s, Asked::all);
}

// True if another solid covers the place of a surface that is nearest to a point inside.
bool SolidTouch::covered(std::span<const Solid> solids, const Near& near, const Vec3& point,
                         const Surface& surface, Asked asked) {
  const Vec3 foot = point - surface.distance * surface.normal;
  const Vec3 place = foot + kMeeting * surface.normal;
  const auto in_solid = [&](const Near& other) {
    if (other.solid == near.solid) return false;
    const Solid& solid = solids[other.solid];
    if (asked == Asked::not_inside && distance_to(solid, point).distance < 0) return false;
    return distance_to(solid, place).distance <= 0;
  };
  const auto on_mesh = [&](const MeshTouch* mesh) { return mesh->meets(foot, kMeeting); };
  return std::ranges::any_of(this->near(), in_solid) || std::ranges::any_of(meshes_, on_mesh);
}

// Nearest face of a solid that no other one covers; `else_`, if all are covered.
Surface SolidTouch::exposed(std::span<const Solid> solids, const Near& near, const Vec3& point,
                            const Surface& else_, Asked asked) {
  const Solid& solid = solids[near.solid];
  const Vec3 side = in_world(solid, sides_[near.solid].normal);
  const auto bare = [&](const Surface& face) { return !covered(solids, near, point, face, asked); };
  return nearest_face(solid, point, side, std::nullopt, bare).value_or(else_);
}

// Hides solids whose nearest point, seen from the free place, something else holds that is nearer.
// Two that hold the point both push if they face different ways: it is in a corner of them. What
// does not touch the probe hides nothing that does.
void SolidTouch::hide_covered(std::span<const Solid> solids) {
  const Vec3 centre = count_ > 0 ? near_[0].point : free_;
  free_ = centre;
  for (const MeshTouch* mesh : meshes_) {
    if (mesh->holds(centre)) free_ = mesh->lifted(free_, kAbove);
  }
  if (ball_) lift_out(solids, false);
  const bool lifted = free_ != centre;
  for (Near& n : nears()) n.seen = lifted ? distance_to(solids[n.solid], free_) : n.surface;
  const auto half_space = [&](const Near& n) {
    return std::holds_alternative<Plane>(solids[n.solid].shape);
  };
  const auto apart = [&](const Near& a, const Near& b) {
    if (half_space(a) && half_space(b)) return true;
    return a.inside && b.inside && a.surface.normal.dot(b.surface.normal) < kSame;
  };
  const auto place_of = [&](const Near& n) {
    return Vec3((ball_ ? free_ : n.point) - n.seen.distance * n.seen.normal);
  };
  const auto on = [&](const Near& n, const Vec3& place) {
    return distance_to(solids[n.solid], place).distance <= kMeeting;
  };
  const auto touched = [this](const Near& n) { return n.surface.distance < radius_; };
  for (Near& n : nears()) {
    if (n.seen.distance < 0) continue;
    const Vec3 place = place_of(n);
    const auto hides = [&](const Near& other) {
      const double further = n.seen.distance - other.seen.distance;
      if (further < -kTied || !other.counts || other.seen.distance < 0) return false;
      if (touched(n) && !touched(other)) return false;
      if (other.solid == n.solid || apart(n, other) || !on(other, place)) return false;
      // The first counts of two that hold each other's nearest point.
      return further > kTied || other.solid < n.solid || !on(n, place_of(other));
    };
    n.counts = std::ranges::none_of(near(), hides) &&
               !(ball_ && hidden_by_mesh(solids[n.solid], n, place));
  }
}

bool SolidTouch::hidden_by_mesh(const Solid& solid, const Near& near, const Vec3& place) const {
  return std::ranges::any_of(meshes_, [&](const MeshTouch* mesh) {
    const std::optional<Vec3> on_mesh = mesh->nearest_to(free_);
    if (!on_mesh) return false;
    const double further = near.seen.distance - (free_ - *on_mesh).norm();
    if (further < -kTied || !mesh->meets(place, kMeeting)) return false;
    return further > kTied || distance_to(solid, *on_mesh).distance > kMeeting;
  });
}

bool SolidTouch::covers(std::span<const Solid> solids, const Vec3& place, const Vec3& free) const {
  const double distance = (free - place).norm();
  return std::ranges::any_of(near(), [&](const Near& n) {
    const Solid& solid = solids[n.solid];
    return distance_to(solid, place).distance <= kMeeting &&
           distance_to(solid, free).distance <= distance + kTied;
  });
}

}  // namespace limpid
