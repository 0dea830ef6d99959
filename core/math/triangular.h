// Triangular matrices of joint size: factors, their rates, and solves in place, without allocation.
//
// Columns are stored one after another. Loops unroll where the number of joints is known when
// compiling. For many joints four columns and four rows are worked on at a time, by the widest
// vectors of the processor; each number is computed in the same way by all of them.
#pragma once

#include <array>
#include <cmath>
#include <utility>

#include "core/math/sizes.h"

// LIMPID_WIDE functions are compiled for SSE2 and AVX2 and chosen when the program is loaded, which
// sanitizers cannot do. No clone may fuse multiply and add: recordings must be the same on all
// machines.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define LIMPID_WIDE [[gnu::target_clones("avx2", "default")]]
#else
#define LIMPID_WIDE
#endif
namespace limpid {

using Four [[gnu::vector_size(32)]] = double;
// Holds four numbers at any place; columns need not begin at multiples of 32 bytes.
struct [[gnu::packed, gnu::may_alias]] FourAt {
  Four v;
};
[[gnu::always_inline]] inline FourAt& four(double* x) { return *reinterpret_cast<FourAt*>(x); }
[[gnu::always_inline]] inline const FourAt& four(const double* x) {
  return *reinterpret_cast<const FourAt*>(x);
}

// The functions below are for N joints known when compiling, or for any number (kAnyDof), which
// triangular.cpp compiles by calling them once more with kByFours.
inline constexpr int kByFours = -4;

// x -= four columns times four factors, in rows from `first` on, a multiple of four of them.
[[gnu::always_inline]] inline void take_four(const std::array<const double*, 4>& columns,
                                             const std::array<double, 4>& factors,
                                             Eigen::Index first, Eigen::Index n,
                                             double* __restrict x) {
  const auto [a, b, c, d] = columns;
  const auto [fa, fb, fc, fd] = factors;
  for (Eigen::Index i = first; i < n; i += 4) {
    four(x + i).v -=
        (four(a + i).v * fa + four(b + i).v * fb) + (four(c + i).v * fc + four(d + i).v * fd);
  }
}

// x -= sum of columns[k] * factors[k] in rows `first` to n. With kByFours up to three rows before
// `first` may be overwritten.
template <int N, class Column, class Factor>
[[gnu::always_inline]] inline void take_off(Eigen::Index columns, const Column& column,
                                            const Factor& factor, Eigen::Index first,
                                            Eigen::Index n, double* __restrict x) {
  Eigen::Index k = 0;
  if (const Eigen::Index start = n - (n - first + 3) / 4 * 4; N == kByFours && start >= 0) {
    for (; k < columns % 4; ++k) {
      const double* const a = column(k);
      const double fa = factor(k);
      for (Eigen::Index i = start; i < n; i += 4) four(x + i).v -= four(a + i).v * fa;
    }
    for (; k < columns; k += 4) {
      take_four({column(k), column(k + 1), column(k + 2), column(k + 3)},
                {factor(k), factor(k + 1), factor(k + 2), factor(k + 3)}, start, n, x);
    }
  }
  for (; k < columns; ++k) {
    const double* const a = column(k);
    const double fa = factor(k);
    for (Eigen::Index i = first; i < n; ++i) x[i] -= a[i] * fa;
  }
}

// L, given as A's lower triangle, becomes its lower Cholesky factor.
template <int N>
[[gnu::always_inline]] inline void factor_in(Eigen::Index n, double* L) {
  const auto column = [&](Eigen::Index k) { return L + k * n; };
  for (Eigen::Index j = 0; j < n; ++j) {
    double* const Lj = L + j * n;
    const auto factor = [&](Eigen::Index k) { return L[k * n + j]; };
    take_off<N>(j, column, factor, j, n, Lj);
    const double scale = 1 / std::sqrt(Lj[j]);
    for (Eigen::Index i = 0; i < j; ++i) Lj[i] = 0;
    for (Eigen::Index i = j; i < n; ++i) Lj[i] *= scale;
  }
}

// D, given as Adot's lower triangle, becomes the rate of A's factor L: the derivative of
// factor_in().
template <int N>
[[gnu::always_inline]] inline void rate_in(Eigen::Index n, const double* L, double* D) {
  const auto column = [&](Eigen::Index k) -> const double* { return (k % 2 ? L : D) + k / 2 * n; };
  for (Eigen::Index j = 0; j < n; ++j) {
    double* const Dj = D + j * n;
    const double* const Lj = L + j * n;
    // Not (k % 2 ? D : L)[...], whose index gcc 12 loses under -fsanitize=undefined.
    const auto factor = [&](Eigen::Index k) { return *((k % 2 ? D : L) + k / 2 * n + j); };
    take_off<N>(2 * j, column, factor, j, n, Dj);
    const double scale = 1 / Lj[j];
    Dj[j] *= 0.5 * scale;
    const double d = Dj[j];
    for (Eigen::Index i = 0; i < j; ++i) Dj[i] = 0;
    for (Eigen::Index i = j + 1; i < n; ++i) Dj[i] = (Dj[i] - Lj[i] * d) * scale;
  }
}

// S, given as C, becomes C - L Ldot^T where that is skew, computed from its upper half.
template <int N>
[[gnu::always_inline]] inline void skew_in(Eigen::Index n, const double* L, const double* Ldot,
                                           double* S) {
  const auto column = [&](Eigen::Index k) { return L + k * n; };
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto factor = [&](Eigen::Index k) { return Ldot[k * n + j]; };
    take_off<N>(j + 1, column, factor, j + 1, n, S + j * n);
  }
  for (Eigen::Index j = 0; j < n; ++j) {
    S[j * n + j] = 0;
    for (Eigen::Index i = j + 1; i < n; ++i) S[i * n + j] = -S[j * n + i];
  }
}

