#include "core/coupling/two_port.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/math/elementary.h"

namespace limpid {
namespace {

using Complex = std::complex<double>;

// A delay by `ticks` of T at f.
Complex later(double ticks, double T, double f) {
  const double angle = -2 * std::numbers::pi * f * T * ticks;
  return {cosine(angle), sine(angle)};
}

// Sum over all ticks before this one, 1/(z - 1).
Complex summed(double T, double f) {
  const double half = std::numbers::pi * f * T;
  return {-0.5, -0.5 * cosine(half) / sine(half)};
}

}  // namespace

TwoPort spring_two_port(const SpringDamper& gains, const SampledJoint& joint, double f) {
  const double T = joint.T;
  const Complex spring = gains.k_vc * T * summed(T, f), held = spring + gains.b_vc * later(1, T, f);
  const Complex at_proxy = spring + gains.k_vc * T / 2 + gains.b_vc + gains.b_v;
  return {joint.b_d + later(joint.delay, T, f) * held, at_proxy,
          later(joint.delay + 2 * joint.link, T, f) * held * held};
}

TwoPort device_two_port(const SampledJoint& joint, double f) {
  return {joint.b_d, 0, -later(1 + joint.delay, joint.T, f)};
}

double llewellyn(const TwoPort& p) {
  const double one = p.one.real(), two = p.two.real(), across = std::abs(p.across);
  if (across == 0) {
    const double infinite = std::numeric_limits<double>::infinity();
    return std::min(one, two) >= 0 ? infinite : -infinite;
  }
  const double damping = std::min(one, two) < 0 ? -std::abs(one * two) : one * two;
  return (2 * damping - p.across.real()) / across;
}

Llewellyn llewellyn(const std::function<TwoPort(double)>& two_port, double T) {
  constexpr int kFrequencies = 2000;
  constexpr double kLowest = 1e-4;  // of half the loop's rate
  constexpr double kRoundOff = 1e-9;
  const double half = 0.5 / T;
  Llewellyn found{std::numeric_limits<double>::infinity(), half, std::nullopt};
  for (int i = 0; i <= kFrequencies; ++i) {
    const double f = half * power(kLowest, 1 - static_cast<double>(i) / kFrequencies);
    const double value = llewellyn(two_port(f));
    if (value < found.least) {
      found.least = value;
      found.frequency = f;
    }
    if (value < 1 - kRoundOff && !found.fails_from) found.fails_from = f;
  }
  return found;
}

}  // namespace limpid
