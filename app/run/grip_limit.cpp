#include "app/run/grip_limit.h"

#include <Eigen/LU>

#include "core/math/eigen.h"

namespace limpid {
namespace {

// x1' = v1;  x2' = (k_vc (x1 - x2) + b_vc v1) / (b_v + b_vc);  f_hat' = alpha M^-1 (f - f_hat);
// M v1' = f - b_d v1 - k_vc (x1 - x2) - b_vc (v1 - x2') + (1 - eta)/eta f_hat;  f = -K_h x1
bool stable(const Eigen::MatrixXd& M_L, const Eigen::VectorXd& b_d, const Parameters& p,
            const Eigen::MatrixXd& K_h, double eta) {
  const Eigen::Index n = M_L.rows();
  const Eigen::MatrixXd W = M_L.inverse(), I = Eigen::MatrixXd::Identity(n, n);
  const double spring = p.k_vc / (p.b_v + p.b_vc), drag = p.b_vc / (p.b_v + p.b_vc);
  const double k = p.k_vc - p.b_vc * spring, b = p.b_vc - p.b_vc * drag;
  const Eigen::MatrixXd D = Eigen::MatrixXd(b_d.asDiagonal()) + b * I;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(4 * n, 4 * n);  // x1, v1, f_hat, x2
  A.block(0, n, n, n) = I;
  A.block(n, 0, n, n) = -W * (K_h + k * I);
  A.block(n, n, n, n) = -W * D;
  A.block(n, 2 * n, n, n) = (1 - eta) / eta * W;
  A.block(n, 3 * n, n, n) = k * W;
  A.block(2 * n, 0, n, n) = -p.alpha * W * K_h;
  A.block(2 * n, 2 * n, n, n) = -p.alpha * W;
  A.block(3 * n, 0, n, n) = spring * I;
  A.block(3 * n, n, n, n) = drag * I;
  A.block(3 * n, 3 * n, n, n) = -spring * I;
  const Eigen::VectorXcd poles = eigenvalues(A);
  return poles.real().maxCoeff() < 1e-9 * poles.cwiseAbs().maxCoeff();
}

}  // namespace

double eta_min_compliant(const Eigen::MatrixXd& M_L, const Eigen::VectorXd& b_d,
                         const Parameters& p, const Eigen::MatrixXd& K_h) {
  double low = 1e-6, high = 1;
  while (high - low > 1e-6) {
    const double middle = (low + high) / 2;
    (stable(M_L, b_d, p, K_h, middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace limpid
