#include "core/coupling/felt.h"

#include <algorithm>
#include <numbers>

namespace limpid {
namespace {

double omega(double f) { return 2 * std::numbers::pi * f; }

}  // namespace

std::complex<double> FeltJoint::proposed(double f, double eta, double w_f) const {
  const std::complex<double> s(0, omega(f));
  const std::complex<double> coupling = k_vc / s + b_vc, damper = b_v + k_vc * T / 2;
  const std::complex<double> contact = K / s * std::exp(-s * (b_v / k_vc + T / 2));
  const std::complex<double> observer = w_f / (s + w_f) * std::exp(-s * (1.5 * T));
  return (m * s + b_d + coupling * damper / (coupling + damper) + contact / eta) /
         (1.0 + (1 - eta) / eta * observer);
}

std::complex<double> FeltJoint::standard(double f) const {
  const std::complex<double> s(0, omega(f));
  const std::complex<double> coupling = k_vc / s + b_vc, proxy = b_v + k_vc * T / 2 + K / s;
  // A proxy that moves as the device did a trip ago adds a damper, k_vc trip.
  const std::complex<double> late = coupling * (1.0 - std::exp(-s * trip));
  return m * s + b_d + coupling * (proxy + late) / (coupling + proxy);
}

std::complex<double> FeltJoint::predictive(double f, const AddedMass& added, double damping,
                                           double band, const LateMotors& late) const {
  const std::complex<double> s(0, omega(f));
  const std::complex<double> networks =
      network_impedance(added, band, omega(f)) * std::exp(-s * late.networks);
  const std::complex<double> by_motors =
      (damping * (b_d + b_v) - b_d) * std::exp(-s * late.damping);
  return m * (s + networks) + b_d + by_motors + K / s;
}

std::complex<double> FeltJoint::ideal(double f, double eta) const {
  const std::complex<double> s(0, omega(f));
  return eta * (m * s + b()) + K / s;
}

double FeltJoint::least_damping(double eta, double band) const {
  return std::max(0.0, 1 - eta) * m * omega(band);
}

}  // namespace limpid
