#include "core/touch/solid_touch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace limpid {
namespace {

// Distance beyond which nothing touches within a tick [m].
constexpr double kReach = 0.02;
// Cosines: of normals that are the same, of one that faces the other way, and of one that is
// opposite.
constexpr double kSame = 0.99, kAway = -0.5, kOpposite = -0.99;
constexpr double kBeside = 5 * kAbove;  // distance from the free place of what is level [m]
// Way of the free place in a tick beside bodies, beyond the probe's own [m].
constexpr double kLeap = 5e-3;
constexpr double kSoon = 2e-3;  // distance within which a tick may make a contact [m]
constexpr int kRounds = 12;     // in which the free place follows the probe
constexpr int kLifts = 2;       // rounds of lifting out of several things

Surface distance_to(const Solid& solid, const Vec3& point) {
  return std::visit(
      [&](const auto& shape) { return limpid::distance_to(shape, solid.pose, point); },
      solid.shape);
}

Vec3 nearest_on(const Solid& solid, const Vec3& from, const Vec3& to) {
  return std::visit(
      [&](const auto& shape) { return nearest_on_segment(shape, solid.pose, from, to); },
      solid.shape);
}

bool half_space(const Solid& solid) { return std::holds_alternative<Plane>(solid.shape); }

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
  Surface same = plane_at(solid, side, point);
  if (nearest.distance >= 0) return same;
  return *nearest_face(solid, point, side, same, [](const Surface&) { return true; });
}

}  // namespace

// The half spaces that stop the free place.
class SolidTouch::Stops {
 public:
  // False if there is no place for another one.
  bool add(const Stop& stop) {
    const auto i = static_cast<std::size_t>(space_.count());
    if (!space_.add(stop.normal, stop.offset)) return false;
    of_[i] = stop.near;
    return true;
  }
  int count() const { return space_.count(); }
  Stop operator[](int i) const {
    return {of_[static_cast<std::size_t>(i)], space_.normal(i), space_.offset(i)};
  }
  Stops of_solids() const {
    Stops out;
    for (int i = 0; i < count(); ++i) {
      if ((*this)[i].near != nullptr) out.add((*this)[i]);
    }
    return out;
  }
  bool has(const Near& near) const {
    const auto* end = of_.begin() + count();
    return std::find(of_.begin(), end, &near) != end;
  }
  // Finds the place nearest to `from`. False if they leave none.
  bool project(const Vec3& from, Vec3& place) { return space_.project(from, place, active_); }
  // True if the place of the last project() is at a solid.
  bool at(const Near& near) const {
    for (int i = 0; i < active_.count; ++i) {
      const auto plane = static_cast<std::size_t>(active_.plane[static_cast<std::size_t>(i)]);
      if (of_[plane] == &near) return true;
    }
    return false;
  }

 private:
  FreeSpace space_;
  std::array<const Near*, FreeSpace::kMostPlanes> of_{};
  FreeSpace::Active active_;
};

void SolidTouch::forget() {
  std::ranges::fill(sides_, Side{});
  known_ = false;
  recoverable_ = true;
}

void SolidTouch::look(std::span<const Solid> solids, const Vec3& from, const Vec3& to) {
  moved_ = known_ ? (from - from_).norm() : 0;
  from_ = from;
  along_ = to - from;
  if (!known_) place_ = from;
  known_ = true;
  const double off = place_ == from ? 0 : (place_ - from).norm();
  count_ = 0;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    Near& n = near_[count_];
    n.point = from == to ? from : nearest_on(solids[i], from, to);
    n.surface = distance_to(solids[i], n.point);
    if (!(radius_ - n.surface.distance + off > -kReach)) {
      sides_[i] = {};
      continue;
    }
    n.solid = i;
    n.counts = true;
    ++count_;
  }
}

std::span<const SolidTouch::Near> SolidTouch::settle(std::span<const Solid> solids) {
  recoverable_ = true;
  const bool settled = alone(solids) || hold_together(solids);
  if (count_ > 1 && settled) hide_covered(solids);
  if (!meshes_.empty() && along_.isZero(0)) hide_in_meshes(solids);
  for (const Near& n : near()) {
    sides_[n.solid] = {remembered(solids[n.solid], n.surface.normal), n.counts, n.counts && n.holds,
                       n.counts && n.surface.distance < 0};
  }
  return near();
}

