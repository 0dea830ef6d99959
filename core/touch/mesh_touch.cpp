#include "core/touch/mesh_touch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limpid {

namespace {

// Radius of a ball for a point, as a part of the mesh's size: a hundred times the rounding of
// floats.
constexpr double kSkin = 1e-5;
constexpr double kLook = 0.01;      // distance in which the surface is searched [m]
constexpr double kAhead = 0.003;    // distance within which it may be touched in a tick [m]
constexpr double kSlipSpeed = 0.1;  // speed of the anchor beyond the centre's motion [m/s]
constexpr double kSlipFactor = 2;   // speed of the anchor, over the centre's [-]
constexpr double kSafe = 0.9;  // part of a free ball's radius within which no crossing is searched
constexpr int kRounds = 12;
constexpr int kMostLooks = 3;  // searches around a convex surface

}  // namespace

MeshTouch::MeshTouch(const Object& object, double radius)
    : MeshTouch(std::get<Mesh>(object.shape), object.pose, radius) {}

MeshTouch::MeshTouch(const Mesh& mesh, const Pose& pose, double radius)
    : Room(radius),
      shape_(mesh.triangles),
      closed_(shape_->health().closed()),
      pose_(mesh.stood(pose)),
      in_object_(mesh.stood(Pose::Identity())),
      scale_(mesh.size()),
      skin_(kSkin * shape_->radius()),
      look_(kLook / mesh.size()) {
  r_ = std::max(radius / scale_, skin_);
  tolerance_ = 1e-5 * r_ + 0.1 * skin_;
}

Vec3 MeshTouch::to_mesh(const Vec3& world) const {
  return pose_.linear().transpose() * (world - pose_.translation()) / scale_ - shape_->middle();
}

Vec3 MeshTouch::to_world(const Vec3& local) const {
  return pose_.translation() + pose_.linear() * (scale_ * (local + shape_->middle()));
}

void MeshTouch::place(const Vec3& c) {
  const Vec3 p = to_mesh(c);
  g_ = p_ = p;
  hint_ = MeshPoint::kNone;
  space_.clear();
  MeshPoint near;
  shape_->nearest(p, std::numeric_limits<float>::max(), hint_, near);
  const bool buried = closed_ && shape_->behind(p);
  if (buried || near.distance < skin_) {
    Vec3 out = near.normal;
    if (buried && near.distance > skin_) out = (near.point - p) / near.distance;
    g_ = near.point + r_ * out;
    shape_->nearest(g_, std::numeric_limits<float>::max(), near.triangle, near);
  }
  hint_ = near.triangle;
  distance_ = near.distance;
  clearance_ = (p - g_).norm() > 0 ? 0 : distance_ - r_;
  held_ = lost_ = !advance(p);
  anchor_ = to_world(g_);
  publish();
}

void MeshTouch::move(const Pose& object) {
  const Pose there = object * in_object_;
  anchor_ = there * (pose_.inverse() * anchor_);
  pose_ = there;
}

bool MeshTouch::same_surface(const MeshTouch& other) const {
  return shape_ == other.shape_ && scale_ == other.scale_ &&
         pose_.matrix() == other.pose_.matrix() && radius_ == other.radius_;
}

void MeshTouch::take_over(const MeshTouch& other) {
  g_ = other.g_, p_ = other.p_;
  distance_ = other.distance_, clearance_ = other.clearance_;
  hint_ = other.hint_;
  space_ = other.space_;
  world_ = other.world_;
  anchor_ = other.anchor_;
  near_ = other.near_, held_ = other.held_, lost_ = other.lost_;
}

void MeshTouch::follow(const Vec3& c, double T) {
  const Vec3 p = to_mesh(c);
  const double moved = (p - p_).norm();
  p_ = p;
  if (!near_ && clearance_ - moved > kAhead / scale_) {
    let_go(p, clearance_ - moved);
    anchor_ = c;
    return;
  }
  lost_ = !advance(p);
  const Vec3 goal = to_world(g_);
  const double allowed = kSlipFactor * scale_ * moved + kSlipSpeed * T;
  const double way = (goal - anchor_).norm();
  held_ = lost_ || way > allowed;
  anchor_ += way > allowed ? Vec3(allowed / way * (goal - anchor_)) : Vec3(goal - anchor_);
  publish();
}

// Sets g to the centre itself, far from the mesh.
void MeshTouch::let_go(const Vec3& p, double clearance) {
  g_ = p;
  clearance_ = clearance;
  distance_ = clearance + r_;
  space_.clear();
}

void MeshTouch::settle_at(const Vec3& g, const MeshPoint& near) {
  g_ = g;
  distance_ = near.distance;
  hint_ = near.triangle;
}

// Direction from the surface to the side of `from`.
Vec3 MeshTouch::out_of(const MeshPoint& at, const Vec3& from) const {
  const Vec3 out = from - at.point;
  const double length = out.norm();
  // Over an edge it is the direction to the ball's centre, if that is defined and on this side.
  if (length > 0.5 * skin_ && out.dot(g_ - at.point) > 0) return out / length;
  return at.normal.dot(g_ - at.point) < 0 ? Vec3(-at.normal) : at.normal;
}

// Makes the room from a place on the surface alone, seen from `from`, and finds p's place in it.
bool MeshTouch::keep_only(const MeshPoint& at, const Vec3& from, const Vec3& p, Vec3& t) {
  const Vec3 out = out_of(at, from);
  FreeSpace::Active active;
  space_.clear();
  return space_.add(out, out.dot(at.point) + r_) && space_.project(p, t, active);
}

