#include <gtest/gtest.h>

#include <cmath>

#include "app/style/palette.h"
#include "app/style/sliders.h"

namespace limpid {
namespace {

TEST(ParameterSlider, PlaceAndValueAreInverse) {
  for (const ParameterInfo& info : parameter_table()) {
    for (double place = 0; place <= 1; place += 0.125) {
      const double value = slider_value(info, place);
      EXPECT_GE(value, info.slider_minimum) << info.key;
      EXPECT_LE(value, info.slider_maximum * (1 + 1e-12)) << info.key;
      if (info.kind == FieldInfo::Kind::number) {
        EXPECT_NEAR(slider_place(info, value), place, 1e-9) << info.key;
      }
    }
  }
}

TEST(ParameterSlider, MiddleOfALogarithmicSliderIsTheGeometricMean) {
  const ParameterInfo& eta = *find_parameter("coupling.eta");
  ASSERT_TRUE(eta.logarithmic);
  EXPECT_NEAR(slider_value(eta, 0.5), std::sqrt(eta.slider_minimum * eta.slider_maximum), 1e-12);
}

TEST(ParameterSlider, NumbersOfEveryKindOfFieldComeBack) {
  const Parameters paper;
  for (const ParameterInfo& info : parameter_table()) {
    Parameters other;
    const double number = parameter_number(paper, info);
    set_parameter_number(other, info, number);
    if (std::isnan(number)) {
      EXPECT_TRUE(std::isnan(parameter_number(other, info))) << info.key;
    } else {
      EXPECT_EQ(parameter_number(other, info), number) << info.key;
    }
  }
}

TEST(ParameterSlider, HoldsValuesWithinTheAllowedRange) {
  Parameters p;
  const ParameterInfo& eta = *find_parameter("coupling.eta");
  set_parameter_number(p, eta, 1e9);
  EXPECT_EQ(p.eta, eta.maximum);
  set_parameter_number(p, *find_parameter("coupling.kind"), 0);
  EXPECT_EQ(p.kind, CouplingKind::standard);
}

// Relative luminance and contrast as WCAG 2 defines them.
double luminance_by_wcag(Rgb c) {
  const auto linear = [](std::uint8_t byte) {
    const double x = byte / 255.0;
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b);
}

double contrast_by_wcag(Rgb a, Rgb b) {
  const double high = std::max(luminance_by_wcag(a), luminance_by_wcag(b));
  const double low = std::min(luminance_by_wcag(a), luminance_by_wcag(b));
  return (high + 0.05) / (low + 0.05);
}

TEST(Palette, TextAndInksAreReadableOnTheirBackground) {
  for (const Palette& p : {kDarkPalette, kLightPalette}) {
    EXPECT_GT(contrast_by_wcag(p.text, p.panel), 7);
    EXPECT_DOUBLE_EQ(contrast(p.text, p.panel), contrast_by_wcag(p.text, p.panel));
    EXPECT_GT(contrast_by_wcag(p.muted, p.panel), 4.5);
    EXPECT_GT(contrast_by_wcag(p.broken, p.panel), 4.5);
    for (const Rgb each : p.inks) {
      EXPECT_GT(contrast_by_wcag(each, p.panel), 2.8);
    }
  }
}

}  // namespace
}  // namespace limpid
