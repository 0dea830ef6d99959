#include "core/coupling/inertia_network.h"

#include <algorithm>

namespace limpid {

AddedMass added_mass(double eta, int late, double T, double ratio) {
  using N = InertiaShape;
  if (!(eta > 1)) return {eta, N::kFastest};
  eta = std::min(eta, N::most_eta(ratio));
  constexpr double kOwn = 0.9, kLate = 0.35;  // bounds of beta t [-]
  double most = kOwn / T;                     // bound of beta [rad/s]
  if (late > 0) most = std::min(most, kLate / (late * T));
  const double edge = std::min(N::kFastest, most / (2 * N::kZeta * (eta - 1)));
  if (edge >= N::kSlowest) return {eta, edge};
  return {1 + most / (2 * N::kZeta * N::kSlowest), N::kSlowest};
}

std::complex<double> network_impedance(const AddedMass& added, double band, double w) {
  using N = InertiaShape;
  using Complex = std::complex<double>;
  if (added.eta >= 1) {
    // The mass moves at velocity g: j w g = X (nu - g), X of its spring and damper.
    const Complex s(0, w), X = added.edge * (added.edge / s + 2 * N::kZeta);
    return (added.eta - 1) * s * X / (s + X);
  }
  // The ladder from its end: a resistor beside the last spring; in series with mass and damper;
  // beside the first spring.
  const double edge = 2 * std::numbers::pi * band;
  const Complex s(0, w / edge);
  const Complex last = 1.0 / (N::kA3 * s + 1 / N::kR);
  const Complex middle = 1.0 / (N::kA2 * s + N::kR1 + last);
  return edge * (1 - added.eta) / (N::kA1 * s + middle);
}

}  // namespace limpid
