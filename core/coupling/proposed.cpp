#include "core/coupling/proposed.h"

#include "core/touch/proxy.h"

namespace limpid {

template <int N>
Vec<N> ProposedLaw::Of<N>::with_feedforward(double eta, const SpringDamper& p,
                                            const LawInput<N>& in, Proxy<N>& proxy) {
  const Decomposition<N> d(in.device, {proxy.M(), proxy.C(), proxy.v()});
  return couple<N>(p, in, feedforward(eta, d, in.f1_hat), proxy);
}

template class ProposedLaw::Of<3>;
template class ProposedLaw::Of<7>;
template class ProposedLaw::Of<kAnyDof>;

}  // namespace limpid
