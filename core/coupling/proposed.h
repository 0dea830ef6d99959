// The paper's coupling: spring and damper with feedforward of the observed human force and of the
// contact force, (14)-(15).
//
// The feedforward keeps device and proxy together and scales the impedance felt in slow motion.
#pragma once

#include "core/coupling/ledger.h"
#include "core/coupling/standard.h"

namespace limpid {

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

template <int N>
class ProposedLaw::Of : public PlainLaw<N> {
 public:
  // This law may give energy below eta_min and wherever it takes over.
  static constexpr double kLeastLeft = Ledger<N>::kForgiven;
  // p: Settings and a SpringDamper.
  template <class P>
  Vec<N> step(const P& p, const LawInput<N>& in, Proxy<N>& proxy) {
    return with_feedforward(p.eta, p, in, proxy);
  }

 private:
  Vec<N> with_feedforward(double eta, const SpringDamper& p, const LawInput<N>& in,
                          Proxy<N>& proxy);
};

extern template class ProposedLaw::Of<3>;
extern template class ProposedLaw::Of<7>;
extern template class ProposedLaw::Of<kAnyDof>;

}  // namespace limpid
