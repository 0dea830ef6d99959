// Solve of device, proxy and contacts together, for ticks with motors at their limit.
#pragma once

#include "core/touch/contact_solve.h"

namespace limpid {

// A torque that is linear in the motion: constant + on_w w + on_u u [N m].
template <int N>
struct LinearTorque {
  Vec<N> constant;
  Mat<N> on_w, on_u;
  Vec<N> at(const Motion<N>& m) const { return constant + on_w * m.w + on_u * m.u; }
};

// Torque that a motor cannot give does not reach the proxy either. Device and proxy exchange a
// torque p that is bounded by the motors' limit, as by a joint with dry friction; contacts push on
// the proxy with the forces f2(u) of their laws:
//     D0 w           = drive + authority tau1,      p = clip(tE + on_f2 f2),   tau1 = clip(p + tL)
//     (impedance) u  = momentum - p + rest + f2(u).
// For a proxy without mass the work of p is the loss of the convex storage sum_i limit_i |x_E,i|.
// This holds in every tick, for all contacts and hands.
template <int N>
struct LimitedSolve {
  LinearTorque<N> tE;    // wanted between device and proxy
  LinearTorque<N> tL;    // on the device alone
  LinearTorque<N> rest;  // on the proxy alone
  Mat<N> on_f2;          // factor of f2 that is added to tE
  Mat<N> D0, impedance;  // impedance: the proxy's with its damper b_v [N m s/rad]
  Vec<N> drive, momentum, limit;
  double authority = 1;

  // Results of the last solve.
  Vec<N> f2, p, tau1;  // [N m]
  Vec<N> given;        // p + tL, before the motors' limit cuts it to tau1 [N m]
  int steps = 0;       // steps of Newton's method

  // Most steps, and those with a slope that is quickly found: most solves end within these, and
  // those that do not come nearer with it slowly or not at all.
  static constexpr int kMostSteps = 10, kQuickSteps = 4;

  // Newton's method from m, each step shortened until it leads nearer; at a kink of the law the
  // present piece is used. True if it ended at a solution, to 1e-9 of the motion. Contacts:
  // collected and prepared.
  bool solve(ContactSolve<N>& contacts, double T, Motion<N>& m);

  // Fallback that always exists: the proxy stands still for this tick and takes no energy; the
  // device gets its torque without prediction, within the limits.
  void stand_still(ContactSolve<N>& contacts, double T, Motion<N>& m);

  const Vec<N>& wanted() const { return wanted_; }  // torque before the limit that gives p [N m]
  bool at_limit() const { return (p.cwiseAbs().array() >= limit.array()).any(); }

 private:
  Motion<N> residual(ContactSolve<N>& contacts, double T, const Motion<N>& m,
                     Mat<N>* slope = nullptr, Slope how = Slope::quick);
  using Slopes = CoupledSystem<N, Factor>;  // Factor: with friction the proxy's block need not be
                                            // positive definite
  Slopes slopes(const Mat<N>& f2_on_u) const;

  Vec<N> wanted_;  // tE + on_f2 f2
};

}  // namespace limpid
