// The paper's coupling: spring and damper with feedforward of the observed human force and of the
// contact force, (14)-(15), which keeps device and proxy together and scales the inertia felt.
#pragma once

#include "core/coupling/spring_damper.h"

namespace limpid {

// (14)-(15), with f1 as it was observed [N m].
template <int N>
Feedforward<N> feedforward(double eta, const Decomposition<N>& d, const Vec<N>& f1_hat) {
  const Eigen::Index n = f1_hat.size();
  Feedforward<N> ff;
  const Mat<N> I = Mat<N>::Identity(n, n);
  const Mat<N> phi_T = d.phi.transpose();
  const Vec<N> locked = d.C_EL * d.v_L;
  const Vec<N> shape = d.C_LE * d.v_E;
  const Vec<N> phi_f1 = phi_T * f1_hat / eta;
  const Vec<N> phi_shape = phi_T * shape;
  ff.tau1 = locked + shape - phi_shape + (1 - eta) / eta * f1_hat - phi_f1;  // (14)
  ff.tau2 = -locked + phi_shape + phi_f1;                                    // (15)
  ff.from_f2_1 = (I - phi_T) / eta;  // (1 - eta)/eta I - phi^T/eta + I
  ff.from_f2_2 = phi_T / eta - I;
  return ff;
}

struct ProposedLaw {
  static constexpr LawInfo kInfo{
      .key = "proposed",
      .label = "Proposed",
      .meaning = "with feedforward of the observed human force and the contact force, (14)-(15).",
      .verdict = "The paper's: no drift; passive only above \xCE\xB7_min.",
      .scales_inertia = true,
      .observes = true,
      .keeps_ledger = false,
      .sliders = kPaperSliders,
  };

  struct Settings {
    double eta = 1;  // [-]

    template <class P>
    static constexpr std::array<Setting<P>, 1> settings() {
      return {{{"coupling.eta", "\xCE\xB7", &P::eta, "-", 0.01, 100, 0.1, 10, true, true,
                "Apparent inertia: the hand feels eta times M1 + M2, (12). Below eta_min of "
                "(25) the coupling is not passive."}}};
    }
  };

  template <int N>
  class Of : public PlainLaw<N> {
   public:
    // p: Settings and a SpringDamper.
    template <class P>
    Vec<N> step(const P& p, const LawInput<N>& in, Proxy<N>& proxy) {
      return with_feedforward(p.eta, p, in, proxy);
    }

   private:
    Vec<N> with_feedforward(double eta, const SpringDamper& p, const LawInput<N>& in,
                            Proxy<N>& proxy);
  };
};

extern template class ProposedLaw::Of<3>;
extern template class ProposedLaw::Of<kAnyDof>;

}  // namespace limpid