// x becomes L^-1 x.
template <int N>
[[gnu::always_inline]] inline void solve_lower_in(Eigen::Index n, const double* L, double* x) {
  for (Eigen::Index j = 0; j < n; ++j) {
    const double* const Lj = L + j * n;
    const double at_j = x[j] *= 1 / Lj[j];
    for (Eigen::Index i = j + 1; i < n; ++i) x[i] -= Lj[i] * at_j;
  }
}

// x becomes L^-T x.
template <int N>
[[gnu::always_inline]] inline void solve_transposed_in(Eigen::Index n, const double* L, double* x) {
  for (Eigen::Index j = n; j-- > 0;) {
    const double* const Lj = L + j * n;
    double rest = x[j];
    for (Eigen::Index i = j + 1; i < n; ++i) rest -= Lj[i] * x[i];
    x[j] = rest * (1 / Lj[j]);
  }
}

// x becomes L^-1 x by L's first `columns` columns; L's diagonal is one and not stored.
template <int N>
[[gnu::always_inline]] inline void go_forward(Eigen::Index columns, Eigen::Index n, const double* L,
                                              double* x) {
  const Eigen::Index odd = N == kByFours ? n % 4 : n;
  for (Eigen::Index j = 0; j < columns;) {
    const double* const a = L + j * n;
    if (j < odd || j + 4 > columns) {
      const Eigen::Index fours = j < odd ? odd : (j - odd) / 4 * 4 + odd + 4;
      for (Eigen::Index i = j + 1; i < fours; ++i) x[i] -= a[i] * x[j];
      for (Eigen::Index i = fours; i < n; i += 4) four(x + i).v -= four(a + i).v * x[j];
      ++j;
      continue;
    }
    const double *b = a + n, *c = b + n, *d = c + n;
    const double xa = x[j], xb = x[j + 1] - a[j + 1] * xa;
    const double xc = x[j + 2] - a[j + 2] * xa - b[j + 2] * xb;
    const double xd = x[j + 3] - a[j + 3] * xa - b[j + 3] * xb - c[j + 3] * xc;
    x[j + 1] = xb, x[j + 2] = xc, x[j + 3] = xd;
    take_four({a, b, c, d}, {xa, xb, xc, xd}, j + 4, n, x);
    j += 4;
  }
}

