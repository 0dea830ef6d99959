#include "app/experiments/felt_impedance.h"

#include <numbers>

#include "app/experiments/harmonics.h"

namespace limpid {
namespace {

double omega(double f) { return 2 * std::numbers::pi * f; }

}  // namespace

Impedance measured_impedance(const Session& session, std::size_t from, int joint,
                             const Multisine& shaking) {
  const double T = session.info.tick;
  const auto j = static_cast<std::size_t>(joint);
  // Both are means over the same tick.
  std::vector<double> torque, velocity;
  for (std::size_t k = from; k + 1 < session.size(); ++k) {
    torque.push_back(session.at(k, Column::hand_torque)[j]);
    velocity.push_back((session.at(k + 1, Column::device_position)[j] -
                        session.at(k, Column::device_position)[j]) /
                       T);
  }
  Impedance felt;
  for (const Multisine::Line& line : shaking.lines) {
    const double f = shaking.frequency(line);
    felt.f.push_back(f);
    felt.Z.push_back(amplitude_at(torque, T, f) / amplitude_at(velocity, T, f));
  }
  return felt;
}

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
  return m * s + b_d + coupling * proxy / (coupling + proxy);
}

std::complex<double> FeltJoint::ideal(double f, double eta) const {
  const std::complex<double> s(0, omega(f));
  return eta * (m * s + b()) + K / s;
}

double apparent_inertia(const Impedance& felt, double highest) {
  double ww = 0, wz = 0;
  for (std::size_t i = 0; i < felt.f.size(); ++i) {
    if (felt.f[i] > highest) continue;
    const double w = omega(felt.f[i]);
    ww += w * w;
    wz += w * felt.Z[i].imag();
  }
  return wz / ww;
}

}  // namespace limpid
