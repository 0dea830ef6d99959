#include "core/dynamics/arm.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace limpid {
template <int N>
Arm<N>::Arm(const ArmDescription& description) : dof_(description.dof()) {
  for (std::size_t i = 0; i < size(); ++i) {
    joints_[i] = model(description.joints[i]);
    const Link& link = description.links[i];
    const Eigen::SelfAdjointEigenSolver<Mat3> principal(link.inertia);
    const Vec3& moments = principal.eigenvalues();  // smallest first
    const Mat3& axes = principal.eigenvectors();
    links_[i] = {link.mass, link.com, moments[0], std::sqrt(moments[1] - moments[0]) * axes.col(1),
                 std::sqrt(moments[2] - moments[0]) * axes.col(2)};
  }
  tip_ = description.tip.translation();
}

template <int N>
typename Arm<N>::JointModel Arm<N>::model(const Joint& joint) {
  JointModel m{};
  m.R0 = joint.origin.linear();
  m.offset = joint.origin.translation();
  joint.axis.cwiseAbs().maxCoeff(&m.third);
  m.first = (m.third + 1) % 3;
  m.second = (m.third + 2) % 3;
  m.sign = joint.axis[m.third] < 0 ? -1 : 1;
  m.oblique = joint.axis != m.sign * Vec3::Unit(m.third);
  if (m.oblique) {
    Mat3 Q;
    Q.col(m.third) = m.sign * joint.axis;
    Q.col(m.first) = Q.col(m.third).unitOrthogonal();
    Q.col(m.second) = Q.col(m.third).cross(Q.col(m.first));
    m.R0 = m.R0 * Q;
    m.back = Q.transpose();
  }
  m.shifted = !m.R0.isIdentity(0);
  m.slides = joint.kind == Joint::Kind::prismatic;
  return m;
}

template <int N>
typename Arm<N>::Angles Arm<N>::angles(const Vec<N>& x) const {
  Angles a{x, x};
  for (std::size_t i = 0; i < size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double angle = x[k], sin = std::sin(angle), cos = std::cos(angle);
    a.sin[k] = joints_[i].slides ? angle : sin;
    a.cos[k] = cos;
  }
  return a;
}

template <int N>
typename Arm<N>::Angles Arm<N>::turned(const Angles& a, const Vec<N>& dx) const {
  constexpr double kSmall = 0.03;  // [rad]; the series below are exact to round-off there
  Angles b = a;
  for (Eigen::Index i = 0; i < dx.size(); ++i) {
    const double d = dx[i], d2 = d * d;
    const bool small = std::abs(d) < kSmall;
    const double s = small ? d * (1 - d2 / 6 * (1 - d2 / 20 * (1 - d2 / 42))) : std::sin(d);
    const double c =
        small ? 1 - d2 / 2 * (1 - d2 / 12 * (1 - d2 / 30 * (1 - d2 / 56))) : std::cos(d);
    b.sin[i] = a.sin[i] * c + a.cos[i] * s;
    b.cos[i] = a.cos[i] * c - a.sin[i] * s;
    if (joints_[static_cast<std::size_t>(i)].slides) b.sin[i] = a.sin[i] + d;
  }
  return b;
}

template <int N>
void Arm<N>::inertia(const Frames& f, Mat<N>& M) const {
  Bodies<double> bodies;
  inertia(f, bodies, M);
}

template <int N>
void Arm<N>::inertia_coriolis(const Frames& f, const Vec<N>& v, Mat<N>& M, Mat<N>& C) const {
  Bodies<double> bodies;
  inertia(f, bodies, M);
  coriolis(f, bodies, v, C);
}

template <int N>
void Arm<N>::inertia_bias(const Frames& f, const Vec<N>& v, Mat<N>& M, Vec<N>& Cv) const {
  Bodies<double> bodies;
  inertia(f, bodies, M);
  bias(f, bodies, v, Cv);
}

template <int N>
void Arm<N>::take(const FramesOf<Pair>& both, int which, Frames& one) const {
  for (std::size_t i = 0; i < size(); ++i) {
    limpid::take(both.R[i], which, one.R[i]);
    limpid::take(both.p[i], which, one.p[i]);
    limpid::take(both.a[i], which, one.a[i]);
    limpid::take(both.o[i], which, one.o[i]);
  }
}

template <int N>
template <class S>
void Arm<N>::point_jacobian(const FramesOf<S>& f, int link, const Vec3Of<S>& world,
                            JacobianOf<N, S>& J) const {
  J.resize(3, dof());
  for (int j = 0; j < dof(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    if (j <= link) {
      J.col(j) = f.a[i].cross(world) + f.o[i];
    } else {
      J.col(j).setZero();
    }
  }
}

template void Arm<3>::point_jacobian(const FramesOf<double>&, int, const Vec3Of<double>&,
                                     JacobianOf<3, double>&) const;
template void Arm<7>::point_jacobian(const FramesOf<double>&, int, const Vec3Of<double>&,
                                     JacobianOf<7, double>&) const;
template void Arm<3>::point_jacobian(const FramesOf<Pair>&, int, const Vec3Of<Pair>&,
                                     JacobianOf<3, Pair>&) const;
template void Arm<7>::point_jacobian(const FramesOf<Pair>&, int, const Vec3Of<Pair>&,
                                     JacobianOf<7, Pair>&) const;
template void Arm<kAnyDof>::point_jacobian(const FramesOf<double>&, int, const Vec3Of<double>&,
                                           JacobianOf<kAnyDof, double>&) const;
template void Arm<kAnyDof>::point_jacobian(const FramesOf<Pair>&, int, const Vec3Of<Pair>&,
                                           JacobianOf<kAnyDof, Pair>&) const;
template class Arm<3>;
template class Arm<7>;
template class Arm<kAnyDof>;

}  // namespace limpid
