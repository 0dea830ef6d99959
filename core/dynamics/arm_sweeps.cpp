// Sweeps along the chain, for poses, inertia and motion of the links, for one configuration or two
// at a time.
#include "core/dynamics/arm.h"

namespace limpid {
namespace {

// Half the rate of a body's inertia about O, moving with (w, u):
//     Idot / 2 = 1/2 ([w]x I - I [w]x) + (u.mc) 1 - 1/2 (mc u^T + u mc^T).
template <class S>
[[gnu::always_inline]] inline Symmetric3<S> half_rate(const Symmetric3<S>& I, const Vec3Of<S>& mc,
                                                      const Vec3Of<S>& w, const Vec3Of<S>& u) {
  const S x = u.x() * mc.x(), y = u.y() * mc.y(), z = u.z() * mc.z();
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
template <class S>
[[gnu::always_inline]] inline void Arm<N>::turn(const JointModel& joint, const S& sin, const S& cos,
                                                const Mat3Of<S>& before, Mat3Of<S>& R,
                                                Vec3Of<S>& axis) {
  const S s = S(joint.sign) * sin, c = cos;
  Mat3Of<S> product;
  if (joint.shifted) product.noalias() = before * joint.R0.template cast<S>();
  const Mat3Of<S>& from = joint.shifted ? product : before;
  axis = S(joint.sign) * from.col(joint.third);
  Mat3Of<S> turned;
  Mat3Of<S>& to = joint.oblique ? turned : R;
  to.col(joint.third) = from.col(joint.third);
  to.col(joint.first) = c * from.col(joint.first) + s * from.col(joint.second);
  to.col(joint.second) = c * from.col(joint.second) - s * from.col(joint.first);
  if (joint.oblique) R.noalias() = turned * joint.back.template cast<S>();
}

template <int N>
template <class S>
void Arm<N>::frames(const AnglesOf<S>& angles, FramesOf<S>& f) const {
  const Mat3Of<S> base = Mat3Of<S>::Identity();
  for (std::size_t i = 0; i < size(); ++i) {
    const JointModel& joint = joints_[i];
    const Mat3Of<S>& before = i == 0 ? base : f.R[i - 1];
    const auto k = static_cast<Eigen::Index>(i);
    const S sin = joint.slides ? S(0) : angles.sin[k], cos = joint.slides ? S(1) : angles.cos[k];
    turn(joint, sin, cos, before, f.R[i], f.a[i]);
    if (i == 0) {
      f.p[0] = joint.offset.template cast<S>();
    } else {
      f.p[i] = f.p[i - 1] + before * joint.offset.template cast<S>();
    }
    if (joint.slides) {
      f.o[i] = S(kSlideUnit) * f.a[i];
      f.p[i] += angles.sin[k] * f.o[i];
      f.a[i].setZero();
    } else {
      f.o[i] = f.p[i].cross(f.a[i]);
    }
  }
}

template <int N>
template <class S>
[[gnu::always_inline]] inline void Arm<N>::place_link(const FramesOf<S>& f, std::size_t i,
                                                      Bodies<S>& bodies) const {
  const LinkModel& link = links_[i];
  const Vec3Of<S> c = f.p[i] + f.R[i] * link.com.template cast<S>();
  const Vec3Of<S> g = f.R[i] * link.g.template cast<S>();
  const Vec3Of<S> e = f.R[i] * link.e.template cast<S>();
  Body<S>& b = bodies.link[i];
  b.m = S(link.mass);
  b.mc = b.m * c;
  // Parallel axes: m (c.c 1 - c c^T) more than about the centre of mass.
  const S d = S(link.d) + b.mc.dot(c);
  b.I = {d + g.x() * g.x() + e.x() * e.x() - b.mc.x() * c.x(),
         d + g.y() * g.y() + e.y() * e.y() - b.mc.y() * c.y(),
         d + g.z() * g.z() + e.z() * e.z() - b.mc.z() * c.z(),
         g.x() * g.y() + e.x() * e.y() - b.mc.x() * c.y(),
         g.x() * g.z() + e.x() * e.z() - b.mc.x() * c.z(),
         g.y() * g.z() + e.y() * e.z() - b.mc.y() * c.z()};
}

template <int N>
template <class S>
void Arm<N>::inertia(const FramesOf<S>& f, Bodies<S>& bodies, MatOf<N, S>& M) const {
  M.resize(dof(), dof());
  Body<S> outer;
  for (std::size_t j = size(); j-- > 0;) {
    if (j > 0) {
      place_link(f, j, bodies);
      const Body<S>& b = bodies.link[j];
      outer.m += b.m;
      outer.mc += b.mc;
      outer.I += b.I;
    }
    const Vec3Of<S> moment = outer.I * f.a[j] + outer.mc.cross(f.o[j]);
    const Vec3Of<S> force = outer.m * f.o[j] - outer.mc.cross(f.a[j]);
    bodies.outer[j] = outer;
    bodies.moment[j] = moment;
    bodies.force[j] = force;
    const auto col = static_cast<Eigen::Index>(j);
    for (std::size_t i = 0; i <= j; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      M(row, col) = M(col, row) = f.a[i].dot(moment) + f.o[i].dot(force);
    }
  }
  M(0, 0) += S(first_inertia_);
}

template <int N>
template <class S>
void Arm<N>::coriolis(const FramesOf<S>& f, const Bodies<S>& bodies, const VecOf<N, S>& v,
                      MatOf<N, S>& C) const {
  C.resize(dof(), dof());
  // Outward: the axes' rates Sdot_j = V_j x S_j, V_j = (w, u) the velocity of link j.
  std::array<Vec3Of<S>, kCapacity<N>> w, u, adot, odot;
  Vec3Of<S> w_sum = Vec3Of<S>::Zero(), u_sum = Vec3Of<S>::Zero();
  for (std::size_t j = 0; j < size(); ++j) {
    const S rate = v[static_cast<Eigen::Index>(j)];
    w_sum += rate * f.a[j];
    u_sum += rate * f.o[j];
    w[j] = w_sum;
    u[j] = u_sum;
    adot[j] = w_sum.cross(f.a[j]);
    odot[j] = u_sum.cross(f.a[j]) + w_sum.cross(f.o[j]);
  }
  // Inward sweep: one column and one row of C for each joint.
  Symmetric3<S> half_Idot;
  Vec3Of<S> half_L = Vec3Of<S>::Zero(), h = Vec3Of<S>::Zero();
  for (std::size_t j = size(); j-- > 1;) {
    const Body<S>& b = bodies.link[j];
    half_Idot += half_rate(b.I, b.mc, w[j], u[j]);
    half_L += S(0.5) * (b.I * w[j] + b.mc.cross(u[j]));
    h += b.m * u[j] - b.mc.cross(w[j]);

    const Body<S>& outer = bodies.outer[j];
    const Vec3Of<S>& a = f.a[j];
    const Vec3Of<S>& moment = bodies.moment[j];
    const Vec3Of<S>& force = bodies.force[j];
    const Vec3Of<S> symmetric = half_Idot * a;
    const Vec3Of<S> skew = half_L.cross(a);
    const Vec3Of<S> moment_dot = outer.I * adot[j] + outer.mc.cross(odot[j]) + symmetric - skew;
    const Vec3Of<S> force_dot = outer.m * odot[j] - outer.mc.cross(adot[j]) - h.cross(a);
    const Vec3Of<S> transposed = symmetric + skew + h.cross(f.o[j]);
    const auto col = static_cast<Eigen::Index>(j);
    for (std::size_t i = 0; i <= j; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      C(row, col) = f.a[i].dot(moment_dot) + f.o[i].dot(force_dot);
      if (i != j) {
        C(col, row) = adot[i].dot(moment) + odot[i].dot(force) + f.a[i].dot(transposed);
      }
    }
  }
  // The first joint's own axis does not move.
  C(0, 0) = f.a[0].dot(half_Idot * f.a[0]) - f.o[0].dot(h.cross(f.a[0]));
}

template <int N>
template <class S>
void Arm<N>::bias(const FramesOf<S>& f, const Bodies<S>& bodies, const VecOf<N, S>& v,
                  VecOf<N, S>& Cv) const {
  Cv.resize(dof());
  // Outward: velocity (w, u) of each link; velocity-product acceleration (wdot, udot) of its point
  // at O; rates of its momentum and angular momentum about O. The first link, which only turns
  // about its axis or slides along it, needs no torque for these.
  std::array<Vec3Of<S>, kCapacity<N>> moment, force;
  const Vec3Of<S> zero = Vec3Of<S>::Zero();
  moment[0] = force[0] = zero;
  Vec3Of<S> w = v[0] * f.a[0], u = v[0] * f.o[0], wdot = zero, udot = zero;
  for (std::size_t j = 1; j < size(); ++j) {
    const S rate = v[static_cast<Eigen::Index>(j)];
    const Vec3Of<S> turn = rate * f.a[j], move = rate * f.o[j];
    wdot += w.cross(turn);
    udot += u.cross(turn) + w.cross(move);
    w += turn;
    u += move;
    const Body<S>& b = bodies.link[j];
    const Vec3Of<S> h = b.m * u - b.mc.cross(w);
    const Vec3Of<S> L = b.I * w + b.mc.cross(u);
    force[j] = b.m * udot - b.mc.cross(wdot) + w.cross(h);
    moment[j] = b.I * wdot + b.mc.cross(udot) + w.cross(L) + u.cross(h);
  }
  // Inward: sums of moments and forces.
  Vec3Of<S> all_moment = zero, all_force = zero;
  for (std::size_t j = size(); j-- > 0;) {
    all_moment += moment[j];
    all_force += force[j];
    Cv[static_cast<Eigen::Index>(j)] = f.a[j].dot(all_moment) + f.o[j].dot(all_force);
  }
}

template void Arm<3>::frames(const AnglesOf<double>&, FramesOf<double>&) const;
template void Arm<7>::frames(const AnglesOf<double>&, FramesOf<double>&) const;
template void Arm<3>::inertia(const FramesOf<double>&, Bodies<double>&, MatOf<3, double>&) const;
template void Arm<7>::inertia(const FramesOf<double>&, Bodies<double>&, MatOf<7, double>&) const;
template void Arm<3>::coriolis(const FramesOf<double>&, const Bodies<double>&,
                               const VecOf<3, double>&, MatOf<3, double>&) const;
template void Arm<7>::coriolis(const FramesOf<double>&, const Bodies<double>&,
                               const VecOf<7, double>&, MatOf<7, double>&) const;
template void Arm<3>::bias(const FramesOf<double>&, const Bodies<double>&, const VecOf<3, double>&,
                           VecOf<3, double>&) const;
template void Arm<7>::bias(const FramesOf<double>&, const Bodies<double>&, const VecOf<7, double>&,
                           VecOf<7, double>&) const;
template void Arm<3>::frames(const AnglesOf<Pair>&, FramesOf<Pair>&) const;
template void Arm<7>::frames(const AnglesOf<Pair>&, FramesOf<Pair>&) const;
template void Arm<3>::inertia(const FramesOf<Pair>&, Bodies<Pair>&, MatOf<3, Pair>&) const;
template void Arm<7>::inertia(const FramesOf<Pair>&, Bodies<Pair>&, MatOf<7, Pair>&) const;
template void Arm<3>::coriolis(const FramesOf<Pair>&, const Bodies<Pair>&, const VecOf<3, Pair>&,
                               MatOf<3, Pair>&) const;
template void Arm<7>::coriolis(const FramesOf<Pair>&, const Bodies<Pair>&, const VecOf<7, Pair>&,
                               MatOf<7, Pair>&) const;
template void Arm<3>::bias(const FramesOf<Pair>&, const Bodies<Pair>&, const VecOf<3, Pair>&,
                           VecOf<3, Pair>&) const;
template void Arm<7>::bias(const FramesOf<Pair>&, const Bodies<Pair>&, const VecOf<7, Pair>&,
                           VecOf<7, Pair>&) const;
template void Arm<kAnyDof>::frames(const AnglesOf<double>&, FramesOf<double>&) const;
template void Arm<kAnyDof>::inertia(const FramesOf<double>&, Bodies<double>&,
                                    MatOf<kAnyDof, double>&) const;
template void Arm<kAnyDof>::coriolis(const FramesOf<double>&, const Bodies<double>&,
                                     const VecOf<kAnyDof, double>&, MatOf<kAnyDof, double>&) const;
template void Arm<kAnyDof>::bias(const FramesOf<double>&, const Bodies<double>&,
                                 const VecOf<kAnyDof, double>&, VecOf<kAnyDof, double>&) const;
template void Arm<kAnyDof>::frames(const AnglesOf<Pair>&, FramesOf<Pair>&) const;
template void Arm<kAnyDof>::inertia(const FramesOf<Pair>&, Bodies<Pair>&,
                                    MatOf<kAnyDof, Pair>&) const;
template void Arm<kAnyDof>::coriolis(const FramesOf<Pair>&, const Bodies<Pair>&,
                                     const VecOf<kAnyDof, Pair>&, MatOf<kAnyDof, Pair>&) const;
template void Arm<kAnyDof>::bias(const FramesOf<Pair>&, const Bodies<Pair>&,
                                 const VecOf<kAnyDof, Pair>&, VecOf<kAnyDof, Pair>&) const;

}  // namespace limpid
