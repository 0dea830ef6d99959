// Feedforward of the observed human force and of the contact force, (14)-(15).
#pragma once

#include "core/coupling/decomposition.h"
#include "core/touch/contacts.h"

namespace limpid {

// Feedforward that (14)-(15) add to (1)-(2): torques without f2, and shares of f2, which is known
// only after the proxy's step. The proxy's share includes the f2 that acts on it anyway.
template <int N>
struct Feedforward {
  Vec<N> tau1, tau2;  // [N m]
  ContactShare<N> on_device{0}, on_proxy{1};

  static Feedforward none(Eigen::Index n) { return {Vec<N>::Zero(n), Vec<N>::Zero(n)}; }
};

// Feedforward of (14)-(15), with the observed f1 [N m]; keeps a reference to d. The common part is
// computed once: tau1 + tau2 = C_LE v_E + (1 - eta)/eta f1.
template <int N>
Feedforward<N> feedforward(double eta, const Decomposition<N>& d, const Vec<N>& f1_hat) {
  const Vec<N> shape = d.shape_torque();
  Feedforward<N> ff;
  ff.tau2 = d.C2 * d.v_L + d.times_phi_T(shape + f1_hat / eta - d.C_L * d.v_L);  // (15)
  ff.tau1 = shape + (1 - eta) / eta * f1_hat - ff.tau2;                          // (14)
  ff.on_device = {1 / eta, -1 / eta, &d.M_L_factor};  // (1 - eta)/eta I - phi^T/eta + I
  ff.on_proxy = {0, 1 / eta, &d.M_L_factor};
  return ff;
}

}  // namespace limpid
