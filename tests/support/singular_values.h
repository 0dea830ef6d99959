// Singular values, by eigenvalues that are compiled once.
#pragma once

#include <algorithm>

#include "core/math/eigen.h"

namespace limpid::test {

// Returns the singular values of A in rising order; those below 1e-8 of the largest are not exact.
inline Eigen::VectorXd singular_values(const Eigen::MatrixXd& A) {
  const bool wide = A.cols() > A.rows();
  const Eigen::MatrixXd tall = wide ? Eigen::MatrixXd(A.transpose()) : A;
  return symmetric_eigen(tall.transpose() * tall).values.cwiseMax(0).cwiseSqrt();
}

}  // namespace limpid::test