Vec3 SolidTouch::lifted(std::span<const Solid> solids, Vec3 point, bool whole) const {
  const double out = whole ? radius_ : 0;
  for (const Near& n : near()) {
    const Side& side = sides_[n.solid];
    if (!(whole ? side.counts : side.deep)) continue;
    const Solid& solid = solids[n.solid];
    const Surface s = plane_at(solid, in_world(solid, side.normal), point);
    if (s.distance < out + kAbove / 2) point += (out + kAbove - s.distance) * s.normal;
  }
  return point;
}

// Takes from each solid the surface nearest to the probe, of those on its side. True if no more
// than one of them holds the probe, and the place to which that one leads it is free.
bool SolidTouch::alone(std::span<const Solid> solids) {
  const Near* holder = nullptr;
  bool several = false, same = true;
  for (Near& n : nears()) {
    const Solid& solid = solids[n.solid];
    const Vec3 nearest = n.surface.normal;
    n.surface = on_side(solid, n.point, n.surface, in_world(solid, sides_[n.solid].normal));
    same = same && n.surface.normal.dot(nearest) > kSame;
    n.holds = n.surface.distance < radius_;
    if (!n.holds) continue;
    several = several || holder != nullptr;
    holder = &n;
  }
  if (several) return false;
  Vec3 place = from_;
  if (holder != nullptr) {
    place += (radius_ + kAbove - holder->surface.distance) * holder->surface.normal;
  }
  const auto is_free = [&] {
    Stops own;
    if (holder != nullptr) {
      own.add({holder, holder->surface.normal, 0});
      const Vec3 foot = holder->point - holder->surface.distance * holder->surface.normal;
      const auto on_mesh = [&](const MeshTouch* mesh) { return mesh->meets(foot, kMeeting); };
      if (turned(solids, *holder) && std::ranges::any_of(meshes_, on_mesh)) return false;
    }
    return !blocker(solids, place, own);
  };
  if (count_ + meshes_.size() > 1 && !is_free()) return false;
  place_ = place;
  recoverable_ = same;
  if (holder == nullptr || count_ == 1) return true;
  for (Near& n : nears()) {
    if (!n.holds) face(solids, n);
  }
  return true;
}

// True if a solid's surface is not the one at which the probe was.
bool SolidTouch::turned(std::span<const Solid> solids, const Near& near) const {
  const Vec3 side = in_world(solids[near.solid], sides_[near.solid].normal);
  return !side.isZero(0) && side.dot(near.surface.normal) <= kSame;
}

// Takes from a solid the surface that faces the free place. It counts unless the probe is in it.
void SolidTouch::face(std::span<const Solid> solids, Near& near) const {
  Vec3 point;
  near.surface = see(solids, near, point);
  near.surface.distance += near.surface.normal.dot(near.point - point);
  near.counts = near.surface.distance >= radius_;
}

// Takes from each solid the surface that faces the free place. Those at which it is hold the probe,
// or, if they leave it no place, all that stop it; what else the probe is in is covered. False if
// there is no place.
bool SolidTouch::hold_together(std::span<const Solid> solids) {
  Stops all;
  const bool followed = follow(solids, all);
  Stops stops = all.of_solids();
  Vec3 place;
  const bool squeezed = !stops.project(from_, place) || !followed;
  // Half spaces among themselves have no ends: the probe meets each when it is in it.
  const bool ends = std::ranges::any_of(
      near(), [&](const Near& n) { return stops.at(n) && !half_space(solids[n.solid]); });
  for (Near& n : nears()) {
    face(solids, n);
    if (squeezed || !ends) {
      n.holds = !n.counts && (stops.has(n) || half_space(solids[n.solid]));
    } else {
      n.holds = stops.at(n);
    }
    if (!n.holds) continue;
    n.counts = true;
    const Surface nearest = distance_to(solids[n.solid], n.point);
    recoverable_ = recoverable_ && n.surface.normal.dot(nearest.normal) > kSame;
  }
  return !squeezed;
}

