// Hold of the tip's magnet on a body over a tick: a spring from the tip to a point of the body.
#pragma once

#include <limits>
#include <optional>

#include "core/dynamics/arm.h"
#include "core/touch/contact_row.h"

namespace limpid {

template <int N>
struct MagnetContact {
  int body = BodyContact::kStill;  // none: the magnet holds nothing
  Vec3 at = Vec3::Zero();          // the body's point [m]
  Vec3 stretch = Vec3::Zero();     // stretch of the spring: from `at` to the tip [m]
  Material material;
  Jacobian<N> J;              // of the tip
  Vec3 force = Vec3::Zero();  // on the tip, over the last tick [N]

  bool on() const { return body != BodyContact::kStill; }

  // Verbs of every kind of contacts; Contact says what they do.
  static constexpr bool kRemembers = false;
  const Vec3& place() const { return at; }
  template <class Visit>
  void springs(const Visit& visit) const {
    for (int i = 0; on() && i < 3; ++i) visit(stretch[i], Vec<N>(J.row(i).transpose()));
  }
  bool press(const Vec<N>& vbar, double T, Vec<N>& f2) {
    if (!on()) return true;
    force = -material.stiffness * (stretch + 0.5 * T * (J * vbar));
    f2.noalias() += J.transpose() * force;
    return true;
  }
  bool reconsider(const Vec<N>&, double, bool) { return false; }
  Vec3 on_arm() const { return force; }
  bool inside() const { return on(); }
  double stored(double) const {
    return on() ? 0.5 * material.stiffness * stretch.squaredNorm() : 0.0;
  }
  std::optional<ContactForce> felt() const { return std::nullopt; }

  void rest() { force.setZero(); }
  double deep() const { return std::numeric_limits<double>::infinity(); }  // is never displaced
  bool may_touch(const BodyWorld*, const Vec<N>&, double) const { return on(); }
  void start(ContactRow<N>& row, const Arm<N>&, const typename Arm<N>::Frames&) const {
    row.set_axes(J);
    row.push = row.world->magnet().force;
  }
  Vec<N> damped(const ContactRow<N>& row, Vec3& along) const {
    if (stretch.isZero(0)) return row.g[0];
    along = stretch.normalized();
    return J.transpose() * along;
  }
  bool apart(const ContactRow<N>&, double, const Vec<N>&) const { return false; }
  // The force f = -(K x + (K T/2 + B) v): spring and damper at the middle of the tick.
  double solve(ContactRow<N>& row, double T, Motion<N>& motion) const {
    const Vec3 before = row.push;
    const Vec3 v0 = row.speed(motion.u) - row.of_body() - row.W * before;
    const double K = row.material.stiffness, k = K * T / 2 + row.B;
    const Mat3 stiff = Mat3::Identity() + k * row.W;
    row.push = -(stiff.inverse() * (K * stretch + k * v0));
    const Vec3 change = row.push - before;
    row.apply(change, motion);
    return change.norm();
  }
  Mat3 push(ContactRow<N>& row, double T, const Vec3& v, Slope) const {
    const double K = row.material.stiffness, k = K * T / 2 + row.B;
    Mat3 slope = -k * (Mat3::Identity() + k * row.W_body).inverse();
    row.push = slope / k * (K * stretch + k * v);
    return slope;
  }
  Vec3 spring_after(const ContactRow<N>& row, const Vec3& moved) const {
    return -row.material.stiffness * (stretch + moved);
  }
  void finish(const ContactRow<N>& row) {
    force = row.push;
    row.world->pulled(row.push);
  }
};

}  // namespace limpid
