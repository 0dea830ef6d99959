// Colours against people's ability to tell them apart, computed here and not by the program.
#include "app/style/palette.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/coupling/laws.h"

namespace limpid {
namespace {

using Three = std::array<double, 3>;
using Seen = std::array<Three, 3>;

// Responses of eyes with all cones, and without those for long, middle or short waves: Machado,
// Oliveira and Fernandes 2009, severity 1, on linear RGB.
constexpr std::array<Seen, 4> kEyes{{
    {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
    {{{0.152286, 1.052583, -0.204868},
      {0.114503, 0.786281, 0.099216},
      {-0.003882, -0.048116, 1.051998}}},
    {{{0.367322, 0.860646, -0.227968},
      {0.280085, 0.672501, 0.047413},
      {-0.011820, 0.042940, 0.968881}}},
    {{{1.255528, -0.076749, -0.178779},
      {-0.078411, 0.930809, 0.147602},
      {0.004733, 0.691367, 0.303900}}},
}};

Three linear(Rgb c) {
  const auto of = [](std::uint8_t v) {
    const double x = v / 255.0;
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
  };
  return {of(c.r), of(c.g), of(c.b)};
}

double luminance(Rgb c) {
  const Three l = linear(c);
  return 0.2126 * l[0] + 0.7152 * l[1] + 0.0722 * l[2];
}

double ratio(Rgb a, Rgb b) {
  const double x = luminance(a), y = luminance(b);
  return (std::max(x, y) + 0.05) / (std::min(x, y) + 0.05);
}

// CIE L*a*b*, white point D65.
Three lab(Rgb c, const Seen& eye) {
  const Three in = linear(c);
  Three l{};
  for (std::size_t i = 0; i < 3; ++i) {
    l[i] = std::clamp(eye[i][0] * in[0] + eye[i][1] * in[1] + eye[i][2] * in[2], 0.0, 1.0);
  }
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
  const double x = f((0.4124 * l[0] + 0.3576 * l[1] + 0.1805 * l[2]) / 0.95047);
  const double y = f(0.2126 * l[0] + 0.7152 * l[1] + 0.0722 * l[2]);
  const double z = f((0.0193 * l[0] + 0.1192 * l[1] + 0.9505 * l[2]) / 1.08883);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

double apart(Rgb a, Rgb b, const Seen& eye) {
  const Three one = lab(a, eye), other = lab(b, eye);
  return std::hypot(one[0] - other[0], one[1] - other[1], one[2] - other[2]);
}

class PaletteOf : public testing::TestWithParam<Theme> {
 protected:
  const Palette& p = palette(GetParam());
};
INSTANTIATE_TEST_SUITE_P(Themes, PaletteOf,
                         testing::Values(Theme::dark, Theme::light, Theme::contrast));

TEST_P(PaletteOf, HasAColourForEveryLaw) {
  ASSERT_GE(kLawColours.size(), kLaws);
  for (int law = 0; law < kLaws; ++law) EXPECT_NE(law_ink(p, law), p.muted);
  EXPECT_EQ(law_ink(p, -1), p.muted);
  EXPECT_EQ(law_ink(p, 200), p.muted);
}

TEST_P(PaletteOf, ShowsLawsAtThreeToOneOnAllThatIsBehindThem) {
  for (int law = 0; law < static_cast<int>(kLawColours.size()); ++law) {
    for (const Rgb back : {p.panel, p.raised, p.backdrop}) {
      EXPECT_GE(ratio(law_ink(p, law), back), 3) << law;
    }
    // Contrast of the text on a button of this colour.
    EXPECT_GE(ratio(text_on(law_ink(p, law)), law_ink(p, law)), 4.5) << law;
  }
}

// Two colours that differ by 2.3 are just told apart side by side; the bound is five times that.
TEST_P(PaletteOf, TellsLawsApartForEveryEye) {
  for (const Seen& eye : kEyes) {
    for (int one = 0; one < static_cast<int>(kLawColours.size()); ++one) {
      for (int other = 0; other < one; ++other) {
        const auto compares = [](int law) {
          return info(static_cast<CouplingKind>(law)).for_comparison;
        };
        if (compares(one) && compares(other)) continue;  // these share a colour
        EXPECT_GE(apart(law_ink(p, one), law_ink(p, other), eye), 12) << one << " " << other;
      }
    }
  }
}

// A law has no thing's colour: not that of device, proxy, hand, contact, energy or a broken
// promise.
TEST_P(PaletteOf, HasNoLawInAThingsColour) {
  for (int law = 0; law < static_cast<int>(kLawColours.size()); ++law) {
    for (const Ink thing : {Ink::device, Ink::proxy, Ink::hand, Ink::contact, Ink::energy}) {
      EXPECT_GE(apart(law_ink(p, law), ink(p, thing), kEyes[0]), 15)
          << law << " " << static_cast<int>(thing);
    }
    EXPECT_GE(apart(law_ink(p, law), p.broken, kEyes[0]), 25) << law;
  }
}

TEST_P(PaletteOf, KnowsContrastsAsTheyAreComputed) {
  EXPECT_NEAR(contrast(rgb(0), rgb(0xffffff)), 21, 1e-9);
  EXPECT_NEAR(contrast(p.text, p.panel), ratio(p.text, p.panel), 1e-9);
  EXPECT_NEAR(contrast(p.panel, p.text), ratio(p.text, p.panel), 1e-9);
}

// WCAG 2 asks for 7 to 1 of text, and for 3 to 1 of the borders of controls.
TEST(HighContrast, HasTextAtSevenToOneAndBordersOnAllThatIsBehindThem) {
  const Palette& p = palette(Theme::contrast);
  for (const Rgb back : {p.backdrop, p.panel, p.raised, p.frame, p.frame_hovered, p.frame_active}) {
    EXPECT_GE(ratio(p.text, back), 7);
    EXPECT_GE(ratio(p.muted, back), 7);
  }
  EXPECT_GE(ratio(p.text, p.chosen), 7);
  EXPECT_GE(ratio(p.panel, p.accent), 7) << "the word of what is chosen";
  for (const Rgb back : {p.panel, p.raised, p.frame}) {
    EXPECT_GE(ratio(p.broken, back), 7);
    EXPECT_GE(ratio(p.border, back), 3);
  }
  EXPECT_GE(ratio(p.chosen, p.panel), 2.99);
}

// Curves of things, and of laws, differ in brightness by a seventh at least, and their names at
// their ends are read.
TEST(HighContrast, TellsInksApartWithoutColour) {
  const Palette& p = palette(Theme::contrast);
  std::vector<Rgb> things, laws;
  for (int i = 0; i < static_cast<int>(Ink::joint_1); ++i) {
    things.push_back(ink(p, static_cast<Ink>(i)));
  }
  for (int law = 0; law < kLaws; ++law) {
    const Rgb rgb = law_ink(p, law);
    if (std::ranges::find(laws, rgb) == laws.end()) laws.push_back(rgb);
  }
  ASSERT_EQ(laws.size(), 5u);
  for (auto* inks : {&things, &laws}) {
    std::ranges::sort(*inks, {}, luminance);
    EXPECT_GE(ratio(inks->front(), p.panel), 7);
    for (std::size_t i = 1; i < inks->size(); ++i) {
      EXPECT_GE(ratio((*inks)[i - 1], (*inks)[i]), 1.14) << i;
    }
  }
}

TEST(LawColours, AreReadAsTheyAreWritten) {
  EXPECT_EQ(hex_colour("#6A3D9A"), 0x6a3d9au);
  EXPECT_EQ(hex_colour("#ff00aF"), 0xff00afu);
}

}  // namespace
}  // namespace limpid
