#include "core/dynamics/arm.h"

#include <cmath>

namespace limpid {
namespace {

Mat3 cross_matrix(const Vec3& w) {
  Mat3 K;
  K << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return K;
}

}  // namespace

template <int N>
Arm<N>::Arm(const ArmDescription& description) : dof_(description.dof()) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(dof_); ++i) {
    const Joint& joint = description.joints[i];
    const Mat3 K = cross_matrix(joint.axis);
    JointModel& model = joints_[i];
    model.R0 = joint.origin.linear();
    model.Rs = model.R0 * K;
    model.Rc = model.Rs * K;
    model.offset = joint.origin.translation();
    model.axis = joint.axis;
    mass_[i] = description.links[i].mass;
    com_[i] = description.links[i].com;
    inertia_[i] = description.links[i].inertia;
  }
  tip_ = description.tip.translation();
}

template <int N>
void Arm<N>::frames(const Vec<N>& x, Frames& f) const {
  for (std::size_t i = 0; i < static_cast<std::size_t>(dof_); ++i) {
    const JointModel& joint = joints_[i];
    const double q = x[static_cast<Eigen::Index>(i)];
    const Mat3 local = joint.R0 + std::sin(q) * joint.Rs + (1 - std::cos(q)) * joint.Rc;
    if (i == 0) {
      f.R[0] = local;
      f.p[0] = joint.offset;
    } else {
      f.R[i].noalias() = f.R[i - 1] * local;
      f.p[i] = f.p[i - 1] + f.R[i - 1] * joint.offset;
    }
    f.a[i].noalias() = f.R[i] * joint.axis;
    f.o[i] = f.p[i].cross(f.a[i]);
  }
}

template <int N>
typename Arm<N>::Body Arm<N>::body(const Frames& f, std::size_t i) const {
  Body b;
  const Vec3 c = f.p[i] + f.R[i] * com_[i];
  b.m = mass_[i];
  b.mc = b.m * c;
  // Parallel axes: I_O = R I_c R^T + m (c.c 1 - c c^T).
  const Mat3 RI = f.R[i] * inertia_[i];
  b.I.noalias() = RI * f.R[i].transpose();
  b.I.noalias() -= b.mc * c.transpose();
  b.I.diagonal().array() += b.mc.dot(c);
  return b;
}

template <int N>
void Arm<N>::inertia(const Frames& f, Mat<N>& M) const {
  M.resize(dof_, dof_);
  Body sum{0, Vec3::Zero(), Mat3::Zero(), Mat3::Zero(), Vec3::Zero()};
  for (int j = dof_ - 1; j >= 0; --j) {
    const auto J = static_cast<std::size_t>(j);
    const Body b = body(f, J);
    sum.m += b.m;
    sum.mc += b.mc;
    sum.I += b.I;
    const Vec3 moment = sum.I * f.a[J] + sum.mc.cross(f.o[J]);
    const Vec3 force = sum.m * f.o[J] - sum.mc.cross(f.a[J]);
    for (int i = 0; i <= j; ++i) {
      const auto I = static_cast<std::size_t>(i);
      M(i, j) = M(j, i) = f.a[I].dot(moment) + f.o[I].dot(force);
    }
  }
}

template <int N>
void Arm<N>::inertia_coriolis(const Frames& f, const Vec<N>& v, Mat<N>& M, Mat<N>& C) const {
  M.resize(dof_, dof_);
  C.resize(dof_, dof_);
  const auto n = static_cast<std::size_t>(dof_);
  // Outward: the axes' rates Sdot_j = V_j x S_j, V_j the velocity of link j.
  std::array<Vec3, kCapacity<N>> w, u, adot, odot;
  for (std::size_t j = 0; j < n; ++j) {
    const double rate = v[static_cast<Eigen::Index>(j)];
    w[j] = rate * f.a[j];
    u[j] = rate * f.o[j];
    if (j > 0) {
      w[j] += w[j - 1];
      u[j] += u[j - 1];
    }
    adot[j] = w[j].cross(f.a[j]);
    odot[j] = u[j].cross(f.a[j]) + w[j].cross(f.o[j]);
  }
  // Inward: composite bodies, one column and one row of M and C each.
  Body sum{0, Vec3::Zero(), Mat3::Zero(), Mat3::Zero(), Vec3::Zero()};
  for (std::size_t j = n; j-- > 0;) {
    const Body b = body(f, j);
    const Vec3 h = b.m * u[j] - b.mc.cross(w[j]);
    const Vec3 L = b.I * w[j] + b.mc.cross(u[j]);  // angular momentum about O
    // B11 = 1/2 ( [w] I - I [w] - [L] + m c-terms ); with U = [u]: -( U [mc] + [mc] U ) / 2.
    const Mat3 W = cross_matrix(w[j]);
    const Mat3 U = cross_matrix(u[j]);
    const Mat3 K = cross_matrix(b.mc);
    const Mat3 WI = W * b.I;
    const Mat3 UK = U * K;
    sum.B11 += 0.5 * (WI + WI.transpose() - cross_matrix(L) - UK - UK.transpose());
    sum.m += b.m;
    sum.mc += b.mc;
    sum.I += b.I;
    sum.h += h;

    const Vec3& a = f.a[j];
    const Vec3& o = f.o[j];
    const Vec3 moment = sum.I * a + sum.mc.cross(o);
    const Vec3 force = sum.m * o - sum.mc.cross(a);
    const Vec3 moment_dot = sum.I * adot[j] + sum.mc.cross(odot[j]) + sum.B11 * a;
    const Vec3 force_dot = sum.m * odot[j] - sum.mc.cross(adot[j]) - sum.h.cross(a);
    const Vec3 transposed = sum.B11.transpose() * a + sum.h.cross(o);
    const auto col = static_cast<Eigen::Index>(j);
    for (std::size_t i = 0; i <= j; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      M(row, col) = M(col, row) = f.a[i].dot(moment) + f.o[i].dot(force);
      C(row, col) = f.a[i].dot(moment_dot) + f.o[i].dot(force_dot);
      if (i != j) {
        C(col, row) = adot[i].dot(moment) + odot[i].dot(force) + f.a[i].dot(transposed);
      }
    }
  }
}

