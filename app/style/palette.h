// Colours of things, the same in the 3D view, the plots and the panels.
//
// The inks of things are Okabe and Ito's palette, which colour-blind eyes tell apart too, each in a
// tint that reads well on its background. Red is kept for broken promises.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "app/style/law_colours.h"
#include "render/theme.h"

namespace limpid {

struct Rgb {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;

  friend constexpr bool operator==(Rgb, Rgb) = default;
};

constexpr Rgb rgb(std::uint32_t hex) {
  return {static_cast<std::uint8_t>(hex >> 16), static_cast<std::uint8_t>(hex >> 8),
          static_cast<std::uint8_t>(hex)};
}

// `part` 0 gives a, 1 gives b.
constexpr Rgb mix(Rgb a, Rgb b, float part) {
  const auto blend = [part](std::uint8_t from, std::uint8_t to) {
    const auto f = static_cast<float>(from);
    const float blended = f + (static_cast<float>(to) - f) * part;
    return static_cast<std::uint8_t>(blended + 0.5f);  // NOLINT(bugprone-incorrect-roundings)
  };
  return {blend(a.r, b.r), blend(a.g, b.g), blend(a.b, b.b)};
}

enum class Ink : std::uint8_t {
  device,
  proxy,
  hand,
  contact,
  energy,
  neutral,
  rerun,    // all of a second run
  joint_1,  // and so on, one for each joint
  joint_7 = joint_1 + 6,
  count_
};

using Inks = std::array<Rgb, static_cast<std::size_t>(Ink::count_)>;

// Returns the inks of things, up to the joints', and those of the joints as in the 3D view.
constexpr Inks with_joints(const std::array<Rgb, static_cast<std::size_t>(Ink::joint_1)>& things,
                           Theme theme) {
  Inks inks{};
  std::size_t i = 0;
  for (const Rgb thing : things) inks[i++] = thing;
  for (const unsigned joint : joint_colours(theme)) inks[i++] = rgb(joint);
  return inks;
}

struct Palette {
  Rgb backdrop;  // behind the panels
  Rgb panel;
  Rgb raised;  // pop-ups, tooltips, legends
  Rgb frame;   // sliders, inputs, buttons
  Rgb frame_hovered;
  Rgb frame_active;
  Rgb chosen;  // behind what is chosen in a list
  Rgb border;
  Rgb grid;
  Rgb axis;  // the zero line and ticks
  Rgb text;
  Rgb muted;
  Rgb accent;  // for what is switched on; no thing's own colour
  Rgb broken;
  Inks inks;
  const char* LawColour::*laws = &LawColour::on_light;
  bool dark = false;
};

inline constexpr Palette kDarkPalette{
    .backdrop = rgb(0x0f1114),
    .panel = rgb(0x16191d),
    .raised = rgb(0x1e2227),
    .frame = rgb(0x252a30),
    .frame_hovered = rgb(0x2f353d),
    .frame_active = rgb(0x3a424c),
    .chosen = rgb(0x252a30),
    .border = rgb(0x2b3138),
    .grid = rgb(0x23282e),
    .axis = rgb(0x56606b),
    .text = rgb(0xdfe4ea),
    .muted = rgb(0x8f99a4),
    .accent = rgb(0xc3ccd6),
    .broken = rgb(0xff5263),
    .inks = with_joints({rgb(0xe69f00), rgb(0x56b4e9), rgb(0x1fb98d), rgb(0xe8702a), rgb(0xd48ab2),
                         rgb(0xb4bcc6), rgb(0xf0e442)},
                        Theme::dark),
    .laws = &LawColour::on_dark,
    .dark = true,
};

inline constexpr Palette kLightPalette{
    .backdrop = rgb(0xe9ebee),
    .panel = rgb(0xf8f9fa),
    .raised = rgb(0xffffff),
    .frame = rgb(0xe7eaee),
    .frame_hovered = rgb(0xdadfe5),
    .frame_active = rgb(0xcbd2da),
    .chosen = rgb(0xe7eaee),
    .border = rgb(0xd3d8de),
    .grid = rgb(0xe4e7eb),
    .axis = rgb(0x98a1ab),
    .text = rgb(0x1d2329),
    .muted = rgb(0x5f6973),
    .accent = rgb(0x39424c),
    .broken = rgb(0xc8102e),
    .inks = with_joints({rgb(0xc98600), rgb(0x0072b2), rgb(0x00855f), rgb(0xd55e00), rgb(0xb8619a),
                         rgb(0x59636e), rgb(0x8a7d00)},
                        Theme::light),
};

// High contrast: text has 7 to 1 at least on everything behind it, and inks differ in brightness.
inline constexpr Palette kContrastPalette{
    .backdrop = rgb(0x000000),
    .panel = rgb(0x000000),
    .raised = rgb(0x000000),
    .frame = rgb(0x101010),
    .frame_hovered = rgb(0x2a2a2a),
    .frame_active = rgb(0x3d3d3d),
    .chosen = rgb(0x595959),
    .border = rgb(0xc0c0c0),
    .grid = rgb(0x4a4a4a),
    .axis = rgb(0xc0c0c0),
    .text = rgb(0xffffff),
    .muted = rgb(0xdcdcdc),
    .accent = rgb(0xffff00),
    .broken = rgb(0xff7a86),
    .inks = with_joints({rgb(0xffb534), rgb(0x5dbbff), rgb(0x00f279), rgb(0xff814b), rgb(0xff46e0),
                         rgb(0xe2e5e7), rgb(0xfffc9a)},
                        Theme::contrast),
    .laws = &LawColour::on_black,
    .dark = true,
};

constexpr const Palette& palette(Theme theme) {
  switch (theme) {
    case Theme::light: return kLightPalette;
    case Theme::contrast: return kContrastPalette;
    case Theme::dark: break;
  }
  return kDarkPalette;
}

constexpr Rgb shaded(const Palette& palette, Rgb pure, float shade) {
  return shade >= 0 ? mix(pure, palette.text, shade) : mix(pure, palette.panel, -shade);
}
// Returns an ink. `shade` tells curves of one thing apart, such as its joints: above 0 towards the
// text's colour, below 0 towards the background; -1 to 1.
constexpr Rgb ink(const Palette& palette, Ink which, float shade = 0) {
  return shaded(palette, palette.inks[static_cast<std::size_t>(which)], shade);
}

// Returns the ink of a coupling law by its number; a number without a law has no colour of its own.
constexpr Rgb law_ink(const Palette& palette, int law) {
  const auto i = static_cast<std::size_t>(law);
  if (law < 0 || i >= kLawColours.size()) return palette.muted;
  return rgb(hex_colour(kLawColours[i].*palette.laws));
}

// Returns the contrast from 1 to 21 by WCAG 2.
double contrast(Rgb one, Rgb other);
// Returns black or white, whichever reads better on a colour: 4.5 to 1 at least.
Rgb text_on(Rgb back);

}  // namespace limpid
