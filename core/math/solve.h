// Linear solves of joint size, without allocation.
#pragma once

#include <cmath>

#include "core/math/sizes.h"

namespace limpid {

// A^-1 B for a regular A. For three joints the closed-form inverse is several times faster than a
// factorisation.
template <int N, class B>
auto solve(const Mat<N>& A, const B& b) -> typename B::PlainObject {
  if constexpr (N == 3) {
    return A.inverse() * b;
  } else {
    return A.partialPivLu().solve(b);
  }
}

// The lower Cholesky factor, A = L L^T, of a symmetric positive-definite A.
template <int N>
Mat<N> cholesky(const Mat<N>& A) {
  const Eigen::Index n = A.rows();
  Mat<N> L = Mat<N>::Zero(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const double pivot = A(j, j) - L.row(j).head(j).squaredNorm();
    L(j, j) = std::sqrt(pivot);
    for (Eigen::Index i = j + 1; i < n; ++i) {
      L(i, j) = (A(i, j) - L.row(i).head(j).dot(L.row(j).head(j))) / L(j, j);
    }
  }
  return L;
}

}  // namespace limpid
