// Factors and linear solves of joint size, without allocation. Three joints use closed forms,
// several times faster than factorisations.
#pragma once

#include <Eigen/LU>
#include <array>

#include "core/math/symmetric.h"
#include "core/math/triangular.h"
#include "core/math/wide.h"

namespace limpid {

// Inverse of a symmetric positive-definite 3 x 3 matrix; only the lower triangle of A is read.
template <class S>
Mat3Of<S> inverse_symmetric(const Mat3Of<S>& A) {
  const S a = A(0, 0), b = A(1, 0), c = A(2, 0), d = A(1, 1), e = A(2, 1), f = A(2, 2);
  const S c00 = d * f - e * e, c10 = c * e - b * f, c20 = b * e - c * d;
  const S scale = S(1) / (a * c00 + b * c10 + c * c20);
  Mat3Of<S> inverse;
  inverse(0, 0) = scale * c00;
  inverse(1, 1) = scale * (a * f - c * c);
  inverse(2, 2) = scale * (a * d - b * b);
  inverse(1, 0) = inverse(0, 1) = scale * c10;
  inverse(2, 0) = inverse(0, 2) = scale * c20;
  inverse(2, 1) = inverse(1, 2) = scale * (b * c - a * e);
  return inverse;
}

// Applies `solve` to each column of B, in a work vector whose rows from n on are zero.
template <int N, class B, class Solve>
auto solve_columns(const B& b, const Solve& solve) -> typename B::PlainObject {
  typename B::PlainObject x(b.rows(), b.cols());
  WideVec<N> column(whole_fours(static_cast<int>(b.rows())));
  column.template tail<4>().setZero();
  for (Eigen::Index j = 0; j < b.cols(); ++j) {
    column.head(b.rows()) = b.col(j);
    solve(column.data());
    x.col(j) = column.head(b.rows());
  }
  return x;
}

// Factor of a symmetric positive-definite matrix for several right sides; only its lower triangle
// is read.
template <int N>
class SymmetricFactor {
 public:
  SymmetricFactor() = default;
  explicit SymmetricFactor(const Mat<N>& A) { compute(A); }
  void compute(const Mat<N>& A) { compute_wide(widened<N>(A)); }
  void compute_wide(const Wide<N>& A) {
    if constexpr (N == 3) {
      factor_ = inverse_symmetric(A);
    } else {
      factor_ = A;
      over_.resize(factor_.rows(), Eigen::NoChange);
      wide::factor<N>(factor_.cols(), factor_.data(), over_.data());
    }
  }
  template <class B>
  auto solve(const B& b) const -> typename B::PlainObject {
    if constexpr (N == 3) {
      return factor_ * b;
    } else {
      return solve_columns<N>(
          b, [&](double* x) { wide::solve<N>(factor_.cols(), factor_.data(), over_.data(), x); });
    }
  }
  // L and the inverses of its blocks of four, for loops that merge this solve with others.
  const double* lower() const requires(N != 3) { return factor_.data(); }
  const double* corners() const requires(N != 3) { return over_.data() + over_.rows(); }
  // X becomes X A^-1.
  void divide(Wide<N>& X) const {
    if constexpr (N == 3) {
      X *= factor_;
    } else {
      wide::divide<N>(X.cols(), factor_.data(), over_.data(), X.data());
    }
  }

 private:
  struct Nothing {};
  Wide<N> factor_;                                         // L, or the inverse
  std::conditional_t<N == 3, Nothing, Diagonal<N>> over_;  // of L
};

// A^-1 B for a symmetric positive-definite A; only its lower triangle is read.
template <int N, class B>
auto solve_symmetric(const Mat<N>& A, const B& b) -> typename B::PlainObject {
  return SymmetricFactor<N>(A).solve(b);
}

// Factors of a matrix whose symmetric part is positive definite, as inertia over time with rotation
// and damping has it; no pivoting needed.
template <int N>
class SteadyFactor {
 public:
  SteadyFactor() = default;
  explicit SteadyFactor(const Wide<N>& A) { compute(A); }
  // A: a wide matrix, or an expression of wide matrices.
  template <class A>
  void compute(const A& a) {
    if constexpr (N == 3) {
      lower_ = a.inverse();
    } else {
      lower_ = a;
      upper_.resize(lower_.rows(), lower_.cols());
      over_.resize(lower_.rows(), Eigen::NoChange);
      wide::turn<N>(lower_.cols(), lower_.data(), upper_.data());
      wide::factor_halves<N>(lower_.cols(), lower_.data(), upper_.data(), over_.data());
    }
  }
  template <class B>
  auto solve(const B& b) const -> typename B::PlainObject {
    if constexpr (N == 3) {
      return lower_ * b;
    } else {
      return solve_columns<N>(b, [&](double* x) {
        wide::solve_halves<N>(lower_.cols(), lower_.data(), upper_.data(), over_.data(), x);
      });
    }
  }
  // X becomes X A^-1.
  void divide(Wide<N>& X) const {
    if constexpr (N == 3) {
      X *= lower_;
    } else {
      wide::divide_halves<N>(X.cols(), lower_.data(), upper_.data(), over_.data(), X.data());
    }
  }

