#include "app/style/colour_scale.h"

#include <algorithm>
#include <array>

namespace limpid {

Rgb scale_colour(double part) {
  static constexpr std::array kColours{rgb(0x440154), rgb(0x472c7a), rgb(0x3b518b),
                                       rgb(0x2c718e), rgb(0x21908d), rgb(0x27ad81),
                                       rgb(0x5cc863), rgb(0xaadc32), rgb(0xfde725)};
  const double at = std::clamp(part, 0.0, 1.0) * (kColours.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), kColours.size() - 2);
  return mix(kColours[i], kColours[i + 1], static_cast<float>(at - static_cast<double>(i)));
}

}  // namespace limpid
