#include "app/style/palette.h"

#include <algorithm>
#include <cmath>

#include "core/tick/parameters.h"

namespace limpid {

static_assert(kLawColours.size() == kLaws, "each law has a colour");
namespace {

double luminance(Rgb c) {
  const auto linear = [](std::uint8_t channel) {
    const double part = channel / 255.0;
    return part <= 0.04045 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b);
}

}  // namespace

double contrast(Rgb one, Rgb other) {
  const auto [dark, light] = std::minmax({luminance(one), luminance(other)});
  return (light + 0.05) / (dark + 0.05);
}

Rgb text_on(Rgb back) {
  constexpr Rgb kBlack{}, kWhite{255, 255, 255};
  return contrast(kBlack, back) > contrast(kWhite, back) ? kBlack : kWhite;
}

}  // namespace limpid
