#include "core/passivity/walls.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace limpid {

TipAlong tip_along(const Eigen::MatrixXd& J, const Eigen::MatrixXd& M, const Eigen::VectorXd& b_d,
                   const Vec3& n) {
  const Eigen::VectorXd lever = J.transpose() * n;
  return {1 / lever.dot(M.llt().solve(lever)), 1 / lever.dot(lever.cwiseQuotient(b_d)),
          lever.squaredNorm()};
}

Vec3 least_damped(const Eigen::MatrixXd& J, const Eigen::VectorXd& b_d) {
  const Mat3 mobility = J * b_d.cwiseInverse().asDiagonal() * J.transpose();
  return Eigen::SelfAdjointEigenSolver<Mat3>(mobility).eigenvectors().col(2);
}

double proposed_wall(const TipAlong& tip, const WallSetting& s) {
  const double b = tip.damping + (s.b_v + s.k_vc * s.T / 2) / tip.lever2 + s.hand_damping;
  return s.eta * b / (s.T / 2 + s.b_v / s.k_vc + s.delay);
}

double every_hands_wall(const TipAlong& tip, double T, double delay) {
  return tip.damping / (T / 2 + delay);
}

double mistaken_wall(const TipAlong& tip, const WallSetting& s) {
  if (s.hand_mass <= 0) return std::numeric_limits<double>::infinity();
  const double walls = 0.2 * tip.mass / s.T;  // the damper that the law gives every wall
  const double b = tip.damping + s.b_v / tip.lever2 + s.hand_damping + walls;
  const double share = s.hand_mass / (tip.mass + s.hand_mass);
  return std::sqrt(2 * b * tip.mass / (std::pow(s.T, 3) * share));
}

double spring_at_tip(const TipAlong& tip, double k_vc) { return k_vc / tip.lever2; }

}  // namespace limpid
