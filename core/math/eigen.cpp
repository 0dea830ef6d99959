#include "core/math/eigen.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <unsupported/Eigen/LevenbergMarquardt>

namespace limpid {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// A miss and its derivative in the form that Eigen's Levenberg-Marquardt asks for.
struct Miss : Eigen::DenseFunctor<double> {
  int operator()(const VectorXd& z, VectorXd& out) const {
    out = miss(z);
    return 0;
  }
  int df(const VectorXd& z, MatrixXd& out) const {
    out = slope(z);
    return 0;
  }

  const std::function<VectorXd(const VectorXd&)>& miss;
  const std::function<MatrixXd(const VectorXd&)>& slope;
};

}  // namespace

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A) { return A.eigenvalues(); }

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(A);
  return {solved.eigenvalues(), solved.eigenvectors()};
}

Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return A.completeOrthogonalDecomposition().solve(b);
}

struct LeastSquares::Factors : Eigen::CompleteOrthogonalDecomposition<MatrixXd> {};

LeastSquares::LeastSquares(const MatrixXd& A) : scale_(A.colwise().norm().transpose()) {
  for (double& s : scale_) s = s > 0 ? 1 / s : 0;
  auto factors = std::make_unique<Factors>();
  factors->setThreshold(1e-9);
  factors->compute(A * scale_.asDiagonal());
  factors_ = std::move(factors);
}

LeastSquares::~LeastSquares() = default;

VectorXd LeastSquares::solve(const VectorXd& b) const {
  return scale_.asDiagonal() * VectorXd(factors_->solve(b));
}

double LeastSquares::miss(const VectorXd& b) const {
  const VectorXd turned = factors_->householderQ().adjoint() * b;
  return turned.tail(turned.size() - factors_->rank()).squaredNorm();
}

MatrixXd LeastSquares::solution() const {
  return scale_.asDiagonal() * MatrixXd(factors_->pseudoInverse());
}

Condensed condensed(const MatrixXd& A, const VectorXd& b) {
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(A);
  const MatrixXd R = qr.matrixQR().topRows(A.cols()).triangularView<Eigen::Upper>();
  return {R * qr.colsPermutation().transpose(),
          VectorXd(qr.householderQ().adjoint() * b).head(A.cols())};
}

MatrixXd inverse(const MatrixXd& A) { return A.inverse(); }

VectorXd least_miss(const std::function<VectorXd(const VectorXd&)>& miss,
                    const std::function<MatrixXd(const VectorXd&)>& slope, const VectorXd& start) {
  VectorXd z = start;
  const auto count = static_cast<int>(miss(z).size());
  Miss of{{static_cast<int>(z.size()), count}, miss, slope};
  Eigen::LevenbergMarquardt<Miss> search(of);
  search.minimize(z);
  return z;
}

}  // namespace limpid
