// Factors and linear solves of joint size, without allocation.
//
// For three joints closed forms are several times faster than factorisations. The loops have their
// longest stride innermost down a column, so that they vectorise for many joints and unroll for
// three.
#pragma once

#include <Eigen/LU>
#include <cmath>
#include <type_traits>

#include "core/math/sizes.h"

namespace limpid {

// A^-1 B for a regular A.
template <int N, class B>
auto solve(const Mat<N>& A, const B& b) -> typename B::PlainObject {
  if constexpr (N == 3) {
    return A.inverse() * b;
  } else {
    return A.partialPivLu().solve(b);
  }
}

// The inverse of a symmetric positive-definite 3 x 3 matrix; only the lower triangle of A is read.
inline Mat3 inverse_symmetric(const Mat3& A) {
  const double a = A(0, 0), b = A(1, 0), c = A(2, 0), d = A(1, 1), e = A(2, 1), f = A(2, 2);
  const double c00 = d * f - e * e, c10 = c * e - b * f, c20 = b * e - c * d;
  const double scale = 1 / (a * c00 + b * c10 + c * c20);
  Mat3 inverse;
  inverse(0, 0) = scale * c00;
  inverse(1, 1) = scale * (a * f - c * c);
  inverse(2, 2) = scale * (a * d - b * b);
  inverse(1, 0) = inverse(0, 1) = scale * c10;
  inverse(2, 0) = inverse(0, 2) = scale * c20;
  inverse(2, 1) = inverse(1, 2) = scale * (b * c - a * e);
  return inverse;
}

// x -= sum of columns[k] * factors[k], in rows from `first` on; of many, four columns at a time.
template <int N, class Column, class Factor>
[[gnu::always_inline]] inline void take_off(Eigen::Index columns, const Column& column,
                                            const Factor& factor, Eigen::Index first,
                                            Eigen::Index rows, double* __restrict x) {
  Eigen::Index k = 0;
  for (; N == kAnyDof && k + 4 <= columns; k += 4) {
    const double *a = column(k), *b = column(k + 1), *c = column(k + 2), *d = column(k + 3);
    const double fa = factor(k), fb = factor(k + 1), fc = factor(k + 2), fd = factor(k + 3);
    for (Eigen::Index i = first; i < rows; ++i) {
      x[i] -= (a[i] * fa + b[i] * fb) + (c[i] * fc + d[i] * fd);
    }
  }
  for (; k < columns; ++k) {
    const double* a = column(k);
    const double fa = factor(k);
    for (Eigen::Index i = first; i < rows; ++i) x[i] -= a[i] * fa;
  }
}

// The lower Cholesky factor, A = L L^T, of a symmetric positive-definite A, whose lower triangle
// alone is read.
template <int N>
Mat<N> cholesky(const Mat<N>& A) {
  const Eigen::Index n = A.rows();
  Mat<N> L = A;
  const auto column = [&](Eigen::Index k) { return L.col(k).data(); };
  for (Eigen::Index j = 0; j < n; ++j) {
    take_off<N>(
        j, column, [&](Eigen::Index k) { return L(j, k); }, j, n, L.col(j).data());
    const double scale = 1 / std::sqrt(L(j, j));
    for (Eigen::Index i = 0; i < j; ++i) L(i, j) = 0;
    for (Eigen::Index i = j; i < n; ++i) L(i, j) *= scale;
  }
  return L;
}

// How that factor moves with A: Adot = Ldot L^T + L Ldot^T, the derivative of the lines above.
template <int N>
Mat<N> cholesky_rate(const Mat<N>& L, const Mat<N>& Adot) {
  const Eigen::Index n = L.rows();
  Mat<N> D = Adot;  // Ldot
  const auto column = [&](Eigen::Index k) { return (k % 2 ? L : D).col(k / 2).data(); };
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto factor = [&](Eigen::Index k) { return (k % 2 ? D : L)(j, k / 2); };
    take_off<N>(2 * j, column, factor, j, n, D.col(j).data());
    const double scale = 1 / L(j, j);
    D(j, j) *= 0.5 * scale;
    const double d = D(j, j);
    for (Eigen::Index i = 0; i < j; ++i) D(i, j) = 0;
    for (Eigen::Index i = j + 1; i < n; ++i) D(i, j) = (D(i, j) - L(i, j) * d) * scale;
  }
  return D;
}

// A symmetric positive-definite matrix, whose lower triangle alone is read, made ready for several
// right sides.
template <int N>
class SymmetricFactor {
 public:
  SymmetricFactor() = default;
  explicit SymmetricFactor(const Mat<N>& A) { compute(A); }
  void compute(const Mat<N>& A) {
    if constexpr (N == 3) {
      factor_ = inverse_symmetric(A);
    } else {
      factor_ = cholesky<N>(A);
    }
  }
  template <class B>
  auto solve(const B& b) const -> typename B::PlainObject {
    if constexpr (N == 3) {
      return factor_ * b;
    } else {
      typename B::PlainObject x = factor_.template triangularView<Eigen::Lower>().solve(b);
      factor_.transpose().template triangularView<Eigen::Upper>().solveInPlace(x);
      return x;
    }
  }

  Mat<N> inverse() const {
    if constexpr (N == 3) {
      return factor_;
    } else {
      // From the last column on: X L = L^-T, which is nothing below its diagonal.
      const Eigen::Index n = factor_.rows();
      Mat<N> X = Mat<N>::Zero(n, n);
      for (Eigen::Index j = n; j-- > 0;) {
        const auto column = [&](Eigen::Index k) { return X.col(j + 1 + k).data(); };
        const auto factor = [&](Eigen::Index k) { return factor_(j + 1 + k, j); };
        take_off<N>(n - j - 1, column, factor, j + 1, n, X.col(j).data());
        const double scale = 1 / factor_(j, j);
        X(j, j) = scale;
        for (Eigen::Index i = j + 1; i < n; ++i) {
          X(i, j) *= scale;
          X(j, i) = X(i, j);
          X(j, j) -= X(i, j) * factor_(i, j);
        }
        X(j, j) *= scale;
      }
      return X;
    }
  }

 private:
  Mat<N> factor_;  // L, or the inverse
};

// A^-1 B for a symmetric positive-definite A, whose lower triangle alone is read.
template <int N, class B>
auto solve_symmetric(const Mat<N>& A, const B& b) -> typename B::PlainObject {
  return SymmetricFactor<N>(A).solve(b);
}

// A regular matrix made ready for several right sides.
template <int N>
class Factor {
 public:
  Factor() = default;
  explicit Factor(const Mat<N>& A) {
    if constexpr (N == 3) {
      factor_ = A.inverse();
    } else {
      factor_.compute(A);
    }
  }
  template <class B>
  auto solve(const B& b) const -> typename B::PlainObject {
    if constexpr (N == 3) {
      return factor_ * b;
    } else {
      return factor_.solve(b);
    }
  }

 private:
  std::conditional_t<N == 3, Mat<N>, Eigen::PartialPivLU<Mat<N>>> factor_;
};

}  // namespace limpid
