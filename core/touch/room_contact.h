// Contact of a ball of the arm with what leaves its centre a room of planes.
#pragma once

#include <optional>
#include <utility>

#include "core/dynamics/arm.h"
#include "core/touch/contact_row.h"
#include "core/touch/room_force.h"

namespace limpid {

// The nearest free x pulls the ball's centre c(x2 + dx) = center + J dx by K (x - c). Within a tick
// the free places are those of a Room, which Touch is.
template <int N, class Touch>
struct RoomContact {
  RoomContact(Touch room, const Material& of, Eigen::Index dof)
      : touch(std::move(room)), material(of), J(Jacobian<N>::Zero(3, dof)) {}

  Touch touch;
  int link = 0;        // index
  std::size_t id = 0;  // among all contacts
  int body = BodyContact::kStill;
  Material material;
  Vec3 center = Vec3::Zero();         // [m]
  Jacobian<N> J;                      // of the centre
  FreeSpace::Active active;           // planes that push
  Mat3 direction = Mat3::Identity();  // orthonormal columns along which it pushes
  int rank = 0;                       // columns used
  Vec3 depth = Vec3::Zero();          // along each column, at x2 [m]
  Vec3 force = Vec3::Zero();          // over the last tick, with friction [N]

  // Verbs of every kind of contacts; Contact says what they do.
  static constexpr bool kRemembers = true;
  const Vec3& place() const { return center; }
  template <class Visit>
  void springs(const Visit& visit) const {
    for (int i = 0; i < rank; ++i) visit(depth[i], Vec<N>(-J.transpose() * direction.col(i)));
  }
  bool press(const Vec<N>& vbar, double T, Vec<N>& f2) {
    force.setZero();
    if (!touch.near()) return true;
    const Vec3 moved = 0.5 * T * (J * vbar);
    for (int i = 0; i < rank; ++i) {
      const Vec3 e = direction.col(i);
      force += material.stiffness * (depth[i] - e.dot(moved)) * e;
    }
    if (rank > 0) f2.noalias() += J.transpose() * force;
    if (touch.held()) return true;
    FreeSpace::Active now;
    Vec3 x;
    return touch.space().project(center + moved, x, now) && now == active;
  }
  bool reconsider(const Vec<N>& vbar, double T, bool only_let_go) {
    if (!touch.near() || touch.held()) return false;
    FreeSpace::Active now;
    Vec3 x;
    touch.space().project(center + 0.5 * T * (J * vbar), x, now);
    if (now == active || (only_let_go && now.count >= active.count)) return false;
    active = now;
    aim();
    return true;
  }
  Vec3 on_arm() const { return force; }
  bool inside() const { return rank > 0; }
  double stored(double in_friction) const {
    if (!touch.near()) return 0;
    Vec3 x = touch.anchor();
    FreeSpace::Active now;
    if (!touch.held()) touch.space().project(center, x, now);
    return 0.5 * material.stiffness * (x - center).squaredNorm() + in_friction;
  }
  std::optional<ContactForce> felt() const {
    const double size = force.norm();
    if (size == 0) return std::nullopt;
    return ContactForce{touch.anchor() - touch.radius() / size * force, force};
  }

  void rest() { force.setZero(); }
  double deep() const { return depth.norm(); }
  bool may_touch(const BodyWorld*, const Vec<N>&, double) const { return touch.near(); }
  void start(ContactRow<N>& row, const Arm<N>&, const typename Arm<N>::Frames&) const {
    row.set_axes(J);
    row.push = row.before.push;
    if (row.radius > 0) row.friction = -friction_stiffness(material) * row.before.anchor;
  }
  Vec<N> damped(const ContactRow<N>& row, Vec3& along) const {
    const FreeSpace& space = touch.space();
    along = !row.push.isZero(0)              ? Vec3(row.push.normalized())
            : rank == 0 && space.count() > 0 ? space.normal(0)
                                             : Vec3(direction.col(0));
    return J.transpose() * along;
  }
  bool apart(const ContactRow<N>& row, double T, const Vec<N>& u) const {
    if (touch.held() || rank > 0) return false;
    Vec3 x;
    FreeSpace::Active by;
    return touch.space().project(center + T * (row.speed(u) - row.of_body()), x, by) &&
           by.count == 0;
  }
  double solve(ContactRow<N>& row, double T, Motion<N>& motion) const {
    const Vec3 before = row.push;
    const Vec3 a = T * (row.speed(motion.u) - row.of_body() - row.W * before);
    room_force(touch, {row.material.stiffness, row.B, T, center, a, T * row.W}, row.push);
    const Vec3 change = row.push - before;
    row.apply(change, motion);
    const double size = row.push.norm();
    const Vec3 normal = size > 0 ? Vec3(row.push / size) : Vec3::UnitX();
    return change.norm() + row.rub(T, normal, size, motion);
  }
  Mat3 push(ContactRow<N>& row, double T, const Vec3& v, Slope slope) const {
    const double K = row.material.stiffness;
    Mat3 on_D;
    if (row.world == nullptr) {
      row.push = room_push(touch, {K, row.B, T, center, T * v, Mat3::Zero()}, slope, on_D);
      return T * on_D;
    }
    room_force(touch, {K, row.B, T, center, T * v, T * row.W_body}, row.push);
    room_push(touch, {K, row.B, T, center, T * (v + row.W_body * row.push), Mat3::Zero()}, slope,
              on_D);
    return T * (Mat3::Identity() - T * on_D * row.W_body).inverse() * on_D;
  }
  Vec3 spring_after(const ContactRow<N>& row, const Vec3& moved) const {
    const Vec3 there = center + moved;
    Vec3 x = touch.anchor();
    FreeSpace::Active by;
    if (!touch.held()) touch.space().project(there, x, by);
    return row.material.stiffness * (x - there);
  }
  void finish(const ContactRow<N>& row) { force = row.push + row.friction; }

  // Computes the directions of the planes that push, and the centre's depth along them.
  void aim() {
    const FreeSpace& space = touch.space();
    rank = space.basis(active, direction);
    depth = direction.transpose() * (space.onto(center, active) - center);
  }
};

}  // namespace limpid
