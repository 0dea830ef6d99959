// Colours of the coupling laws: one table, by the law's number in recordings
// (core/coupling/laws.h), for buttons, bands, curves, names of runs and figures. A new law is a
// line at its end.
//
// Each has a contrast of 3 to 1 at least with its background, on black of 7 to 1, and none is a
// thing's colour. People who see no red, no green or no blue tell them apart; on black all differ
// in brightness. A test computes this.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace limpid {

struct LawColour {
  const char* on_light;  // the light theme and paper, "#rrggbb"
  const char* tint;      // on light, for a variant of the law
  const char* on_dark;
  const char* on_black;  // the theme of high contrast
};

// All laws for comparison share a colour: these people could tell no more of them apart.
inline constexpr LawColour kForComparison{"#274060", "#93A5BC", "#6C8EBF", "#EDF0FD"};

inline constexpr std::array<LawColour, 9> kLawColours{{
    {"#6B7280", "#B4B9C2", "#98A3AF", "#9EAEB2"},  // standard
    {"#6A3D9A", "#B79BD3", "#9D72D6", "#B97BF3"},  // proposed
    {"#6B9100", "#B5CC6A", "#A3CC2F", "#7CF226"},  // predictive
    {"#7A2E0E", "#C79A85", "#BF6A40", "#EFB576"},  // tank
    kForComparison,                                // direct
    kForComparison,                                // eba
    kForComparison,                                // popc
    kForComparison,                                // wave
    kForComparison,                                // tdpn
}};

// Returns "#rrggbb" as a number.
constexpr std::uint32_t hex_colour(const char* text) {
  std::uint32_t value = 0;
  for (std::size_t i = 1; text[i] != '\0'; ++i) {
    const char c = text[i];
    const int digit = c <= '9' ? c - '0' : (c <= 'F' ? c - 'A' : c - 'a') + 10;
    value = 16 * value + static_cast<std::uint32_t>(digit);
  }
  return value;
}

}  // namespace limpid
