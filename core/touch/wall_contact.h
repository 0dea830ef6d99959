// Contact of the arm with a plain surface, or of a joint with its stop: a wall.
#pragma once

#include <optional>

#include "core/dynamics/arm.h"
#include "core/touch/contact_row.h"

namespace limpid {

// A possible contact, linear in the configuration around x2: penetration d(x2 + dx) = depth +
// gradient . dx, torque -gradient K d where d > 0.
template <int N>
struct Contact {
  double depth = 0;                // [m], or [rad] in joint space; negative: apart
  Vec<N> gradient;                 // of the depth [m/rad] or [-]
  Material material;               // in joint space its stiffness is in [N m/rad]
  Vec3 point = Vec3::Zero();       // on the arm [m]; unused in joint space
  Vec3 normal = Vec3::Zero();      // out of the material; zero in joint space
  int link = 0;                    // index of the touching link
  std::size_t id = 0;              // constant for a scene
  int body = BodyContact::kStill;  // body with this surface
  bool touching = false;
  double force = 0;              // over the last tick [N] or [N m]
  Vec3 friction = Vec3::Zero();  // along the surface, over the last tick [N]

  // The next functions are those of every kind of contacts. First, for the midpoint step
  // (Contacts).
  static constexpr bool kRemembers = true;  // has a place among the memories: id
  const Vec3& place() const { return point; }
  template <class Visit>
  void springs(const Visit& visit) const {  // those assumed to push: depth and its gradient
    if (touching) visit(depth, gradient);
  }
  // Computes the force at the midpoint of a step with this velocity, and adds its torque. True if
  // the springs assumed to push are those that do.
  bool press(const Vec<N>& vbar, double T, Vec<N>& f2) {
    const double d = depth + 0.5 * T * gradient.dot(vbar);
    force = touching ? material.stiffness * d : 0;
    f2 -= force * gradient;
    return (d > 0) == touching;
  }
  bool reconsider(const Vec<N>& vbar, double T, bool only_let_go) {  // true: something changed
    const bool deep = depth + 0.5 * T * gradient.dot(vbar) > 0;
    if (deep == touching || (deep && only_let_go)) return false;
    touching = deep;
    return true;
  }
  Vec3 on_arm() const { return force * normal; }  // without friction [N]
  bool inside() const { return depth > 0; }
  double stored(double in_friction) const {  // [J]
    const double d = std::max(depth, 0.0);
    return 0.5 * material.stiffness * d * d + in_friction;
  }
  std::optional<ContactForce> felt() const {  // nothing: no force with a place
    if (!(force > 0) || normal.isZero(0)) return std::nullopt;
    return ContactForce{point, force * normal + friction};
  }

  // The other verbs are for the solve of all contacts (ContactSolve).
  void rest() {
    force = 0;
    friction.setZero();
  }
  double deep() const { return depth; }  // the deepest ones come first
  bool may_touch(const BodyWorld* world, const Vec<N>& u, double T) const {
    constexpr double kNear = 2e-3;  // contacts further off are left out, unless they approach [m]
    // Least lever of a contact: below it no joint can serve the contact, and its force, which moves
    // nothing, is left out with its friction [m].
    constexpr double kLeastLever = 1e-9;
    double deeper = T * gradient.dot(u);
    if (body != BodyContact::kStill) {
      deeper += T * normal.dot(world->velocity(world->end_at(body, point)));
    }
    return (depth > -kNear || depth + 2 * deeper > 0) &&
           gradient.squaredNorm() > kLeastLever * kLeastLever;
  }
  // Starts a row from the last tick's force.
  void start(ContactRow<N>& row, const Arm<N>& arm, const typename Arm<N>::Frames& f) const {
    row.flat = true;
    row.g[0] = -gradient;
    row.push.x() = row.before.push.x();
    if (body != BodyContact::kStill) row.frame = frame_of(normal);
    if (row.radius == 0 || normal.isZero(0)) return;
    row.axes = 3;
    row.frame = frame_of(normal);
    Jacobian<N> J;
    arm.point_jacobian(f, link, point, J);
    for (int i = 1; i < 3; ++i) {
      row.g[static_cast<std::size_t>(i)].noalias() = J.transpose() * row.frame.col(i);
    }
    row.friction = -friction_stiffness(material) * (row.frame.transpose() * row.before.anchor);
    row.friction.x() = 0;
  }
  // Direction in which the damper acts, in the row's axes and as a torque.
  Vec<N> damped(const ContactRow<N>& row, Vec3&) const { return row.g[0]; }
  bool apart(const ContactRow<N>& row, double T, const Vec<N>& u) const {
    const double v = row.g[0].dot(u) - row.of_body().x();
    return depth <= 0 && depth - T * v <= 0;
  }
  // Updates the force for the present motion; returns the change [N].
  double solve(ContactRow<N>& row, double T, Motion<N>& motion) const {
    const double c = T * row.W(0, 0);
    const double v = row.g[0].dot(motion.u) - row.of_body().x();
    const double a = -T * v + c * row.push.x();
    const double F = wall_force({row.material.stiffness, row.B, T, depth, a, c});
    const double change = F - row.push.x();
    row.apply(change * Vec3::UnitX(), motion);
    row.push.x() = F;
    return std::abs(change) + row.rub(T, Vec3::UnitX(), F, motion);
  }
  // The force without friction for a motion v along the row's axes, which excludes the force's
  // effect on its own body; returns the slope over v.
  Mat3 push(ContactRow<N>& row, double T, const Vec3& v, Slope) const {
    Mat3 slope = Mat3::Zero();
    const double K = row.material.stiffness, a = -T * v.x(), c = T * row.W_body(0, 0);
    WallPush F = wall_push({K, row.B, T, depth, a, 0});
    if (c > 0) {
      F.force = wall_force({K, row.B, T, depth, a, c});
      const double on_D = wall_push({K, row.B, T, depth, a - c * F.force, 0}).slope;
      F.slope = on_D / (1 + c * on_D);
    }
    row.push = F.force * Vec3::UnitX();
    slope(0, 0) = -T * F.slope;
    return slope;
  }
  // Force of the spring alone after a motion along the row's axes, relative to the body [m, N].
  Vec3 spring_after(const ContactRow<N>& row, const Vec3& moved) const {
    return row.material.stiffness * std::max(0.0, depth - moved.x()) * Vec3::UnitX();
  }
  void finish(const ContactRow<N>& row) {
    force = row.push.x();
    friction = row.frame * row.friction;
  }
};

}  // namespace limpid
