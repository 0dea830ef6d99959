#include "core/dynamics/regressor.h"

namespace limpid {
namespace {

Mat3 cross(const Vec3& a) {
  Mat3 A;
  A << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return A;
}

// I w = product(w) (I_xx, I_xy, I_xz, I_yy, I_yz, I_zz).
Eigen::Matrix<double, 3, 6> product(const Vec3& w) {
  Eigen::Matrix<double, 3, 6> P;
  P << w.x(), w.y(), w.z(), 0, 0, 0,  //
      0, w.x(), 0, w.y(), w.z(), 0,   //
      0, 0, w.x(), 0, w.y(), w.z();
  return P;
}

}  // namespace

LinkParameters parameters_of(const Link& link) {
  const Mat3 about_origin = link.inertia + link.mass * (link.com.squaredNorm() * Mat3::Identity() -
                                                        link.com * link.com.transpose());
  LinkParameters out;
  out << link.mass, link.mass * link.com, about_origin(0, 0), about_origin(0, 1),
      about_origin(0, 2), about_origin(1, 1), about_origin(1, 2), about_origin(2, 2);
  return out;
}

Eigen::VectorXd parameters_of(const ArmDescription& arm) {
  Eigen::VectorXd all(kLinkParameters * arm.dof());
  for (Eigen::Index i = 0; i < arm.dof(); ++i) {
    all.segment<kLinkParameters>(kLinkParameters * i) =
        parameters_of(arm.links[static_cast<std::size_t>(i)]);
  }
  return all;
}

void set_parameters(Link& link, const LinkParameters& p) {
  link.mass = p[0];
  link.com = p.segment<3>(1) / link.mass;
  link.inertia << p[4], p[5], p[6], p[5], p[7], p[8], p[6], p[8], p[9];
  link.inertia -=
      link.mass * (link.com.squaredNorm() * Mat3::Identity() - link.com * link.com.transpose());
}

// Newton's and Euler's equations for each link, outward; its force and moment act on all joints
// before it.
Eigen::MatrixXd regressor(const Arm<kAnyDof>& arm, const Vec<kAnyDof>& x, const Vec<kAnyDof>& v,
                          const Vec<kAnyDof>& a, const Vec3& gravity) {
  const auto n = static_cast<Eigen::Index>(arm.dof());
  Arm<kAnyDof>::Frames f;
  arm.frames(x, f);
  Eigen::MatrixXd Y = Eigen::MatrixXd::Zero(n, kLinkParameters * n);
  // Velocity and acceleration of the link's point at O. Gravity is the base's acceleration upward.
  Vec3 w = Vec3::Zero(), u = Vec3::Zero(), wdot = Vec3::Zero(), udot = -gravity;
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto J = static_cast<std::size_t>(j);
    w += v[j] * f.a[J];
    u += v[j] * f.o[J];
    wdot += a[j] * f.a[J] + v[j] * w.cross(f.a[J]);
    udot += a[j] * f.o[J] + v[j] * (u.cross(f.a[J]) + w.cross(f.o[J]));
    const Mat3& R = f.R[J];
    const Vec3 origin = R.transpose() * (udot + wdot.cross(f.p[J]) + w.cross(u + w.cross(f.p[J])));
    const Vec3 rate = R.transpose() * w, turning = R.transpose() * wdot;
    Eigen::Matrix<double, 3, kLinkParameters> force,
        moment;  // in the link's axes, about its origin
    force << origin, cross(turning) + cross(rate) * cross(rate),
        Eigen::Matrix<double, 3, 6>::Zero();
    moment << Vec3::Zero(), -cross(origin), product(turning) + cross(rate) * product(rate);
    const Eigen::Matrix<double, 3, kLinkParameters> push = R * force;
    const Eigen::Matrix<double, 3, kLinkParameters> twist = R * moment + cross(f.p[J]) * push;
    for (Eigen::Index i = 0; i <= j; ++i) {
      const auto I = static_cast<std::size_t>(i);
      Y.block<1, kLinkParameters>(i, kLinkParameters * j) =
          f.a[I].transpose() * twist + f.o[I].transpose() * push;
    }
  }
  return Y;
}

}  // namespace limpid
