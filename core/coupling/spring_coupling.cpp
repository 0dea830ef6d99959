#include "core/coupling/spring_coupling.h"

namespace limpid {
namespace {

// Drive of (2), for a proxy at x2.
template <int N>
ProxyDrive<N> drive(const SpringDamper& p, const LawInput<N>& in, const Vec<N>& x2,
                    const Vec<N>& x1, const Vec<N>& v1, const Feedforward<N>& ff) {
  const Vec<N> weights = gain_weights(p, in.b_d);
  return {weights.cwiseProduct(p.b_vc * v1 - p.k_vc * (x2 - x1)) + ff.tau2,
          (p.b_v + p.b_vc + p.k_vc * in.T / 2) * weights, ff.on_proxy};
}

// Torque of (1), without f2.
template <int N>
Vec<N> pull(const SpringDamper& p, const LawInput<N>& in, const Vec<N>& x2, const Vec<N>& vbar2,
            const Feedforward<N>& ff) {
  const Vec<N> pull = -p.b_vc * (in.v1 - vbar2) - p.k_vc * (in.x1 - x2);
  return gain_weights(p, in.b_d).cwiseProduct(pull) + ff.tau1;
}

}  // namespace

template <int N>
Vec<N> couple(const SpringDamper& p, const LawInput<N>& in, const Feedforward<N>& ff,
              Proxy<N>& proxy) {
  const Vec<N> x2 = proxy.x();
  proxy.advance(in.T, drive<N>(p, in, x2, in.x1, in.v1, ff));
  return pull<N>(p, in, x2, in.vbar2, ff) + ff.on_device.of(proxy.f(), proxy.M());
}

template <int N>
void move_proxy(const SpringDamper& p, const LawInput<N>& in, const FromDevice<N>& device,
                const Feedforward<N>& ff, Proxy<N>& proxy) {
  proxy.advance(in.T, drive<N>(p, in, proxy.x(), device.x1, device.v1, ff));
}

template <int N>
Vec<N> on_device(const SpringDamper& p, const LawInput<N>& in, const FromProxy<N>& proxy,
                 const Feedforward<N>& ff) {
  return pull<N>(p, in, proxy.x2, proxy.vbar2, ff) + ff.on_device.of(proxy.f2, proxy.proxy.M);
}

template Vec<3> couple(const SpringDamper&, const LawInput<3>&, const Feedforward<3>&, Proxy<3>&);
template void move_proxy(const SpringDamper&, const LawInput<3>&, const FromDevice<3>&,
                         const Feedforward<3>&, Proxy<3>&);
template Vec<3> on_device(const SpringDamper&, const LawInput<3>&, const FromProxy<3>&,
                          const Feedforward<3>&);
template Vec<7> couple(const SpringDamper&, const LawInput<7>&, const Feedforward<7>&, Proxy<7>&);
template void move_proxy(const SpringDamper&, const LawInput<7>&, const FromDevice<7>&,
                         const Feedforward<7>&, Proxy<7>&);
template Vec<7> on_device(const SpringDamper&, const LawInput<7>&, const FromProxy<7>&,
                          const Feedforward<7>&);
template Vec<kAnyDof> couple(const SpringDamper&, const LawInput<kAnyDof>&,
                             const Feedforward<kAnyDof>&, Proxy<kAnyDof>&);
template void move_proxy(const SpringDamper&, const LawInput<kAnyDof>&, const FromDevice<kAnyDof>&,
                         const Feedforward<kAnyDof>&, Proxy<kAnyDof>&);
template Vec<kAnyDof> on_device(const SpringDamper&, const LawInput<kAnyDof>&,
                                const FromProxy<kAnyDof>&, const Feedforward<kAnyDof>&);

}  // namespace limpid