template <int N>
void Arm<N>::inertia_bias(const Frames& f, const Vec<N>& v, Mat<N>& M, Vec<N>& Cv) const {
  M.resize(dof_, dof_);
  Cv.resize(dof_);
  const auto n = static_cast<std::size_t>(dof_);
  // Velocity (w, u) and velocity-product acceleration (wdot, udot) of each link.
  std::array<Vec3, kCapacity<N>> w, u, wdot, udot;
  Vec3 w_sum = Vec3::Zero(), u_sum = Vec3::Zero(), wdot_sum = w_sum, udot_sum = w_sum;
  for (std::size_t j = 0; j < n; ++j) {
    const double rate = v[static_cast<Eigen::Index>(j)];
    w_sum += rate * f.a[j];
    u_sum += rate * f.o[j];
    wdot_sum += rate * w_sum.cross(f.a[j]);
    udot_sum += rate * (u_sum.cross(f.a[j]) + w_sum.cross(f.o[j]));
    w[j] = w_sum;
    u[j] = u_sum;
    wdot[j] = wdot_sum;
    udot[j] = udot_sum;
  }
  Body sum{0, Vec3::Zero(), Mat3::Zero(), Mat3::Zero(), Vec3::Zero()};
  Vec3 moment_bias = Vec3::Zero(), force_bias = Vec3::Zero();
  for (std::size_t j = n; j-- > 0;) {
    const Body b = body(f, j);
    const Vec3 h = b.m * u[j] - b.mc.cross(w[j]);
    const Vec3 L = b.I * w[j] + b.mc.cross(u[j]);
    moment_bias += b.I * wdot[j] + b.mc.cross(udot[j]) + w[j].cross(L) + u[j].cross(h);
    force_bias += b.m * udot[j] - b.mc.cross(wdot[j]) + w[j].cross(h);
    sum.m += b.m;
    sum.mc += b.mc;
    sum.I += b.I;
    const Vec3 moment = sum.I * f.a[j] + sum.mc.cross(f.o[j]);
    const Vec3 force = sum.m * f.o[j] - sum.mc.cross(f.a[j]);
    const auto col = static_cast<Eigen::Index>(j);
    Cv[col] = f.a[j].dot(moment_bias) + f.o[j].dot(force_bias);
    for (std::size_t i = 0; i <= j; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      M(row, col) = M(col, row) = f.a[i].dot(moment) + f.o[i].dot(force);
    }
  }
}

template <int N>
void Arm<N>::point_jacobian(const Frames& f, int link, const Vec3& world, Jacobian<N>& J) const {
  J.resize(3, dof_);
  for (int j = 0; j < dof_; ++j) {
    const auto i = static_cast<std::size_t>(j);
    if (j <= link) {
      J.col(j) = f.a[i].cross(world) + f.o[i];
    } else {
      J.col(j).setZero();
    }
  }
}

template class Arm<3>;
template class Arm<kAnyDof>;

Eigen::VectorXd rest_pose(const ArmDescription& arm) {
  Eigen::VectorXd x(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) {
    const Joint& joint = arm.joints[static_cast<std::size_t>(i)];
    const bool limited = std::isfinite(joint.lower) && std::isfinite(joint.upper);
    x[i] = limited ? (joint.lower + joint.upper) / 2 : 0;
  }
  return x;
}

}  // namespace limpid
