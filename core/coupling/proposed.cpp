#include "core/coupling/proposed.h"

#include "core/touch/proxy.h"

namespace limpid {

template <int N>
Vec<N> ProposedLaw::Of<N>::with_feedforward(double eta, const SpringDamper& p,
                                            const LawInput<N>& in, Proxy<N>& proxy) {
  if (in.link == nullptr) {
    const Decomposition<N> d(in.device, {proxy.M(), proxy.C(), proxy.v()});
    return couple<N>(p, in, feedforward(eta, d, in.f1_hat), proxy);
  }
  // Each side decomposes its own state and what it knows of the other's.
  FromProxy<N> here = told(in, proxy);
  const FromDevice<N>& far = in.link->to_proxy(told(in));
  const Decomposition<N> there(far.device, here.proxy);
  move_proxy<N>(p, in.T, far, feedforward(eta, there, far.f1_hat), proxy);
  here.f2 = proxy.f();
  const FromProxy<N>& known = in.link->to_device(here);
  const Decomposition<N> d(in.device, known.proxy);
  return on_device<N>(p, in, known, feedforward(eta, d, in.f1_hat));
}

template class ProposedLaw::Of<3>;
template class ProposedLaw::Of<7>;
template class ProposedLaw::Of<kAnyDof>;

}  // namespace limpid