// Hides solids that the probe may touch soon, if something nearer to the free place holds their
// point nearest to it. The first counts of two that hold each other's.
void SolidTouch::hide_covered(std::span<const Solid> solids) {
  struct Seen {
    double distance;  // from the free place [m]
    Vec3 foot;
  };
  const auto seen = [&](const Near& n) {
    const Vec3 point = point_at(solids[n.solid], place_);
    const Surface surface = distance_to(solids[n.solid], point);
    return Seen{surface.distance, point - surface.distance * surface.normal};
  };
  const auto on = [&](const Near& n, const Vec3& place) {
    return distance_to(solids[n.solid], place).distance <= kMeeting;
  };
  const double soon = radius_ + kSoon + (place_ - from_).norm();
  for (Near& n : nears()) {
    if (n.holds || !n.counts || n.surface.distance > soon) continue;
    const Seen own = seen(n);
    if (own.distance < 0 || !(own.distance < radius_ + kSoon)) continue;
    const auto hides = [&](const Near& other) {
      if (&other == &n || !other.counts || !on(other, own.foot)) return false;
      if (half_space(solids[n.solid]) && half_space(solids[other.solid])) return false;
      const Seen its = seen(other);
      if (other.holds || its.distance < own.distance - kTied) return true;
      if (its.distance >= own.distance + kTied) return false;
      return other.solid < n.solid || !on(n, its.foot);
    };
    n.counts = std::ranges::none_of(near(), hides);
  }
}

// Takes the free place as near to the probe as it gets. False if what is around leaves none.
bool SolidTouch::follow(std::span<const Solid> solids, Stops& stops) {
  for (const Near& n : near()) {
    if (sides_[n.solid].holds && !stops.add(stop_by(solids, n))) return false;
  }
  bool from_here = false;  // the stops are those seen from the free place
  for (int round = 0; round < kRounds; ++round) {
    Vec3 place;
    if (!stops.project(from_, place) || leaps(solids, place, stops)) return false;
    if (const std::optional<Stop> next = blocker(solids, place, stops)) {
      if (!stops.add(*next)) return false;
      continue;
    }
    const bool still = from_here && (place - place_).norm() < kTied;
    place_ = place;
    if (still) break;
    Stops seen;
    const auto take = [&](const Stop& stop) {
      return !(stop.normal.dot(from_) < stop.offset) || seen.add(stop);
    };
    for (int i = 0; i < stops.count(); ++i) {
      if (!take(stops[i].near != nullptr ? stop_by(solids, *stops[i].near) : stops[i]))
        return false;
    }
    for (const Near& n : near()) {  // what a surface goes on in beyond its edge
      if (stops.has(n) || distance(solids[n.solid], place_) > radius_ + kBeside) continue;
      if (!take(stop_by(solids, n))) return false;
    }
    stops = seen;
    from_here = true;
  }
  return true;
}

// True if the free place would leave the gap between a body and something else by its far end: the
// two squeeze the probe.
bool SolidTouch::leaps(std::span<const Solid> solids, const Vec3& place, const Stops& stops) const {
  if ((place - place_).norm() < kLeap + 2 * moved_) return false;
  for (int i = 0; i < stops.count(); ++i) {
    if (stops[i].near && solids[stops[i].near->solid].body != BodyContact::kStill) return true;
  }
  return false;
}

// Point of the probe nearest to a solid, if its first end is at a place.
Vec3 SolidTouch::point_at(const Solid& solid, const Vec3& place) const {
  return along_.isZero(0) ? place : nearest_on(solid, place, place + along_);
}

double SolidTouch::distance(const Solid& solid, const Vec3& place) const {
  return distance_to(solid, point_at(solid, place)).distance;
}

// True if a solid at this distance from a place is in the way from the free place to there.
bool SolidTouch::crossed(const Solid& solid, const Vec3& place, double distance) const {
  if (!along_.isZero(0)) return false;
  const double way = (place - place_).norm();
  if (distance_to(solid, place_).distance + distance > 2 * radius_ + way) return false;
  const Vec3 nearest = nearest_on(solid, place_, place);
  return distance_to(solid, nearest).distance < radius_ + kAbove / 4;
}

