// Eigenvalues and least squares of matrices of any size, compiled once: Eigen's solvers take
// seconds to compile. Not for ticks: they allocate.
#pragma once

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

}  // namespace limpid
