#include "core/dynamics/arm.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace limpid {
namespace {

// Half the rate of a body's inertia about O, moving with (w, u):
//     Idot / 2 = 1/2 ([w]x I - I [w]x) + (u.mc) 1 - 1/2 (mc u^T + u mc^T).
Symmetric3 half_rate(const Symmetric3& I, const Vec3& mc, const Vec3& w, const Vec3& u) {
  const double x = u.x() * mc.x(), y = u.y() * mc.y(), z = u.z() * mc.z();
  return {
      w.y() * I.xz - w.z() * I.xy + y + z,
      w.z() * I.xy - w.x() * I.yz + x + z,
      w.x() * I.yz - w.y() * I.xz + x + y,
      0.5 * (w.y() * I.yz - w.x() * I.xz + w.z() * (I.xx - I.yy) - mc.x() * u.y() - mc.y() * u.x()),
      0.5 * (w.x() * I.xy - w.z() * I.yz + w.y() * (I.zz - I.xx) - mc.x() * u.z() - mc.z() * u.x()),
      0.5 *
          (w.z() * I.xz - w.y() * I.xy + w.x() * (I.yy - I.zz) - mc.y() * u.z() - mc.z() * u.y())};
}

}  // namespace

template <int N>
Arm<N>::Arm(const ArmDescription& description) : dof_(description.dof()) {
  for (std::size_t i = 0; i < size(); ++i) {
    joints_[i] = model(description.joints[i]);
    slides_ = slides_ || joints_[i].slides;
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
  Angles a{x.array().sin(), x.array().cos()};
  if (slides_) {
    for (std::size_t i = 0; i < size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      if (joints_[i].slides) a.sin[k] = x[k];
    }
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
void Arm<N>::turn(const JointModel& joint, double sin, double cos, const Mat3& before, Mat3& R,
                  Vec3& axis) {
  const double s = joint.sign * sin, c = cos;
  Mat3 product;
  if (joint.shifted) product.noalias() = before * joint.R0;
  const Mat3& from = joint.shifted ? product : before;
  axis = joint.sign * from.col(joint.third);
  Mat3 turned;
  Mat3& to = joint.oblique ? turned : R;
  to.col(joint.third) = from.col(joint.third);
  to.col(joint.first) = c * from.col(joint.first) + s * from.col(joint.second);
  to.col(joint.second) = c * from.col(joint.second) - s * from.col(joint.first);
  if (joint.oblique) R.noalias() = turned * joint.back;
}

template <int N>
void Arm<N>::frames(const Angles& angles, Frames& f) const {
  const Mat3 base = Mat3::Identity();
  for (std::size_t i = 0; i < size(); ++i) {
    const JointModel& joint = joints_[i];
    const Mat3& before = i == 0 ? base : f.R[i - 1];
    const auto k = static_cast<Eigen::Index>(i);
    const double sin = joint.slides ? 0 : angles.sin[k], cos = joint.slides ? 1 : angles.cos[k];
    turn(joint, sin, cos, before, f.R[i], f.a[i]);
    if (i == 0) {
      f.p[0] = joint.offset;
    } else {
      f.p[i] = f.p[i - 1] + before * joint.offset;
    }
    if (joint.slides) {
      f.o[i] = kSlideUnit * f.a[i];
      f.p[i] += angles.sin[k] * f.o[i];
      f.a[i].setZero();
    } else {
      f.o[i] = f.p[i].cross(f.a[i]);
    }
  }
}

template <int N>
void Arm<N>::place_link(const Frames& f, std::size_t i, Bodies& bodies) const {
  const LinkModel& link = links_[i];
  const Vec3 c = f.p[i] + f.R[i] * link.com;
  const Vec3 g = f.R[i] * link.g;
  const Vec3 e = f.R[i] * link.e;
  bodies.c[i] = c;
  bodies.g[i] = g;
  bodies.e[i] = e;
  Body& b = bodies.link[i];
  b.m = link.mass;
  b.mc = b.m * c;
  // Parallel axes: m (c.c 1 - c c^T) more than about the centre of mass.
  const double d = link.d + b.mc.dot(c);
  b.I = {d + g.x() * g.x() + e.x() * e.x() - b.mc.x() * c.x(),
         d + g.y() * g.y() + e.y() * e.y() - b.mc.y() * c.y(),
         d + g.z() * g.z() + e.z() * e.z() - b.mc.z() * c.z(),
         g.x() * g.y() + e.x() * e.y() - b.mc.x() * c.y(),
         g.x() * g.z() + e.x() * e.z() - b.mc.x() * c.z(),
         g.y() * g.z() + e.y() * e.z() - b.mc.y() * c.z()};
}

template <int N>
void Arm<N>::inertia(const Frames& f, Bodies& bodies, Mat<N>& M) const {
  M.resize(dof(), dof());
  Body outer;
  for (std::size_t j = size(); j-- > 0;) {
    place_link(f, j, bodies);
    const Body& b = bodies.link[j];
    outer.m += b.m;
    outer.mc += b.mc;
    outer.I += b.I;
    const Vec3 moment = outer.I * f.a[j] + outer.mc.cross(f.o[j]);
    const Vec3 force = outer.m * f.o[j] - outer.mc.cross(f.a[j]);
    bodies.outer[j] = outer;
    bodies.moment[j] = moment;
    bodies.force[j] = force;
    const auto col = static_cast<Eigen::Index>(j);
    for (std::size_t i = 0; i <= j; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      M(row, col) = M(col, row) = f.a[i].dot(moment) + f.o[i].dot(force);
    }
  }
}

template <int N>
void Arm<N>::coriolis(const Frames& f, const Bodies& bodies, const Vec<N>& v, Mat<N>& C) const {
  C.resize(dof(), dof());
  // Outward: the axes' rates Sdot_j = V_j x S_j, V_j = (w, u) the velocity of link j.
  std::array<Vec3, kCapacity<N>> w, u, adot, odot;
  Vec3 w_sum = Vec3::Zero(), u_sum = Vec3::Zero();
  for (std::size_t j = 0; j < size(); ++j) {
    const double rate = v[static_cast<Eigen::Index>(j)];
    w_sum += rate * f.a[j];
    u_sum += rate * f.o[j];
    w[j] = w_sum;
    u[j] = u_sum;
    adot[j] = w_sum.cross(f.a[j]);
    odot[j] = u_sum.cross(f.a[j]) + w_sum.cross(f.o[j]);
  }
  // Inward: one column and one row of C each.
  Symmetric3 half_Idot;
  Vec3 half_L = Vec3::Zero(), h = Vec3::Zero();
  for (std::size_t j = size(); j-- > 0;) {
    const Body& b = bodies.link[j];
    half_Idot += half_rate(b.I, b.mc, w[j], u[j]);
    half_L += 0.5 * (b.I * w[j] + b.mc.cross(u[j]));
    h += b.m * u[j] - b.mc.cross(w[j]);

    const Body& outer = bodies.outer[j];
    const Vec3& a = f.a[j];
    const Vec3& moment = bodies.moment[j];
    const Vec3& force = bodies.force[j];
    const Vec3 symmetric = half_Idot * a;
    const Vec3 skew = half_L.cross(a);
    const Vec3 moment_dot = outer.I * adot[j] + outer.mc.cross(odot[j]) + symmetric - skew;
    const Vec3 force_dot = outer.m * odot[j] - outer.mc.cross(adot[j]) - h.cross(a);
    const Vec3 transposed = symmetric + skew + h.cross(f.o[j]);
    const auto col = static_cast<Eigen::Index>(j);
    for (std::size_t i = 0; i <= j; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      C(row, col) = f.a[i].dot(moment_dot) + f.o[i].dot(force_dot);
      if (i != j) {
        C(col, row) = adot[i].dot(moment) + odot[i].dot(force) + f.a[i].dot(transposed);
      }
    }
  }
}

template <int N>
void Arm<N>::bias(const Frames& f, const Bodies& bodies, const Vec<N>& v, Vec<N>& Cv) const {
  Cv.resize(dof());
  // Outward: velocity (w, u) and velocity-product acceleration (wdot, udot) of each link, that of
  // its point at O.
  std::array<Vec3, kCapacity<N>> w, u, wdot, udot;
  Vec3 w_sum = Vec3::Zero(), u_sum = Vec3::Zero(), wdot_sum = w_sum, udot_sum = w_sum;
  for (std::size_t j = 0; j < size(); ++j) {
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
  // Inward, Newton and Euler: forces m cddot and their moments, and about the centre of mass
  // I wdot + w x (I w), whose round part d 1 turns nothing.
  Vec3 moment = Vec3::Zero(), force = Vec3::Zero();
  for (std::size_t j = size(); j-- > 0;) {
    const Vec3& c = bodies.c[j];
    const Vec3& g = bodies.g[j];
    const Vec3& e = bodies.e[j];
    const Vec3 cdot = u[j] + w[j].cross(c);
    const Vec3 cddot = udot[j] + wdot[j].cross(c) + w[j].cross(cdot);
    const Vec3 push = links_[j].mass * cddot;
    force += push;
    moment += c.cross(push) + links_[j].d * wdot[j] + g.dot(wdot[j]) * g + e.dot(wdot[j]) * e +
              w[j].cross(g.dot(w[j]) * g + e.dot(w[j]) * e);
    Cv[static_cast<Eigen::Index>(j)] = f.a[j].dot(moment) + f.o[j].dot(force);
  }
}

template <int N>
void Arm<N>::inertia(const Frames& f, Mat<N>& M) const {
  Bodies bodies;
  inertia(f, bodies, M);
}

template <int N>
void Arm<N>::inertia_coriolis(const Frames& f, const Vec<N>& v, Mat<N>& M, Mat<N>& C) const {
  Bodies bodies;
  inertia(f, bodies, M);
  coriolis(f, bodies, v, C);
}

template <int N>
void Arm<N>::inertia_bias(const Frames& f, const Vec<N>& v, Mat<N>& M, Vec<N>& Cv) const {
  Bodies bodies;
  inertia(f, bodies, M);
  bias(f, bodies, v, Cv);
}

template <int N>
void Arm<N>::point_jacobian(const Frames& f, int link, const Vec3& world, Jacobian<N>& J) const {
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

template class Arm<3>;
template class Arm<kAnyDof>;

}  // namespace limpid