// Finds a thing that the probe would be in at a place, or on its way there, beside those that stop
// it already: the deepest solid around it, or a mesh.
std::optional<SolidTouch::Stop> SolidTouch::blocker(std::span<const Solid> solids,
                                                    const Vec3& place, const Stops& stops) const {
  const Near* deepest = nullptr;
  double least = radius_ + kAbove / 2;
  const double way = (place - place_).norm() + (place - from_).norm();
  for (const Near& n : near()) {
    if (n.surface.distance > least + way || stops.has(n)) continue;
    const Solid& solid = solids[n.solid];
    double d = distance(solid, place);
    if (d >= radius_ + kAbove / 2 && crossed(solid, place, d)) d = radius_;
    if (!(d < least)) continue;
    least = d;
    deepest = &n;
  }
  if (deepest != nullptr) return stop_by(solids, *deepest);
  for (const MeshTouch* mesh : meshes_) {
    if (!mesh->near() || mesh->held()) continue;
    const FreeSpace& room = mesh->space();
    for (int i = 0; i < room.count(); ++i) {
      if (room.normal(i).dot(place) >= room.offset(i)) continue;
      return Stop{nullptr, room.normal(i), room.offset(i) + kAbove};
    }
  }
  return std::nullopt;
}

// Surface of a solid that faces the free place, and the point of the probe nearest to it there.
Surface SolidTouch::see(std::span<const Solid> solids, const Near& near, Vec3& point) const {
  const Solid& solid = solids[near.solid];
  point = point_at(solid, place_);
  const Surface nearest = distance_to(solid, point);
  const Vec3 side = in_world(solid, sides_[near.solid].normal);
  if (nearest.distance >= 0) return on_side(solid, point, nearest, side);
  // The solid has moved over the place, or it is where all begins.
  return side.isZero(0) ? exposed(solids, near, point, nearest) : plane_at(solid, side, point);
}

SolidTouch::Stop SolidTouch::stop_by(std::span<const Solid> solids, const Near& near) const {
  Vec3 point;
  const Surface s = see(solids, near, point);
  return {&near, s.normal, s.normal.dot(place_) - s.distance + radius_ + kAbove};
}

// Nearest face of a solid around a point that nothing else covers, if there is one.
Surface SolidTouch::exposed(std::span<const Solid> solids, const Near& near, const Vec3& point,
                            const Surface& nearest) const {
  const auto bare = [&](const Surface& face) {
    const Vec3 foot = point - face.distance * face.normal;
    const auto in_solid = [&](const Near& other) {
      const Vec3 over = foot + kMeeting * face.normal;
      return other.solid != near.solid && distance_to(solids[other.solid], over).distance <= 0;
    };
    const auto on_mesh = [&](const MeshTouch* mesh) { return mesh->meets(foot, kMeeting); };
    return std::ranges::none_of(this->near(), in_solid) && std::ranges::none_of(meshes_, on_mesh);
  };
  return nearest_face(solids[near.solid], point, Vec3::Zero(), std::nullopt, bare)
      .value_or(nearest);
}

// Hides solids whose nearest point, seen from outside of all that holds the ball's centre, a mesh
// holds that is nearer.
void SolidTouch::hide_in_meshes(std::span<const Solid> solids) {
  Vec3 free = from_;
  for (const MeshTouch* mesh : meshes_) {
    if (mesh->holds(from_)) free = mesh->lifted(free, kAbove);
  }
  for (int round = 0; round < kLifts; ++round) {
    for (const Near& n : near()) {
      const double distance = n.surface.distance + n.surface.normal.dot(free - n.point);
      if (n.counts && n.surface.distance < 0 && distance < kAbove / 2) {
        free += (kAbove - distance) * n.surface.normal;
      }
    }
  }
  for (Near& n : nears()) n.counts = n.counts && !hidden_by_mesh(solids[n.solid], free);
}

bool SolidTouch::hidden_by_mesh(const Solid& solid, const Vec3& free) const {
  const Surface seen = distance_to(solid, free);
  if (seen.distance < 0) return false;
  const Vec3 place = free - seen.distance * seen.normal;
  return std::ranges::any_of(meshes_, [&](const MeshTouch* mesh) {
    const std::optional<Vec3> on_mesh = mesh->nearest_to(free);
    if (!on_mesh) return false;
    const double further = seen.distance - (free - *on_mesh).norm();
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
