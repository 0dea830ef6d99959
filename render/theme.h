// Themes of picture and panels: dark, light, and high contrast. Joints' colours in each.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/lanes.h"

namespace limpid {

// Shades of what belongs to each lane: above 0 towards the text's colour, below 0 towards the
// background.
inline constexpr std::array kLaneShades{0.0f, 0.55f, -0.4f};
static_assert(kLaneShades.size() == kMostLanes);

enum class Theme : std::uint8_t { dark, light, contrast };

// Returns whether the theme's background is dark. High contrast is white and bright on black.
constexpr bool is_dark(Theme theme) { return theme != Theme::light; }

// Colours of the joints in the 3D view and the plots: 0xRRGGBB, sRGB. Eyes of every kind tell the
// first four from each other and from the proxy.
constexpr std::array<unsigned, 7> joint_colours(Theme theme) {
  using Seven = std::array<unsigned, 7>;
  return is_dark(theme)
             ? Seven{0xC7F780, 0x8D6BFF, 0x2FA084, 0xFFB0C8, 0xA8763E, 0xEEF3FF, 0x7F93AD}
             : Seven{0x6F7D12, 0x4A2FC8, 0x4A1F10, 0x1F8F74, 0xB0508F, 0x20263F, 0x8A6A5A};
}

}  // namespace limpid
