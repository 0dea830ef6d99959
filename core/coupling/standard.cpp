#include "core/coupling/standard.h"

#include <algorithm>
#include <limits>

#include "core/touch/proxy.h"

namespace limpid {

template <int N>
Vec<N> couple(const SpringDamper& p, const LawInput<N>& in, const Feedforward<N>& ff,
              Proxy<N>& proxy) {
  const Vec<N> x2 = proxy.x();
  const ProxyDrive<N> drive{p.b_vc * in.v1 - p.k_vc * (x2 - in.x1) + ff.tau2,
                            p.b_v + p.b_vc + p.k_vc * in.T / 2, ff.on_proxy};
  proxy.advance(in.T, drive);
  return -p.b_vc * (in.v1 - in.vbar2) - p.k_vc * (in.x1 - x2) + ff.tau1 +
         ff.on_device.of(proxy.f(), proxy.M());
}

template Vec<3> couple(const SpringDamper&, const LawInput<3>&, const Feedforward<3>&, Proxy<3>&);
template Vec<7> couple(const SpringDamper&, const LawInput<7>&, const Feedforward<7>&, Proxy<7>&);
template Vec<kAnyDof> couple(const SpringDamper&, const LawInput<kAnyDof>&,
                             const Feedforward<kAnyDof>&, Proxy<kAnyDof>&);

Condition3 condition3(const SpringDamper& p, double T, std::span<const double> b_d, double delay) {
  const double least = *std::ranges::min_element(b_d);
  const double device_needs = 2 * p.b_vc + p.k_vc * (T + 1.5 * delay);
  const double proxy_needs = p.k_vc * (T + delay) / 2;
  Condition3 c;
  c.device_margin = least - device_needs;
  c.proxy_margin = p.b_v - proxy_needs;
  constexpr double kRoundOff = 8 * std::numeric_limits<double>::epsilon();
  c.holds =
      c.device_margin >= -kRoundOff * device_needs && c.proxy_margin >= -kRoundOff * proxy_needs;
  return c;
}

}  // namespace limpid
