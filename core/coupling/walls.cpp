#include "core/coupling/walls.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace limpid {

namespace {

// Response of the tip's velocity to an impulse at the tip, J M^-1 J' [1/kg].
Mat3 mobility_of(const Eigen::MatrixXd& J, const Eigen::MatrixXd& M) {
  return J * M.llt().solve(J.transpose());
}

double largest(const Mat3& A) {
  return Eigen::SelfAdjointEigenSolver<Mat3>(A, Eigen::EigenvaluesOnly).eigenvalues()[2];
}

// n' A^-1 n, of the directions in which A is not zero.
double along_inverse(const Mat3& A, const Vec3& n) {
  constexpr double kNone = 1e-12;  // part of the largest eigenvalue
  const Eigen::SelfAdjointEigenSolver<Mat3> of(A);
  const Vec3 along = of.eigenvectors().transpose() * n, values = of.eigenvalues();
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    if (values[i] > kNone * values[2]) sum += along[i] * along[i] / values[i];
  }
  return sum;
}

}  // namespace

TipAlong tip_along(const Eigen::MatrixXd& J, const Eigen::MatrixXd& M, const Eigen::VectorXd& b_d,
                   const Vec3& n) {
  const Eigen::VectorXd lever = J.transpose() * n;
  const Mat3 mobility = mobility_of(J, M);
  return {1 / n.dot(mobility * n), 1 / lever.dot(lever.cwiseQuotient(b_d)), lever.squaredNorm(),
          along_inverse(mobility, n)};
}

double weight_at_tip(const Eigen::MatrixXd& J, const Eigen::VectorXd& weights, const Vec3& n) {
  const Eigen::VectorXd lever = J.transpose() * n;
  return lever.squaredNorm() / lever.dot(lever.cwiseQuotient(weights));
}

double longest_levers_weight(const Eigen::MatrixXd& J, const Eigen::VectorXd& weights) {
  return largest(J * J.transpose()) /
         largest(J * weights.cwiseInverse().asDiagonal() * J.transpose());
}

TipMoved easiest(const Eigen::MatrixXd& J, const Eigen::MatrixXd& M) {
  return {1 / largest(mobility_of(J, M)), std::sqrt(largest(J * J.transpose()))};
}

double friction_at_tip(const Eigen::MatrixXd& J, const Eigen::VectorXd& friction) {
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < friction.size(); ++i) {
    const double lever = J.col(i).norm();
    if (lever > 0) least = std::min(least, friction[i] / lever);
  }
  return std::isinf(least) ? 0 : least;
}

Vec3 least_damped(const Eigen::MatrixXd& J, const Eigen::VectorXd& b_d) {
  constexpr double kLeast = 1e-9;  // part of the largest damping
  const double most = b_d.size() > 0 ? b_d.maxCoeff() : 0;
  const Eigen::VectorXd b = most > 0 ? Eigen::VectorXd(b_d.cwiseMax(kLeast * most))
                                     : Eigen::VectorXd(Eigen::VectorXd::Ones(b_d.size()));
  const Mat3 mobility = J * b.cwiseInverse().asDiagonal() * J.transpose();
  return Eigen::SelfAdjointEigenSolver<Mat3>(mobility).eigenvectors().col(2);
}

double proposed_wall(const TipAlong& tip, const WallSetting& s) {
  const double b = tip.damping + (s.b_v + s.k_vc * s.T / 2) / tip.lever2 + s.hand_damping;
  return s.eta * b / (s.T / 2 + s.b_v / s.k_vc + s.delay);
}

double every_hands_wall(const TipAlong& tip, double T, double delay) {
  return tip.damping / (T / 2 + delay);
}

double direct_wall(const TipAlong& tip, const WallSetting& s) {
  return (tip.damping + s.hand_damping) / (s.T / 2 + s.delay);
}

double bounded_wall(const TipAlong& tip, const WallSetting& s) {
  return 2 * tip.damping / (s.T + s.delay);
}

double braked_wall(const TipAlong& tip, const WallSetting& s, double part) {
  constexpr double kFound = 0.6;  // part of the bound up to which it was found to be quiet
  const double brake = part * tip.mass / (s.T + s.delay);
  return kFound * (tip.damping + s.hand_damping + brake) / (s.T / 2 + s.delay);
}

double stepped_wall(double q, double friction) {
  constexpr double kHardlyFelt = 0.25;  // [N]
  if (!(q > 0)) return std::numeric_limits<double>::infinity();
  return std::max(kHardlyFelt, 2 * friction) / q;
}

double mistaken_wall(const TipAlong& tip, const WallSetting& s) {
  if (s.hand_mass <= 0) return std::numeric_limits<double>::infinity();
  const double walls = 0.2 * tip.mass / s.T;  // damper that the law gives every wall
  const double b = tip.damping + s.b_v / tip.lever2 + s.hand_damping + walls;
  const double share = s.hand_mass / (tip.mass + s.hand_mass);
  return std::sqrt(2 * b * tip.mass / (std::pow(s.T, 3) * share));
}

double line_at_tip(const TipAlong& tip, double k_vc, double b, double t) {
  return 1 / (1 / k_vc + t / b) / tip.lever2;
}

double spring_at_tip(const TipAlong& tip, double k_vc) { return k_vc / tip.lever2; }

}  // namespace limpid
