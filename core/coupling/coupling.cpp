#include "core/coupling/coupling.h"

#include <algorithm>
#include <limits>

namespace limpid {

Condition3 condition3(const Parameters& p, std::span<const double> b_d) {
  const double least = *std::ranges::min_element(b_d);
  const double device_needs = 2 * p.b_vc + p.k_vc * p.tick;
  const double proxy_needs = p.k_vc * p.tick / 2;
  Condition3 c;
  c.device_margin = least - device_needs;
  c.proxy_margin = p.b_v - proxy_needs;
  constexpr double kRoundOff = 8 * std::numeric_limits<double>::epsilon();
  c.holds =
      c.device_margin >= -kRoundOff * device_needs && c.proxy_margin >= -kRoundOff * proxy_needs;
  return c;
}

}  // namespace limpid
