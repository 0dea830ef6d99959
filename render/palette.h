// Colours of things, the same in the 3D view, the plots and the panels; the light of the two
// themes. Colour-blind eyes can tell them apart (Okabe and Ito). Values are sRGB, 0 to 1.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "render/theme.h"

namespace limpid {

namespace palette {

using Rgb = std::array<float, 3>;

constexpr Rgb from_hex(unsigned hex) {
  return {static_cast<float>((hex >> 16) & 255u) / 255.0f,
          static_cast<float>((hex >> 8) & 255u) / 255.0f, static_cast<float>(hex & 255u) / 255.0f};
}

// `part` 0 gives a, 1 gives b.
constexpr Rgb mix(const Rgb& a, const Rgb& b, float part) {
  return {a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2])};
}

inline constexpr Rgb kDevice = from_hex(0xE69F00);   // orange
inline constexpr Rgb kProxy = from_hex(0x0072B2);    // blue
inline constexpr Rgb kHand = from_hex(0x009E73);     // green
inline constexpr Rgb kContact = from_hex(0xD55E00);  // vermilion
inline constexpr Rgb kSticks = from_hex(0xCC79A7);   // purple
inline constexpr Rgb kSlips = from_hex(0xF0E442);    // yellow
inline constexpr Rgb kRerun = from_hex(0xF0E442);    // yellow, as in the plots

// Returns a colour as the `lane`-th of several runs at the same time has it: mixed with the text's
// or the background's, as its curves are.
constexpr Rgb of_lane(const Rgb& color, std::size_t lane, Theme theme) {
  const float shade = kLaneShades[lane];
  const bool light = is_dark(theme) == (shade > 0);
  return mix(color, from_hex(light ? 0xDFE4EA : 0x1D2329), shade > 0 ? shade : -shade);
}

}  // namespace palette

// Light and background of a theme. Linear light; the backdrop's two colours are sRGB.
struct Lighting {
  glm::vec4 key, sky, earth, ground, top, bottom;
  glm::vec4 outline;      // around what is highlighted, sRGB
  glm::vec4 object_tint;  // for objects that can be touched, linear; w: amount
};

Lighting lighting_of(Theme theme);

}  // namespace limpid
