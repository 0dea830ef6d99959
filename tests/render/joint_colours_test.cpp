// Colours of joints, which people with normal and colour-blind eyes must tell apart.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "render/theme.h"

namespace limpid {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d linear(unsigned hex) {
  Vector3d rgb(hex >> 16 & 255, hex >> 8 & 255, hex & 255);
  return (rgb / 255).unaryExpr(
      [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); });
}

// CIE L*a*b*, D65.
Vector3d lab(const Vector3d& rgb) {
  Matrix3d to_xyz;
  to_xyz << 0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522, 0.0721750, 0.0193339, 0.1191920,
      0.9503041;
  const Vector3d f =
      (to_xyz * rgb).cwiseQuotient(Vector3d(0.95047, 1, 1.08883)).unaryExpr([](double t) {
        return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116;
      });
  return {116 * f.y() - 16, 500 * (f.x() - f.y()), 200 * (f.y() - f.z())};
}

// Responses of normal eyes, and of eyes without red or green cones, by Machado, Oliveira and
// Fernandes (2009).
std::array<Matrix3d, 3> eyes() {
  Matrix3d protan, deutan;
  protan << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116,
      1.051998;
  deutan << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940,
      0.968881;
  return {Matrix3d::Identity(), protan, deutan};
}

double least_distance(unsigned a, unsigned b) {
  double least = 1e9;
  for (const Matrix3d& eye : eyes()) {
    const auto seen = [&](unsigned hex) {
      return lab((eye * linear(hex)).cwiseMax(0).cwiseMin(1));
    };
    least = std::min(least, (seen(a) - seen(b)).norm());
  }
  return least;
}

double contrast(unsigned a, unsigned b) {
  const Vector3d share(0.2126, 0.7152, 0.0722);
  const auto [low, high] = std::minmax({share.dot(linear(a)), share.dot(linear(b))});
  return (high + 0.05) / (low + 0.05);
}

TEST(JointColours, OfAnArmAreToldApartByEveryEye) {
  constexpr double kPlain = 20, kStill = 9;  // a difference of 2.3 is just visible
  for (const Theme theme : {Theme::dark, Theme::light}) {
    const auto colours = joint_colours(theme);
    for (std::size_t i = 0; i < colours.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_GT(least_distance(colours[i], colours[j]), i < 4 ? kPlain : kStill)
            << i + 1 << " and " << j + 1;
      }
    }
  }
}

TEST(JointColours, StandOutFromTheirPanelAndTheFirstFourFromTheProxy) {
  for (const Theme theme : {Theme::dark, Theme::light}) {
    const bool dark = theme == Theme::dark;
    const unsigned panel = dark ? 0x16191D : 0xF8F9FA, proxy = dark ? 0x56B4E9 : 0x0072B2;
    const auto colours = joint_colours(theme);
    for (const unsigned colour : colours) EXPECT_GT(contrast(colour, panel), 3);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_GT(least_distance(colours[i], proxy), 20);
  }
}

}  // namespace
}  // namespace limpid
