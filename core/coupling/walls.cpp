#include "core/coupling/walls.h"

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

TipMoved easiest(const Eigen::MatrixXd& J, const Eigen::MatrixXd& M) {
  const auto largest = [](const Mat3& A) {
    return Eigen::SelfAdjointEigenSolver<Mat3>(A, Eigen::EigenvaluesOnly).eigenvalues()[2];
  };
  return {1 / largest(J * M.llt().solve(J.transpose())), std::sqrt(largest(J * J.transpose()))};
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

namespace {

// Stiffest walls that were tried: with exact encoders, and with steps.
constexpr double kTried = 20000, kTriedStepped = 10000;  // [N/m]
constexpr double kTriedTick = 0.001;                     // of these trials [s]
// Bounds of K in m_n over the square of a time [-]. kQuick: of a tick, found with 24 arms, failing
// from 3 on. The others: of a delay that is not known to the law, of a known one, and of one with
// encoder steps that make the estimate jump by more than kJump.
constexpr double kQuick = 2, kUnforeseen = 0.3, kForeseen = 0.2, kForeseenCoarse = 0.08;
constexpr double kJump = 0.01;        // [m/s]
constexpr double kSofter = 1.0 / 25;  // part of a wall that the proxy's inertia may take off
// Largest force that a step of the encoder may make of a wall, and largest speed of a tip inside a
// cell, which in theory swings there with kSwing of step times natural frequency.
constexpr double kStepForce = 0.25, kCellSpeed = 5e-3, kSwing = 0.6;  // [N], [m/s], [-]

// Walls of a tip whose encoders have a step q [m]; t_d: delay of the torque [s].
struct StepWalls {
  double mass, q, t_d;  // [kg, m, s]

  double bandwidth(double K) const { return filter_bandwidth(resting_rate(K, mass, q) / mass, q); }
  // Growth of an error of the position until the torque meets the device.
  double growth(double K) const {
    const double a = bandwidth(K) * t_d;
    return 1 + a + a * a / 2;
  }
  // Stiffest wall of which an error by a step makes at most a force F.
  double by_force(double F) const {
    double low = 0, high = 2 * kTried;
    for (int i = 0; i < 40; ++i) {
      const double K = (low + high) / 2;
      (K * q * growth(K) <= F ? low : high) = K;
    }
    return low;
  }
  double by_cell() const {
    const double w = kCellSpeed / (kSwing * q);
    return mass * w * w;
  }
};

}  // namespace

BoundedWall predictive_wall(const TipMoved& tip, const PredictiveWallSetting& s) {
  const double T = s.at.T, q = s.encoder_step;
  BoundedWall wall{kTried * std::min(1.0, std::pow(kTriedTick / T, 2.5)), WallBound::tried};
  const auto bound = [&](double stiffness, WallBound by) {
    if (stiffness < wall.stiffness) wall = {stiffness, by};
  };
  bound(kQuick * tip.mass / (T * T), WallBound::quick);
  bound(kSofter * s.at.k_vc / (s.inertia_ratio * tip.lever * tip.lever), WallBound::proxy);
  const StepWalls steps{tip.mass, q * tip.lever, s.at.delay};
  if (q > 0) {
    bound(kTriedStepped, WallBound::tried);
    bound(steps.by_force(kStepForce), WallBound::step);
    const double cell = steps.by_cell(), held = steps.by_force(2 * s.friction);
    bound(std::max(cell, held), held > cell ? WallBound::friction : WallBound::cell);
  }
  if (s.at.hand_mass > s.mass_foreseen) {
    const TipAlong along{tip.mass, 0, tip.lever * tip.lever};
    bound(mistaken_wall(along, s.at) / 2, WallBound::hand);
  }
  const auto late = [&](double by, double part) {
    if (by > T / 4) bound(part * tip.mass / (by * by), WallBound::delay);
  };
  late(std::abs(s.at.delay - s.delay_foreseen), kUnforeseen);
  const bool jumps = q > 0 && steps.q * steps.bandwidth(0) > kJump;
  late(s.at.delay, jumps                                     ? kForeseenCoarse
                   : q == 0 && s.at.delay > s.delay_foreseen ? kUnforeseen
                                                             : kForeseen);
  return wall;
}

double line_at_tip(const TipAlong& tip, double k_vc, double b, double t) {
  return 1 / (1 / k_vc + t / b) / tip.lever2;
}

double spring_at_tip(const TipAlong& tip, double k_vc) { return k_vc / tip.lever2; }

}  // namespace limpid
