// Eigenvalues and least squares of matrices of any size, compiled once: Eigen's solvers take
// seconds to compile. Not for ticks: they allocate.
#pragma once

#include <functional>
#include <memory>

#include "core/math/sizes.h"

namespace limpid {

// Eigenvalues of a square matrix, in no order.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A);

// Eigenvalues of a symmetric matrix in rising order, and unit eigenvectors, a column each.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A);

// Returns the shortest z of those with the least |A z - b|.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

// Least squares solutions of A z = b for many b. Columns are scaled to one length; a direction that
// A hardly answers to, less than 1e-9 of the strongest, is left out.
class LeastSquares {
 public:
  explicit LeastSquares(const Eigen::MatrixXd& A);
  ~LeastSquares();
  LeastSquares(const LeastSquares&) = delete;
  LeastSquares& operator=(const LeastSquares&) = delete;

  // Returns the z with the least |A z - b|.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  // Returns the square of the least |A z - b|.
  double miss(const Eigen::VectorXd& b) const;
  // Returns the matrix that gives z from b; one row of it for each column of A.
  Eigen::MatrixXd solution() const;

 private:
  struct Factors;
  Eigen::VectorXd scale_;
  std::unique_ptr<const Factors> factors_;
};

// Equations R z = y, R square, whose squared miss is that of A z = b but for a constant. A has at
// least as many rows as columns.
struct Condensed {
  Eigen::MatrixXd R;
  Eigen::VectorXd y;
};
Condensed condensed(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

// Returns the inverse of a square matrix.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& A);

// Returns the z near `start` with the least |miss(z)|, found after Levenberg and Marquardt. `slope`
// is the derivative of the miss, a row for each of its numbers.
Eigen::VectorXd least_miss(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& miss,
                           const std::function<Eigen::MatrixXd(const Eigen::VectorXd&)>& slope,
                           const Eigen::VectorXd& start);

}  // namespace limpid
