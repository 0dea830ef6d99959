// The virtual proxy: robot dynamics (6) integrated passively in discrete time, (4).
#pragma once

#include <memory>

#include "core/dynamics/arm.h"
#include "core/math/solve.h"
#include "core/touch/contact_solve.h"
#include "core/touch/contacts.h"

namespace limpid {

// Torques on the proxy over one tick, with vbar = (x_k+1 - x_k) / T unknown:
//     tau + f2 = constant - damping vbar + share f2,
// f2 the contacts' torque.
template <int N>
struct ProxyDrive {
  Vec<N> constant;  // [N m]
  Vec<N> damping;   // b_v + b_vc + k_vc T / 2 of every joint [N m s/rad]
  ContactShare<N> share{};
};

// Non-iterative passive integration. With M2 = L L^T and nu = L^T v the motion (6) reads
//     nu' = L^-1 (tau + f - S L^-T nu),   S = C - L Ldot^T skew,
// and the midpoint rule, with L and S held at x_k and vbar = L^-T (nu_k + nu_k+1) / 2,
//     (2/T M + S) vbar = 2/T L nu_k + tau + f,   x_k+1 = x_k + T vbar,
// gives (|nu_k+1|^2 - |nu_k|^2) / 2 = (tau + f) . (x_k+1 - x_k): kinetic energy balances work in
// every step, for any T, M(x) and forces. Springs, dampers and contacts enter at the midpoint,
// linearly in vbar, so that one solve suffices, and no inertia is too small. Friction and damping
// of surfaces are not linear: in scenes with them ContactSolve finds all contacts' forces.
template <int N>
class Proxy {
 public:
  Proxy(const ArmDescription& arm, const Scene& scene);

  // Takes a state [rad, rad/s], with inertia ratio * M(x) [-].
  void place(const Vec<N>& x, const Vec<N>& v, double ratio);
  // A changed ratio keeps the velocity.
  void set_ratio(double ratio);
  double ratio() const { return ratio_; }

  // Computes M, C and v at the present position. After a step it comes before all other calls but
  // x(), v() and the results of the last tick.
  void catch_up();
  // Like catch_up(); the same sweeps compute frames, M and C of another arm of the same make at x
  // and v.
  void catch_up_beside(const Vec<N>& x, const Vec<N>& v, typename Arm<N>::Frames& frames, Mat<N>& M,
                       Mat<N>& C);

  // Advances by one tick of length T [s].
  void advance(double T, const ProxyDrive<N>& drive);

  // The following are advance() in parts, for laws that solve device and proxy together. First,
  // look() finds the near contacts.
  void look(double T) { contacts_->find(arm_, frames_, x_, T); }
  // Second, (2/T M + S) vbar - 2/T L nu = tau + f, for any tau.
  Wide<N> impedance(double T) const {
    Wide<N> Z = widened<N>(M_);
    Z *= 2 / T;
    Z += factor_.S();
    return Z;
  }
  Vec<N> momentum(double T) const { return 2 / T * factor_.times(nu_); }
  // Last, steps with the mean velocity and contact forces of the tick [rad/s, N m].
  void step(double T, const Vec<N>& vbar, const Vec<N>& f);
  // Or, last, carries the proxy along: without a mass of its own it moves with u over the tick, and
  // tau2 holds f2.
  void carry(double T, const Vec<N>& u, const Vec<N>& f2);
  Contacts<N>& contacts() { return *contacts_; }

  const Vec<N>& x() const { return x_; }
  Vec<N> v() const;
  const Mat<N>& M() const { return M_; }
  const Mat<N>& C() const { return C_; }
  double kinetic_energy() const { return 0.5 * nu_.squaredNorm(); }    // [J]
  double contact_potential() const { return contacts_->potential(); }  // [J]

  // Results of the last tick.
  const Vec<N>& tau() const { return tau_; }    // tau2 as it acted [N m]
  const Vec<N>& f() const { return f_; }        // f2 as it acted [N m]
  const Vec<N>& vbar() const { return vbar_; }  // [rad/s]
  const Contacts<N>& contacts() const { return *contacts_; }
  // stood_still(): advance() found no consistent forces, so the proxy stood still; unsettled():
  // number of such ticks so far.
  bool stood_still() const { return stood_still_; }
  int unsettled() const { return unsettled_; }

  // Arm and frames at the present position.
  const Arm<N>& arm() const { return arm_; }
  const typename Arm<N>::Frames& frames() const { return frames_; }
  // Changes the scene: takes `contacts` and gives back the old ones. Nothing is allocated.
  void exchange(std::unique_ptr<Contacts<N>>& contacts);

 private:
  bool solve_step(double T, const ProxyDrive<N>& drive);
  void solve_with_friction(double T, const ProxyDrive<N>& drive);

  Arm<N> arm_;
  std::unique_ptr<Contacts<N>> contacts_;
  ContactSolve<N> friction_;  // for ticks in which surfaces rub or damp
  bool stood_still_ = false;
  int unsettled_ = 0;
  double ratio_ = 1e-4;
  typename Arm<N>::Frames frames_;
  bool behind_ = false;  // catch_up() has still to be called
  Vec<N> x_, v_, nu_;
  Mat<N> M_, C_;
  MovingFactor<N> factor_;  // L, S
  Vec<N> tau_, f_, vbar_;
};

extern template class Proxy<3>;
extern template class Proxy<7>;
extern template class Proxy<kAnyDof>;

}  // namespace limpid
