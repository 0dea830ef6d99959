#include "core/touch/proxy.h"

#include <algorithm>
#include <cmath>

#include "core/math/solve.h"

namespace limpid {

template <int N>
Proxy<N>::Proxy(const ArmDescription& arm, const Scene& scene)
    : arm_(arm), contacts_(std::make_unique<Contacts<N>>(arm, scene)) {
  place(Vec<N>::Zero(arm.dof()), Vec<N>::Zero(arm.dof()), ratio_);
}

template <int N>
void Proxy<N>::place(const Vec<N>& x, const Vec<N>& v, double ratio) {
  ratio_ = ratio;
  x_ = x;
  v_ = v;  // to the last bit: a recording's first row is a starting point
  tau_ = f_ = vbar_ = Vec<N>::Zero(x.size());
  behind_ = false;
  stood_still_ = false;
  unsettled_ = 0;
  catch_up();
  nu_ = factor_.turned_times(v);
  contacts_->place(arm_, frames_, x_);
}

template <int N>
void Proxy<N>::exchange(std::unique_ptr<Contacts<N>>& contacts) {
  if (behind_) catch_up();
  contacts->place(arm_, frames_, x_);
  contacts->take_over(*contacts_);
  contacts_.swap(contacts);
}

template <int N>
void Proxy<N>::set_ratio(double ratio) {
  if (ratio == ratio_) return;
  if (behind_) catch_up();
  nu_ *= std::sqrt(ratio / ratio_);
  ratio_ = ratio;
  catch_up();
}

template <int N>
void Proxy<N>::catch_up() {
  typename Arm<N>::Frames frames;
  Mat<N> M, C;
  catch_up_beside(x_, v_, frames, M, C);
}

template <int N>
void Proxy<N>::catch_up_beside(const Vec<N>& x, const Vec<N>& v, typename Arm<N>::Frames& frames,
                               Mat<N>& M, Mat<N>& C) {
  typename Arm<N>::template FramesOf<Pair> f;
  typename Arm<N>::template Bodies<Pair> bodies;
  MatOf<N, Pair> both;
  const typename Arm<N>::Angles one = arm_.angles(x), two = arm_.angles(x_);
  arm_.frames({paired<N>(one.sin, two.sin), paired<N>(one.cos, two.cos)}, f);
  arm_.take(f, 0, frames);
  arm_.take(f, 1, frames_);
  arm_.inertia(f, bodies, both);
  take(both, 0, M);
  take(both, 1, M_);
  M_ *= ratio_;
  factor_.compute(M_);
  if (behind_) v_ = factor_.solve_turned(nu_);
  behind_ = false;
  arm_.coriolis(f, bodies, paired<N>(v, v_), both);
  take(both, 0, C);
  take(both, 1, C_);
  C_ *= ratio_;
  factor_.follow(C_);
}

template <int N>
Vec<N> Proxy<N>::v() const {
  if (!behind_) return v_;
  typename Arm<N>::Frames f;
  Mat<N> M;
  arm_.frames(x_, f);
  arm_.inertia(f, M);
  M *= ratio_;
  MovingFactor<N> factor;
  factor.compute(M);
  return factor.solve_turned(nu_);
}

template <int N>
void Proxy<N>::advance(double T, const ProxyDrive<N>& drive) {
  if (behind_) catch_up();
  look(T);
  if (contacts_->rub()) return solve_with_friction(T, drive);
  // The set of pushing contacts is part of the solution: a contact pushes if it is inside at the
  // midpoint. Two or three rounds settle it. After that contacts are only let go, so that it ends
  // and none ever pulls.
  constexpr int kRounds = 4;
  for (int round = 0; !solve_step(T, drive); ++round) {
    if (!contacts_->reconsider(vbar_, T, round >= kRounds)) break;
  }
  step(T, vbar_, f_);
  contacts_->step_bodies();
}

// Solves the same system with the forces of contacts that rub and damp:
//     (2/T M + S + damping) vbar = 2/T L nu + constant + share f2.
// Torque that a law feeds forward to the device responds to the previous tick's motion. So a damper
// may ask for no more than is stable with that delay. Forces that do not settle are not used: the
// proxy and the bodies that it touches stand still for the tick, which gives no energy.
template <int N>
void Proxy<N>::solve_with_friction(double T, const ProxyDrive<N>& drive) {
  constexpr double kMostDamping = 0.34;  // in m_n/T [-]
  constexpr double kMostChange = 1e-3;   // of a force, see ContactSolve::last_change() [-]
  const Eigen::Index n = x_.size();
  const Mat<N> none = Mat<N>::Zero(n, n), one = Mat<N>::Identity(n, n);
  Mat<N> share = drive.share.direct * one;
  if (drive.share.shared != 0) {
    share += drive.share.shared * drive.share.M_L->solve(M_).transpose();
  }
  Wide<N> Z = impedance(T);
  Z.diagonal() += drive.damping;
  ContactAnswer<N> answer(0, widened<N>(share), widened<N>(one), widened<N>(none), widened<N>(none),
                          Z);
  if (drive.share.shared != 0) {
    answer.inertia = drive.share.M_L;
    answer.most_damping = kMostDamping;
  }
  Motion<N> motion = answer.solve({Vec<N>::Zero(n), momentum(T) + drive.constant});
  friction_.collect(*contacts_, arm_, frames_, motion.u, T);
  if (friction_.any()) friction_.solve(answer, T, motion);
  stood_still_ = friction_.any() && !friction_.settled() && friction_.last_change() > kMostChange;
  if (stood_still_) {
    ++unsettled_;
    friction_.prepare(answer, T);
    friction_.hold_bodies();
    motion.u.setZero();
    friction_.push(motion.u, T, nullptr);
  }
  const Vec<N> f = friction_.f2(n);
  friction_.finish(*contacts_);
  step(T, motion.u, f);
}

template <int N>
void Proxy<N>::step(double T, const Vec<N>& vbar, const Vec<N>& f) {
  vbar_ = vbar;
  f_ = f;
  // The torque as it acted, from the momentum it made: the balance then holds to round-off.
  const Vec<N> nu_before = nu_;
  nu_ = 2 * factor_.turned_times(vbar_) - nu_before;
  const Vec<N> impulse = factor_.times(nu_ - nu_before) / T;
  tau_ = impulse + times<N>(factor_.S(), vbar_) - f_;
  x_ += T * vbar_;
  behind_ = true;
}

template <int N>
void Proxy<N>::carry(double T, const Vec<N>& u, const Vec<N>& f2) {
  vbar_ = u;
  f_ = f2;
  tau_ = -f2;
  nu_ = factor_.turned_times(u);
  x_ += T * u;
  behind_ = true;
  stood_still_ = false;
}

// Solves for vbar with the contacts assumed to touch. True if they are those inside at the
// midpoint.
template <int N>
bool Proxy<N>::solve_step(double T, const ProxyDrive<N>& drive) {
  // (2/T M + S + damping + share K T/2) vbar = 2/T L nu + constant + share f2,
  // f2 - K T/2 vbar the contacts' force.
  Mat<N> A = narrowed<N>(impedance(T));
  A.diagonal() += drive.damping;
  Vec<N> b = momentum(T) + drive.constant;
  contacts_->add_to(A, b, T, drive.share, M_);
  vbar_ = solve<N>(A, b);
  return contacts_->push(vbar_, T, f_);
}

template class Proxy<3>;
template class Proxy<7>;
template class Proxy<kAnyDof>;

}  // namespace limpid
