#include "core/coupling/inertia_network.h"

namespace limpid {

std::complex<double> network_impedance(double eta, double band, double w) {
  using N = InertiaShape;
  using Complex = std::complex<double>;
  if (eta >= 1) {
    // The mass moves at g: j w g = X (nu - g), X of its spring and damper.
    const Complex s(0, w), X = N::kGhost * (N::kGhost / s + 2 * N::kZeta);
    return (eta - 1) * s * X / (s + X);
  }
  // From its end: resistor beside the last spring, in series with mass and damper, beside the
  // first.
  const double edge = 2 * std::numbers::pi * band;
  const Complex s(0, w / edge);
  const Complex last = 1.0 / (N::kA3 * s + 1 / N::kR);
  const Complex middle = 1.0 / (N::kA2 * s + N::kR1 + last);
  return edge * (1 - eta) / (N::kA1 * s + middle);
}

}  // namespace limpid
