// The factor of an inertia that moves with the arm, and what of C its rate leaves.
#pragma once

#include "core/math/wide.h"

namespace limpid {

// M = L L^T; with Mdot = C + C^T, S = C - L Ldot^T is skew.
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
  // After that.
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
  std::conditional_t<N == 3, Nothing, Diagonal<N>> over_;  // L's
};

}  // namespace limpid