 private:
  struct Nothing {};
  Wide<N> lower_;                                                // L, or the inverse
  std::conditional_t<N == 3, Nothing, Wide<N>> upper_;           // U^T
  std::conditional_t<N == 3, Nothing, Diagonal<N, true>> over_;  // of U^T; blocks of both
};

// LU factors of a regular matrix for several right sides, with pivoting.
template <int N>
class Factor {
 public:
  Factor() = default;
  explicit Factor(const Mat<N>& A) { compute(A); }
  // A: a matrix or a wide one.
  template <class A>
  void compute(const A& a) {
    if constexpr (N == 3) {
      factor_ = a.inverse();
    } else {
      factor_ = a.topRows(a.cols());
      eliminate_in<N>(factor_.rows(), factor_.data(), rows_.data());
    }
  }
  template <class B>
  auto solve(const B& b) const -> typename B::PlainObject {
    if constexpr (N == 3) {
      return factor_ * b;
    } else {
      typename B::PlainObject x = b;
      for (Eigen::Index j = 0; j < x.cols(); ++j) {
        solve_eliminated_in<N>(x.rows(), factor_.data(), rows_.data(), x.col(j).data());
      }
      return x;
    }
  }

 private:
  Mat<N> factor_;  // L and U, or the inverse
  std::array<int, kCapacity<N>> rows_{};
};

// A^-1 B for a regular A.
template <int N, class B>
auto solve(const Mat<N>& A, const B& b) -> typename B::PlainObject {
  if constexpr (N == 3) {
    return A.inverse() * b;
  } else {
    return Factor<N>(A).solve(b);
  }
}

// Factor M = L L^T of an inertia that moves with the arm. With Mdot = C + C^T,
// S = C - L Ldot^T is skew.
template <int N>
class MovingFactor {
 public:
  void compute(const Mat<N>& M) {
    if constexpr (N == 3) {
      L_ = cholesky<N>(M);
    } else {
      L_ = widened<N>(M);
      over_.resize(L_.rows(), Eigen::NoChange);
      wide::factor<N>(L_.cols(), L_.data(), over_.data());
      wide::clear_above<N>(L_.cols(), L_.data());
    }
  }
  // Computes S; after compute().
  void follow(const Mat<N>& C) {
    if constexpr (N == 3) {
      S_ = limpid::skew_rest<N>(C, L_, cholesky_rate<N>(L_, C + C.transpose()));
    } else {
      S_ = widened<N>(C);
      Wide<N> rate = turned<N>(S_);
      rate += S_;
      wide::factor_rate<N>(L_.cols(), L_.data(), over_.data(), rate.data());
      wide::skew_rest<N>(L_.cols(), L_.data(), rate.data(), S_.data());
    }
  }

  const Wide<N>& S() const { return S_; }
  // L x, L^T x, L^-T x.
  Vec<N> times(const Vec<N>& x) const { return limpid::times<N>(L_, x); }
  Vec<N> turned_times(const Vec<N>& x) const { return limpid::turned_times<N>(L_, x); }
  Vec<N> solve_turned(Vec<N> x) const {
    if constexpr (N == 3) {
      limpid::solve_transposed<N>(L_, x.data());
      return x;
    } else {
      WideVec<N> in = widened_vector<N>(x);
      wide::solve_transposed<N>(L_.cols(), L_.data(), over_.data(), in.data());
      return in.head(x.size());
    }
  }

 private:
  Wide<N> L_, S_;
  struct Nothing {};
  std::conditional_t<N == 3, Nothing, Diagonal<N>> over_;  // of L
};

}  // namespace limpid