bool MeshTouch::keep_also(const MeshPoint& at, const Vec3& out, const Vec3& p, Vec3& t) {
  FreeSpace::Active active;
  return space_.add(out, out.dot(at.point) + r_) && space_.project(p, t, active);
}

// First guess from the last tick's planes: on a flat face it is the answer, elsewhere nearly.
MeshTouch::Guess MeshTouch::guess(const Vec3& p, Vec3& t) {
  FreeSpace::Active active;
  if (!space_.project(p, t, active) || active.count == 0) return Guess::none;
  if ((t - g_).norm() > kSafe * distance_) return Guess::none;
  MeshPoint at;
  if (!shape_->nearest(t, r_ + look_, hint_, at) || at.distance < 0.5 * r_) return Guess::none;
  const bool right = space_.count() == 1 && std::abs(at.distance - r_) <= tolerance_ &&
                     (out_of(at, t) - space_.normal(0)).squaredNorm() < 1e-12;
  settle_at(t, at);
  clearance_ = 0;
  if (right) return Guess::right;
  return keep_only(at, t, p, t) ? Guess::near : Guess::none;
}

// Moves g as near to p as the surface lets it. False if that does not settle; g then stays at its
// last free place.
bool MeshTouch::advance(const Vec3& p) {
  Vec3 t = p;
  const Guess first = guess(p, t);
  if (first == Guess::right) return true;
  bool looked = first == Guess::near;  // the planes are those below t
  int looks = 0;
  if (!looked) {
    space_.clear();
    t = p;
  }
  for (int round = 0; round < kRounds; ++round) {
    MeshPoint at;
    if ((t - g_).norm() > kSafe * distance_ && shape_->crossing(g_, t, at)) {
      const Vec3 out = at.normal.dot(g_ - at.point) < 0 ? Vec3(-at.normal) : at.normal;
      if (!keep_also(at, out, p, t) && !(step_to(at, out) && keep_only(at, g_, p, t))) return false;
      continue;
    }
    if (looked) {
      if (!shape_->nearest(t, r_ - tolerance_, hint_, at)) {
        g_ = t;
        distance_ = r_ - tolerance_;
        return true;
      }
      if (!keep_also(at, out_of(at, t), p, t)) return false;
      continue;
    }
    if (!shape_->nearest(t, r_ + look_, hint_, at)) {
      if (space_.count() == 0) {
        let_go(t, look_);
        return true;
      }
      g_ = t;  // the surface ends or bends away below: go on from here
      distance_ = r_ + look_;
      space_.clear();
      t = p;
      continue;
    }
    const double gap = at.distance - r_;
    if (gap < -tolerance_) {
      if (!keep_also(at, out_of(at, t), p, t)) return false;
    } else if (space_.count() > 0 && gap > tolerance_ && looks < kMostLooks) {
      looked = ++looks == kMostLooks;
      settle_at(t, at);
      if (!keep_only(at, t, p, t)) return false;
    } else {
      settle_at(t, at);
      clearance_ = std::max(gap, 0.0);
      return space_.count() > 0 || keep_only(at, t, p, t);
    }
  }
  return false;
}

// Takes g to a ball's radius before the place at which its way ends.
bool MeshTouch::step_to(const MeshPoint& at, const Vec3& out) {
  const Vec3 before = at.point + r_ * out;
  MeshPoint other;
  if (shape_->crossing(g_, before, other)) return false;
  if (!shape_->nearest(before, r_ + look_, at.triangle, other) || other.distance < 0.1 * r_) {
    return false;
  }
  settle_at(before, other);
  return true;
}

bool MeshTouch::recoverable() const {
  if (!near_) return true;
  if (held_) return false;
  if (closed_) return true;
  return (p_ - g_).norm() < 0.5 * r_;
}

bool MeshTouch::holds(const Vec3& c) const {
  if (!near_ || held_) return false;
  for (int i = 0; i < world_.count(); ++i) {
    if (world_.normal(i).dot(c) < world_.offset(i) - r_ * scale_) return true;
  }
  return false;
}

Vec3 MeshTouch::lifted(Vec3 point, double above) const {
  for (int i = 0; i < world_.count(); ++i) {
    const double height = world_.normal(i).dot(point) - world_.offset(i) + r_ * scale_;
    if (height < above - kAbove / 2) point += (above - height) * world_.normal(i);
  }
  return point;
}

std::optional<Vec3> MeshTouch::nearest_to(const Vec3& from) const {
  MeshPoint at;
  if (!near_ || held_ || world_.count() != 1) return std::nullopt;
  if (!shape_->nearest(to_mesh(from), r_ + look_, hint_, at)) return std::nullopt;
  return to_world(at.point);
}

bool MeshTouch::meets(const Vec3& point, double within) const {
  MeshPoint at;
  return shape_->nearest(to_mesh(point), within / scale_, MeshPoint::kNone, at);
}

void MeshTouch::hide() {
  world_.clear();
  near_ = held_ = false;
}

void MeshTouch::publish() {
  world_.clear();
  for (int i = 0; i < space_.count(); ++i) {
    const Vec3 n = pose_.linear() * space_.normal(i);
    const double offset = scale_ * (space_.offset(i) + space_.normal(i).dot(shape_->middle())) +
                          n.dot(pose_.translation());
    world_.add(n, offset);
  }
  near_ = held_ || world_.count() > 0;
}

}  // namespace limpid
