#include "core/dynamics/arm.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/math/elementary.h"

namespace limpid {

template <int N>
Arm<N>::Arm(const ArmDescription& description) : dof_(description.dof()) {
  for (std::size_t i = 0; i < size(); ++i) {
    joints_[i] = model(description.joints[i]);
    const Link& link = description.links[i];
    const Eigen::SelfAdjointEigenSolver<Mat3> principal(link.inertia);
    const Vec3& moments = principal.eigenvalues();  // smallest first
    const Mat3& axes = principal.eigenvectors();
    const Vec3 g = std::sqrt(moments[1] - moments[0]) * axes.col(1);
    const Vec3 e = std::sqrt(moments[2] - moments[0]) * axes.col(2);
    links_[i] = {link.mass, link.com.cast<Pair>(), moments[0], g.cast<Pair>(), e.cast<Pair>()};
  }
  const Joint& joint = description.joints[0];
  const Link& link = description.links[0];
  first_inertia_ = joint.kind == Joint::Kind::prismatic
                       ? link.mass * kSlideUnit * kSlideUnit
                       : joint.axis.dot(link.inertia * joint.axis) +
                             link.mass * joint.axis.cross(link.com).squaredNorm();
  tip_ = description.tip.translation();
}

template <int N>
typename Arm<N>::JointModel Arm<N>::model(const Joint& joint) {
  JointModel m{};
  Mat3 R0 = joint.origin.linear();
  m.offset = joint.origin.translation().cast<Pair>();
  joint.axis.cwiseAbs().maxCoeff(&m.third);
  m.first = (m.third + 1) % 3;
  m.second = (m.third + 2) % 3;
  const double sign = joint.axis[m.third] < 0 ? -1 : 1;
  m.sign = sign;
  m.oblique = joint.axis != sign * Vec3::Unit(m.third);
  if (m.oblique) {
    Mat3 Q;
    Q.col(m.third) = sign * joint.axis;
    Q.col(m.first) = Q.col(m.third).unitOrthogonal();
    Q.col(m.second) = Q.col(m.third).cross(Q.col(m.first));
    R0 = R0 * Q;
    m.back = Q.transpose().cast<Pair>();
  }
  m.R0 = R0.cast<Pair>();
  m.shifted = !R0.isIdentity(0);
  m.slides = joint.kind == Joint::Kind::prismatic;
  return m;
}

template <int N>
typename Arm<N>::Angles Arm<N>::angles(const Vec<N>& x) const {
  Angles a{x, x};
  for (Eigen::Index i = 0; i < x.size(); ++i) renew(i, x[i], a);
  return a;
}

template <int N>
template <class S>
void Arm<N>::renew(Eigen::Index joint, double x, AnglesOf<S>& a) const {
  const auto [sin, cos] = sine_cosine(x);
  a.sin[joint] = joints_[static_cast<std::size_t>(joint)].slides ? x : sin;
  a.cos[joint] = cos;
}

template <int N>
template <class S>
typename Arm<N>::template AnglesOf<S> Arm<N>::turned(const Angles& a, const VecOf<N, S>& dx) const {
  constexpr double kSmall = 0.01;  // [rad]; the series below are exact to round-off there
  const VecOf<N, S> sin = a.sin.template cast<S>(), cos = a.cos.template cast<S>();
  AnglesOf<S> b{sin, cos};
  for (Eigen::Index i = 0; i < dx.size(); ++i) {
    const S d = dx[i], d2 = d * d;
    S s = d * (1. - d2 * (1. / 6) * (1. - d2 * (1. / 20)));
    S c = 1. - d2 * (1. / 2) * (1. - d2 * (1. / 12) * (1. - d2 * (1. / 30)));
    if (std::max(std::abs(of(d, 0)), std::abs(of(d, 1))) >= kSmall) {
      s = each(d, sine);
      c = each(d, cosine);
    }
    b.sin[i] = sin[i] * c + cos[i] * s;
    b.cos[i] = cos[i] * c - sin[i] * s;
    if (joints_[static_cast<std::size_t>(i)].slides) b.sin[i] = sin[i] + d;
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
template Arm<3>::Angles Arm<3>::turned(const Angles&, const Vec<3>&) const;
template Arm<7>::Angles Arm<7>::turned(const Angles&, const Vec<7>&) const;
template Arm<kAnyDof>::Angles Arm<kAnyDof>::turned(const Angles&, const Vec<kAnyDof>&) const;
template Arm<3>::AnglesOf<Pair> Arm<3>::turned(const Angles&, const VecOf<3, Pair>&) const;
template Arm<7>::AnglesOf<Pair> Arm<7>::turned(const Angles&, const VecOf<7, Pair>&) const;
template Arm<kAnyDof>::AnglesOf<Pair> Arm<kAnyDof>::turned(const Angles&,
                                                           const VecOf<kAnyDof, Pair>&) const;
template void Arm<3>::renew(Eigen::Index, double, AnglesOf<Pair>&) const;
template void Arm<7>::renew(Eigen::Index, double, AnglesOf<Pair>&) const;
template void Arm<kAnyDof>::renew(Eigen::Index, double, AnglesOf<Pair>&) const;
template class Arm<3>;
template class Arm<7>;
template class Arm<kAnyDof>;

// An axis moves with the links before it, S_j' = V x S_j.
template <int N>
template <class S>
Vec3Of<S> Arm<N>::point_drift(const FramesOf<S>& f, int link, const Vec3Of<S>& world,
                              const VecOf<N, S>& v) const {
  Vec3Of<S> turning = Vec3Of<S>::Zero(), moving = turning;  // V of the links before
  Vec3Of<S> drift = turning;
  for (int j = 0; j <= link; ++j) {
    const Vec3Of<S>& a = f.a[static_cast<std::size_t>(j)];
    const Vec3Of<S>& o = f.o[static_cast<std::size_t>(j)];
    drift += v[j] * (turning.cross(o) + moving.cross(a) + turning.cross(a).cross(world));
    moving += v[j] * o;
    turning += v[j] * a;
  }
  return drift + turning.cross(moving + turning.cross(world));
}

template Vec3Of<double> Arm<3>::point_drift(const FramesOf<double>&, int, const Vec3Of<double>&,
                                            const VecOf<3, double>&) const;
template Vec3Of<double> Arm<7>::point_drift(const FramesOf<double>&, int, const Vec3Of<double>&,
                                            const VecOf<7, double>&) const;
template Vec3Of<Pair> Arm<3>::point_drift(const FramesOf<Pair>&, int, const Vec3Of<Pair>&,
                                          const VecOf<3, Pair>&) const;
template Vec3Of<Pair> Arm<7>::point_drift(const FramesOf<Pair>&, int, const Vec3Of<Pair>&,
                                          const VecOf<7, Pair>&) const;
template Vec3Of<double> Arm<kAnyDof>::point_drift(const FramesOf<double>&, int,
                                                  const Vec3Of<double>&,
                                                  const VecOf<kAnyDof, double>&) const;
template Vec3Of<Pair> Arm<kAnyDof>::point_drift(const FramesOf<Pair>&, int, const Vec3Of<Pair>&,
                                                const VecOf<kAnyDof, Pair>&) const;

// All links beyond a joint load it as one body.
template <int N>
Vec<N> Arm<N>::weight(const Frames& f, const Vec3& gravity) const {
  Vec<N> torque = Vec<N>::Zero(dof());
  double m = 0;
  Vec3 mc = Vec3::Zero();
  for (std::size_t j = size(); j-- > 0;) {
    const LinkModel& link = links_[j];
    const double mass = link.mass[0];
    m += mass;
    mc += mass * (f.p[j] + f.R[j] * link.com.template cast<double>());
    torque[static_cast<Eigen::Index>(j)] =
        -(f.a[j].dot(mc.cross(gravity)) + m * f.o[j].dot(gravity));
  }
  return torque;
}

template Vec<3> Arm<3>::weight(const Frames& f, const Vec3& gravity) const;
template Vec<7> Arm<7>::weight(const Frames& f, const Vec3& gravity) const;
template Vec<kAnyDof> Arm<kAnyDof>::weight(const Frames& f, const Vec3& gravity) const;

}  // namespace limpid
