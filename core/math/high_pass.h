// High-pass filter of sampled signals.
#pragma once

#include <array>
#include <numbers>

#include "core/math/elementary.h"

namespace limpid {

// Butterworth's high pass of fourth order: two sections of second order, each the bilinear
// transform of s^2 / (s^2 + s w/Q + w^2).
class HighPass {
 public:
  // Passes frequencies above `corner` [Hz], of samples at `rate` [Hz].
  HighPass(double corner, double rate) {
    constexpr double kQ[] = {0.54119610014619698, 1.3065629648763766};
    const double w = 2 * std::numbers::pi * corner / rate;
    for (std::size_t i = 0; i < 2; ++i) {
      const double slope = sine(w) / (2 * kQ[i]), a0 = 1 + slope;
      sections_[i].b = (1 + cosine(w)) / 2 / a0;
      sections_[i].a1 = -2 * cosine(w) / a0;
      sections_[i].a2 = (1 - slope) / a0;
    }
  }

  double operator()(double x) {
    for (Section& s : sections_) x = s.pass(x);
    return x;
  }

 private:
  struct Section {
    double b = 0, a1 = 0, a2 = 0, z1 = 0, z2 = 0;
    double pass(double x) {
      const double y = b * x + z1;
      z1 = -2 * b * x - a1 * y + z2;
      z2 = b * x - a2 * y;
      return y;
    }
  };
  std::array<Section, 2> sections_;
};

}  // namespace limpid
