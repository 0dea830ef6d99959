#include "core/coupling/spring_damper.h"

#include <algorithm>
#include <limits>

namespace limpid {

Condition3 condition3(const SpringDamper& p, double T, std::span<const double> b_d, double delay,
                      const LinkSettings& link) {
  const double least = *std::ranges::min_element(b_d);
  const double old = link.oldest() * T, again = 0.5 * link.link_jitter;
  const double device_needs = (2 + again) * p.b_vc + p.k_vc * (T + 1.5 * delay + old);
  const double proxy_needs = again * p.b_vc + p.k_vc * (T + delay + 2 * old) / 2;
  Condition3 c;
  c.device_margin = least - device_needs;
  c.proxy_margin = p.b_v - proxy_needs;
  c.known = !(link.link_loss > 0);
  constexpr double kRoundOff = 8 * std::numeric_limits<double>::epsilon();
  c.holds = c.known && c.device_margin >= -kRoundOff * device_needs &&
            c.proxy_margin >= -kRoundOff * proxy_needs;
  return c;
}

}  // namespace limpid
