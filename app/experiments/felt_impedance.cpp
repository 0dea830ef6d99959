#include "app/experiments/felt_impedance.h"

#include <numbers>

#include "app/experiments/harmonics.h"

namespace limpid {
namespace {

double omega(double f) { return 2 * std::numbers::pi * f; }

// A joint's human torque and velocity, both means over the same tick.
class Shaken {
 public:
  Shaken(const Session& session, std::size_t from, int joint) : T_(session.info.tick) {
    const auto j = static_cast<std::size_t>(joint);
    for (std::size_t k = from; k + 1 < session.size(); ++k) {
      torque_.push_back(session.at(k, Column::hand_torque)[j]);
      velocity_.push_back((session.at(k + 1, Column::device_position)[j] -
                           session.at(k, Column::device_position)[j]) /
                          T_);
    }
  }
  std::complex<double> torque_at(double f) const { return amplitude_at(torque_, T_, f); }
  std::complex<double> velocity_at(double f) const { return amplitude_at(velocity_, T_, f); }

 private:
  double T_;
  std::vector<double> torque_, velocity_;
};

}  // namespace

Impedance measured_impedance(const Session& session, std::size_t from, int joint,
                             const Multisine& shaking) {
  const Shaken shaken(session, from, joint);
  Impedance felt;
  for (const Multisine::Line& line : shaking.lines) {
    const double f = shaking.frequency(line);
    felt.f.push_back(f);
    felt.Z.push_back(shaken.torque_at(f) / shaken.velocity_at(f));
  }
  return felt;
}

std::vector<FeltMotion> measured_motion(const Session& session, std::size_t from,
                                        const Eigen::MatrixXd& M, const Multisine& shaking) {
  std::vector<Shaken> joints;
  for (int j = 0; j < session.info.dof; ++j) joints.emplace_back(session, from, j);
  std::vector<FeltMotion> felt;
  for (const Multisine::Line& line : shaking.lines) {
    const double f = shaking.frequency(line);
    Eigen::VectorXcd torque(M.rows()), velocity(M.rows());
    for (Eigen::Index j = 0; j < M.rows(); ++j) {
      torque[j] = joints[static_cast<std::size_t>(j)].torque_at(f);
      velocity[j] = joints[static_cast<std::size_t>(j)].velocity_at(f);
    }
    const std::complex<double> power = velocity.dot(torque);
    const double moving = velocity.dot(M * velocity).real(), speed2 = velocity.squaredNorm();
    felt.push_back({f, power.imag() / (omega(f) * moving), power.real() / speed2, moving / speed2});
  }
  return felt;
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
