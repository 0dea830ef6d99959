#include "core/coupling/eta_min.h"

#include <algorithm>
#include <cmath>

#include "core/math/eigen.h"

namespace limpid {

std::complex<double> locked_response(const LockedMode& mode, double eta, double w) {
  const std::complex<double> s(0, w);
  return (1.0 + (1 - eta) / eta * mode.w_f() / (s + mode.w_f())) / (mode.m * s + mode.b);
}

double eta_min(const LockedMode& mode) { return mode.w_f() / (mode.w_c() + mode.w_f()); }

double eta_min_band(const LockedMode& mode, double w_b) {
  const double w_f = mode.w_f();
  const double w_c = mode.w_c();
  return std::max(0.0, (w_f - w_c * w_f * w_f / (w_b * w_b)) / (w_c + w_f));
}

double eta_min_grip(const LockedMode& mode, double k_h, double b_h) {
  // m s^3 + A s^2 + (B + b_h w_f/eta) s + k_h w_f/eta is stable if
  // A (B + b_h w_f/eta) > m k_h w_f/eta.
  const double w_f = mode.w_f();
  const double A = mode.m * w_f + mode.b + b_h;
  const double B = mode.b * w_f + k_h;
  return std::max(0.0, w_f * (mode.m * k_h - A * b_h) / (A * B));
}

std::vector<LockedMode> locked_modes(const Eigen::MatrixXd& M_L, const Eigen::VectorXd& b,
                                     double alpha) {
  const SymmetricEigen modes = symmetric_eigen(M_L);
  std::vector<LockedMode> result;
  for (Eigen::Index i = 0; i < M_L.rows(); ++i) {
    const auto u = modes.vectors.col(i);
    result.push_back({modes.values[i], u.dot(b.cwiseProduct(u)), alpha});
  }
  return result;
}

Eigen::VectorXcd grip_poles(const Eigen::MatrixXd& M_L, const Eigen::VectorXd& b, double alpha,
                            double eta, const Eigen::MatrixXd& K_h, const Eigen::MatrixXd& B_h) {
  const Eigen::Index n = M_L.rows();
  const Eigen::MatrixXd M_inverse = inverse(M_L);
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n, n);
  const Eigen::MatrixXd D = b.asDiagonal();
  // x' = v;  M v' = -(b + B_h) v - K_h x + (1-eta)/eta f_hat;  f_hat' = alpha M^-1 (f - f_hat)
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  A.block(0, n, n, n) = I;
  A.block(n, 0, n, n) = -M_inverse * K_h;
  A.block(n, n, n, n) = -M_inverse * (D + B_h);
  A.block(n, 2 * n, n, n) = (1 - eta) / eta * M_inverse;
  A.block(2 * n, 0, n, n) = -alpha * M_inverse * K_h;
  A.block(2 * n, n, n, n) = -alpha * M_inverse * B_h;
  A.block(2 * n, 2 * n, n, n) = -alpha * M_inverse;
  return eigenvalues(A);
}

double eta_min_grip(const Eigen::MatrixXd& M_L, const Eigen::VectorXd& b, double alpha,
                    const Eigen::MatrixXd& K_h, const Eigen::MatrixXd& B_h) {
  const auto stable = [&](double eta) {
    const Eigen::VectorXcd poles = grip_poles(M_L, b, alpha, eta, K_h, B_h);
    // Directions that the grip does not hold have a pole at zero, to round-off.
    return poles.real().maxCoeff() < 1e-9 * poles.cwiseAbs().maxCoeff();
  };
  double low = 1e-6, high = 1;  // eta = 1 has no feedforward of the hand: stable
  if (stable(low)) return 0;
  while (high - low > 1e-6) {
    const double middle = (low + high) / 2;
    (stable(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace limpid