// A becomes L and U of P A = L U, without L's diagonal of ones and with U's diagonal inverted; row
// j was exchanged with rows[j].
template <int N>
[[gnu::always_inline]] inline void eliminate_in(Eigen::Index n, double* A, int* rows) {
  for (Eigen::Index j = 0; j < n; ++j) {
    double* const x = A + j * n;
    for (Eigen::Index k = 0; k < j; ++k) std::swap(x[k], x[rows[k]]);
    go_forward<N>(j, n, A, x);
    Eigen::Index best = j;
    for (Eigen::Index i = j + 1; i < n; ++i) best = std::abs(x[i]) > std::abs(x[best]) ? i : best;
    rows[j] = static_cast<int>(best);
    for (Eigen::Index m = 0; m <= j; ++m) std::swap(A[m * n + j], A[m * n + best]);
    x[j] = 1 / x[j];
    for (Eigen::Index i = j + 1; i < n; ++i) x[i] *= x[j];
  }
}

// x becomes A^-1 x.
template <int N>
[[gnu::always_inline]] inline void solve_eliminated_in(Eigen::Index n, const double* LU,
                                                       const int* rows, double* x) {
  for (Eigen::Index j = 0; j < n; ++j) std::swap(x[j], x[rows[j]]);
  go_forward<N>(n, n, LU, x);
  const Eigen::Index even = N == kByFours ? n / 4 * 4 : 0;
  for (Eigen::Index j = n; j-- > even;) {
    const double* const a = LU + j * n;
    x[j] *= a[j];
    for (Eigen::Index i = even; i < j; ++i) x[i] -= a[i] * x[j];
    for (Eigen::Index i = 0; i < even; i += 4) four(x + i).v -= four(a + i).v * x[j];
  }
  for (Eigen::Index j = even - 4; j >= 0; j -= 4) {
    const double *a = LU + j * n, *b = a + n, *c = b + n, *d = c + n;
    const double xd = x[j + 3] * d[j + 3];
    const double xc = (x[j + 2] - d[j + 2] * xd) * c[j + 2];
    const double xb = (x[j + 1] - d[j + 1] * xd - c[j + 1] * xc) * b[j + 1];
    const double xa = (x[j] - d[j] * xd - c[j] * xc - b[j] * xb) * a[j];
    x[j] = xa, x[j + 1] = xb, x[j + 2] = xc, x[j + 3] = xd;
    take_four({a, b, c, d}, {xa, xb, xc, xd}, 0, j, x);
  }
}

template <>
void factor_in<kAnyDof>(Eigen::Index n, double* L);
template <>
void eliminate_in<kAnyDof>(Eigen::Index n, double* A, int* rows);
template <>
void solve_eliminated_in<kAnyDof>(Eigen::Index n, const double* LU, const int* rows, double* x);

// Lower Cholesky factor, A = L L^T, of a symmetric positive-definite A; only its lower triangle is
// read.
template <int N>
Mat<N> cholesky(const Mat<N>& A) {
  Mat<N> L = A;
  factor_in<N>(L.rows(), L.data());
  return L;
}

// Rate of the Cholesky factor: Adot = Ldot L^T + L Ldot^T.
template <int N>
Mat<N> cholesky_rate(const Mat<N>& L, const Mat<N>& Adot) {
  Mat<N> Ldot = Adot;
  rate_in<N>(L.rows(), L.data(), Ldot.data());
  return Ldot;
}

// C - L Ldot^T, where that is skew.
template <int N>
Mat<N> skew_rest(const Mat<N>& C, const Mat<N>& L, const Mat<N>& Ldot) {
  Mat<N> S = C;
  skew_in<N>(L.rows(), L.data(), Ldot.data(), S.data());
  return S;
}

// x becomes L^-1 x, or L^-T x.
template <int N>
void solve_lower(const Mat<N>& L, double* x) {
  solve_lower_in<N>(L.rows(), L.data(), x);
}
template <int N>
void solve_transposed(const Mat<N>& L, double* x) {
  solve_transposed_in<N>(L.rows(), L.data(), x);
}

}  // namespace limpid
