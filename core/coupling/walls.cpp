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
  const double walls = 0.2 * tip.mass / s.T;  // damper that the law gives every wall
  const double b = tip.damping + s.b_v / tip.lever2 + s.hand_damping + walls;
  const double share = s.hand_mass / (tip.mass + s.hand_mass);
  return std::sqrt(2 * b * tip.mass / (std::pow(s.T, 3) * share));
}

namespace {

// Stiffest walls that were tried: with exact encoders, with steps, and with coarse ones.
constexpr double kTried = 20000, kTriedStepped = 10000, kCoarseWall = 2000;  // [N/m]
// Wall for encoder steps too coarse for a tick, and the speed q/T from which they are.
constexpr double kSoftest = 100, kFineSpeed = 0.3;  // [N/m], [rad/s]
constexpr double kTriedTick = 0.001;                // of these trials [s]
// Bounds of K in m_n over the square of a time [-]. kQuick: of a tick, found with 24 arms, failing
// from 3 on. The others, found with the built-in arm: of a delay that is not known to the law, and
// of a known one without and with encoder steps.
constexpr double kQuick = 2, kUnforeseen = 0.3, kForeseen = 0.2, kForeseenStepped = 0.08;
constexpr double kSofter = 1.0 / 25;  // part of a wall that the proxy's inertia may take off
// Largest change of the tip's velocity by an encoder's step through the wall [m/s]: for arms below
// kLight [kg], held by the damping of the hand, and for heavier ones.
constexpr double kLight = 0.02, kLightShaken = 1e-2, kShaken = 3e-4;

// Stiffest wall for which the predictors have a memory long enough for the encoder's steps and
// short enough for the wall [N/m].
double quiet_wall(const TipMoved& tip, WallMemory wall, double least) {
  const bool light = tip.mass < kLight;
  double low = 1, high = kTried;
  while (high / low > 1.001) {
    wall.K = std::sqrt(low * high);
    const double p = light ? least : wall.possible(tip);
    const bool quiet = p >= least && wall.shaken(p, tip) <= (light ? kLightShaken : kShaken);
    (quiet ? low : high) = wall.K;
  }
  return low;
}

}  // namespace

BoundedWall predictive_wall(const TipMoved& tip, const PredictiveWallSetting& s) {
  const double T = s.at.T, q = s.encoder_step;
  BoundedWall wall{kTried * std::min(1.0, std::pow(kTriedTick / T, 2.5)), WallBound::tried};
  const auto bound = [&](double stiffness, WallBound by) {
    if (stiffness < wall.stiffness) wall = {stiffness, by};
  };
  bound(kQuick * tip.mass / (T * T), WallBound::quick);
  bound(kSofter * s.at.k_vc / (s.inertia_ratio * tip.lever * tip.lever), WallBound::proxy);
  if (q > 0) {
    bound(kTriedStepped, WallBound::encoder);
    bound(quiet_wall(tip, {0, T, q, s.gains.damping}, s.gains.p), WallBound::encoder);
    if (!s.coarse && q > kFineSpeed * T) bound(kSoftest, WallBound::rough);
  }
  if (s.coarse) bound(kCoarseWall, WallBound::encoder);
  if (s.at.hand_mass > s.mass_foreseen) {
    const TipAlong along{tip.mass, 0, tip.lever * tip.lever};
    bound(mistaken_wall(along, s.at) / 2, WallBound::hand);
  }
  const auto late = [&](double by, double part) {
    if (by > T / 4) bound(part * tip.mass / (by * by), WallBound::delay);
  };
  late(std::abs(s.at.delay - s.delay_foreseen), kUnforeseen);
  late(s.at.delay, s.at.delay > s.delay_foreseen ? kUnforeseen
                   : q > 0                       ? kForeseenStepped
                                                 : kForeseen);
  return wall;
}

double spring_at_tip(const TipAlong& tip, double k_vc) { return k_vc / tip.lever2; }

}  // namespace limpid
