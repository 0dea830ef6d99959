// Wide matrices: more than three joints, their columns filled up to whole fours, for operations
// cubic in the number of joints.
//
// Products, factors and divisions work on tiles of eight rows and four columns, which stay in
// registers. Vectors are as wide as the processor's; each number is computed in the same way by all
// of them.
#pragma once

#include "core/math/triangular.h"

namespace limpid {

constexpr int whole_fours(int n) { return (n + 3) / 4 * 4; }
template <int N>
inline constexpr int kWideRows = N == 3 || N == kAnyDof ? N : whole_fours(N);
template <int N>
inline constexpr int kMostWideRows = N == 3 ? 3 : whole_fours(kCapacity<N>);

// Wide matrix of n columns, whose rows from n on are zero; an ordinary matrix for three joints.
template <int N>
using Wide = Eigen::Matrix<double, kWideRows<N>, N, 0, kMostWideRows<N>, kCapacity<N>>;
// Reciprocals of a factor's diagonal, then the inverses of its blocks of four; of two factors, if
// Two.
template <int N, bool Two = false>
using Diagonal = Eigen::Matrix<double, kWideRows<N>, Two ? 9 : 5, 0, kMostWideRows<N>, Two ? 9 : 5>;
template <int N>
using WideVec = Eigen::Matrix<double, kWideRows<N>, 1, 0, kMostWideRows<N>, 1>;

namespace wide {

using Eigen::Index;

// N as in triangular.h: known when compiling, or kByFours.
template <int N>
constexpr Index rows(Index n) {
  return N == kByFours ? (n + 3) / 4 * 4 : whole_fours(N);
}
template <int N>
constexpr Index columns(Index n) {
  return N == kByFours ? n : N;
}

// Factors by which columns are subtracted from others: f(c, k) for column k from column c.
struct Factors {
  const double* at;
  Index by_column, by_k;
  double operator()(Index c, Index k) const { return at[c * by_column + k * by_k]; }
  Factors of_columns_from(Index c) const { return {at + c * by_column, by_column, by_k}; }
};
// Factors F(c, k) as stored, or F(k, c).
template <int N>
[[gnu::always_inline]] inline Factors straight(const double* F, Index n) {
  return {F, 1, rows<N>(n)};
}
template <int N>
[[gnu::always_inline]] inline Factors turned(const double* F, Index n) {
  return {F, rows<N>(n), 1};
}

// A tile of R times four rows and W columns.
template <int R, int W>
struct Tile {
  Four x[R][W];

  [[gnu::always_inline]] void load(const double* from, Index p) {
    for (int c = 0; c < W; ++c) {
      for (int r = 0; r < R; ++r) x[r][c] = four(from + c * p + 4 * r).v;
    }
  }
  [[gnu::always_inline]] void clear() {
    for (int c = 0; c < W; ++c) {
      for (int r = 0; r < R; ++r) x[r][c] = Four{};
    }
  }
  [[gnu::always_inline]] void store(double* to, Index p) const {
    for (int c = 0; c < W; ++c) {
      for (int r = 0; r < R; ++r) four(to + c * p + 4 * r).v = x[r][c];
    }
  }
  // Subtracts columns k of X times f(c, k) from column c.
  [[gnu::always_inline]] void take(const double* X, Index p, const Factors& f, Index from,
                                   Index to) {
    const double* column = X + from * p;
    const double* factors = f.at + from * f.by_k;
    for (Index left = to - from; left > 0; --left, column += p, factors += f.by_k) {
      for (int c = 0; c < W; ++c) {
        const double factor = factors[c * f.by_column];
        for (int r = 0; r < R; ++r) x[r][c] -= four(column + 4 * r).v * factor;
      }
    }
  }
  // Subtracts the tile's own columns from each other, the first one first or the last one first.
  // Then multiplies each by `scale`, unless that is null. f: of the tile's columns.
  [[gnu::always_inline]] void finish_rising(const Factors& f, Index k0, const double* scale) {
    for (int c = 0; c < W; ++c) {
      for (int k = 0; k < c; ++k) {
        const double factor = f(c, k0 + k);
        for (int r = 0; r < R; ++r) x[r][c] -= x[r][k] * factor;
      }
      for (int r = 0; r < R && scale != nullptr; ++r) x[r][c] *= scale[c];
    }
  }
  [[gnu::always_inline]] void finish_falling(const Factors& f, Index k0, const double* scale) {
    for (int c = W; c-- > 0;) {
      for (int k = c + 1; k < W; ++k) {
        const double factor = f(c, k0 + k);
        for (int r = 0; r < R; ++r) x[r][c] -= x[r][k] * factor;
      }
      for (int r = 0; r < R && scale != nullptr; ++r) x[r][c] *= scale[c];
    }
  }
};

// Calls work(R, r) for R times four rows from r on, through all rows from `first`, a multiple of
// four, to p.
template <class Work>
[[gnu::always_inline]] inline void by_eights(Index first, Index p, const Work& work) {
  Index r = first;
  for (; r + 8 <= p; r += 8) work.template operator()<2>(r);
  if (r < p) work.template operator()<1>(r);
}
// Calls work(W, c) for W columns from c on, through all n.
template <class Work>
[[gnu::always_inline]] inline void columns_by_fours(Index n, const Work& work) {
  Index c = 0;
  for (; c + 4 <= n; c += 4) work.template operator()<4>(c);
  if (n - c == 1) work.template operator()<1>(c);
  if (n - c == 2) work.template operator()<2>(c);
  if (n - c == 3) work.template operator()<3>(c);
}
template <class Work>
[[gnu::always_inline]] inline void columns_by_fours_back(Index n, const Work& work) {
  Index c = n / 4 * 4;
  if (n - c == 1) work.template operator()<1>(c);
  if (n - c == 2) work.template operator()<2>(c);
  if (n - c == 3) work.template operator()<3>(c);
  while ((c -= 4) >= 0) work.template operator()<4>(c);
}

// C -= A F^T; Fresh: C counts as zero before.
template <int N, bool Fresh>
struct TakeProduct {
  Index n;
  const double* A;
  Factors F;
  double* C;

  template <int W>
  [[gnu::always_inline]] void operator()(Index c) const {
    const Index p = rows<N>(n);
    by_eights(0, p, Rows<W>{*this, c, p});
  }
  template <int W>
  struct Rows {
    const TakeProduct& all;
    Index c, p;
    template <int R>
    [[gnu::always_inline]] void operator()(Index r) const {
      Tile<R, W> tile;
      if (Fresh) tile.clear();
      if (!Fresh) tile.load(all.C + c * p + r, p);
      tile.take(all.A + r, p, all.F.of_columns_from(c), 0, columns<N>(all.n));
      tile.store(all.C + c * p + r, p);
    }
  };
};

// X becomes X F^-T, with F's part up to its diagonal (Rising) or from it on. `scale`: reciprocals
// of F's diagonal; null: that is one.
template <int N, bool Rising>
struct Divide {
  Index n;
  Factors F;
  const double* scale;
  double* X;

  template <int W>
  [[gnu::always_inline]] void operator()(Index c) const {
    const Index p = rows<N>(n);
    by_eights(0, p, Rows<W>{*this, c, p});
  }
  template <int W>
  struct Rows {
    const Divide& all;
    Index c, p;
    template <int R>
    [[gnu::always_inline]] void operator()(Index r) const {
      const Factors f = all.F.of_columns_from(c);
      const double* const factors = all.scale == nullptr ? nullptr : all.scale + c;
      Tile<R, W> tile;
      tile.load(all.X + c * p + r, p);
      if constexpr (Rising) {
        tile.take(all.X + r, p, f, 0, c);
        tile.finish_rising(f, c, factors);
      } else {
        tile.take(all.X + r, p, f, c + W, columns<N>(all.n));
        tile.finish_falling(f, c, factors);
      }
      tile.store(all.X + c * p + r, p);
    }
  };
};

// Columns c to c + W of a factor X, in rows from r on, divided by the diagonal block.
template <int N, int W>
struct FactorRows {
  Index n, c, p;
  double* X;
  Factors F;
  const double* scale;
  template <int R>
  [[gnu::always_inline]] void operator()(Index r) const {
    const Factors f = F.of_columns_from(c);
    Tile<R, W> tile;
    tile.load(X + c * p + r, p);
    tile.take(X + r, p, f, 0, c);
    tile.finish_rising(f, c, scale);
    tile.store(X + c * p + r, p);
  }
};

// Inverse of a lower triangle, as four columns of four. scale: reciprocals of its diagonal.
template <int W>
[[gnu::always_inline]] inline void invert_corner(const double (&l)[W][W], const double (&scale)[W],
                                                 double* to) {
  double v[4][4] = {};
  for (int j = 0; j < W; ++j) {
    v[j][j] = scale[j];
    for (int i = j + 1; i < W; ++i) {
      double taken = l[i][j] * v[j][j];
      for (int k = j + 1; k < i; ++k) taken += l[i][k] * v[k][j];
      v[i][j] = -taken * scale[i];
    }
  }
  for (int j = 0; j < 4; ++j) four(to + 4 * j).v = Four{v[0][j], v[1][j], v[2][j], v[3][j]};
}

// L, given as A's lower triangle, becomes its lower Cholesky factor; entries above its blocks of
// four stay as they were.
template <int N>
struct FactorSymmetric {
  Index n;
  double *L, *over;  // over: reciprocals of the diagonal, then the inverses of its blocks

  template <int W>
  [[gnu::always_inline]] void operator()(Index c) const {
    const Index p = rows<N>(n);
    const Factors f = straight<N>(L, n);
    Tile<1, W> block;
    block.load(L + c * p + c, p);
    block.take(L + c, p, f.of_columns_from(c), 0, c);
    // Local copies, not L: the compiler cannot know what else L might be.
    double l[W][W] = {}, scale[W];
    for (int j = 0; j < W; ++j) {
      for (int i = j; i < W; ++i) {
        l[i][j] = block.x[0][j][i];
        for (int k = 0; k < j; ++k) l[i][j] -= l[i][k] * l[j][k];
      }
      scale[j] = 1 / std::sqrt(l[j][j]);
      for (int i = j; i < W; ++i) l[i][j] *= scale[j];
    }
    invert_corner<W>(l, scale, over + p + 4 * c);
    for (int j = 0; j < W; ++j) {
      over[c + j] = scale[j];
      for (int i = 0; i < W; ++i) L[(c + j) * p + c + i] = l[i][j];
    }
    by_eights(c + 4, p, FactorRows<N, W>{n, c, p, L, f, over + c});
  }
};

// D, given as Adot's lower triangle, becomes the rate of A's factor L: the derivative of
// FactorSymmetric.
template <int N>
struct FactorRate {
  Index n;
  const double *L, *over;
  double* D;

  template <int W>
  [[gnu::always_inline]] void operator()(Index c) const {
    const Index p = rows<N>(n);
    const Factors of_L = straight<N>(L, n).of_columns_from(c);
    const Factors of_D = straight<N>(D, n).of_columns_from(c);
    Tile<1, W> block;
    block.load(D + c * p + c, p);
    block.take(D + c, p, of_L, 0, c);
    block.take(L + c, p, of_D, 0, c);
    double l[W][W] = {}, d[W][W] = {};
    for (int j = 0; j < W; ++j) {
      const double scale = over[c + j];
      for (int i = j; i < W; ++i) {
        l[i][j] = of_L(i, c + j);
        d[i][j] = block.x[0][j][i];
        for (int k = 0; k < j; ++k) d[i][j] -= d[i][k] * l[j][k] + l[i][k] * d[j][k];
        d[i][j] = i == j ? d[i][j] * (0.5 * scale) : (d[i][j] - l[i][j] * d[j][j]) * scale;
      }
    }
    for (int j = 0; j < W; ++j) {
      for (int i = 0; i < W; ++i) D[(c + j) * p + c + i] = d[i][j];
    }
    by_eights(c + 4, p, Rows<W>{*this, of_L, of_D, c, p});
  }
  template <int W>
  struct Rows {
    const FactorRate& all;
    Factors of_L, of_D;
    Index c, p;
    template <int R>
    [[gnu::always_inline]] void operator()(Index r) const {
      Tile<R, W> d, l;
      d.load(all.D + c * p + r, p);
      l.load(all.L + c * p + r, p);
      d.take(all.D + r, p, of_L, 0, c);
      d.take(all.L + r, p, of_D, 0, c);
      for (int j = 0; j < W; ++j) {
        const double rate = of_D(j, c + j), scale = all.over[c + j];
        for (int i = 0; i < R; ++i) {
          for (int k = 0; k < j; ++k) {
            d.x[i][j] -= d.x[i][k] * of_L(j, c + k) + l.x[i][k] * of_D(j, c + k);
          }
          d.x[i][j] = (d.x[i][j] - l.x[i][j] * rate) * scale;
        }
      }
      d.store(all.D + c * p + r, p);
    }
  };
};

// S, given as C, becomes C - L Ldot^T where that is skew, computed from its upper half.
template <int N>
struct SkewRest {
  Index n;
  const double *L, *Ldot;
  double* S;

  template <int W>
  [[gnu::always_inline]] void operator()(Index c) const {
    const Index p = rows<N>(n);
    by_eights(c, p, Rows<W>{*this, c, p});
    for (Index j = c; j < c + W; ++j) {
      S[j * p + j] = 0;
      for (Index i = j + 1; i < columns<N>(n); ++i) S[i * p + j] = -S[j * p + i];
    }
  }
  template <int W>
  struct Rows {
    const SkewRest& all;
    Index c, p;
    template <int R>
    [[gnu::always_inline]] void operator()(Index r) const {
      Tile<R, W> tile;
      tile.load(all.S + c * p + r, p);
      tile.take(all.L + r, p, straight<N>(all.Ldot, all.n).of_columns_from(c), 0, c + W);
      tile.store(all.S + c * p + r, p);
    }
  };
};

// L, given as A, and Ut, given as its transpose, become A = L Ut^T with a diagonal of ones in L;
// entries above their diagonals are arbitrary.
template <int N>
struct FactorHalves {
  Index n;
  // over: reciprocals of Ut's diagonal, then the inverses of L's blocks and of Ut's.
  double *L, *Ut, *over;

  template <int W>
  [[gnu::always_inline]] void operator()(Index c) const {
    const Index p = rows<N>(n);
    const Factors of_L = straight<N>(L, n), of_Ut = straight<N>(Ut, n);
    Tile<1, W> block;
    block.load(L + c * p + c, p);
    block.take(L + c, p, of_Ut.of_columns_from(c), 0, c);
    double m[W][W], ut[W][W], scale[W], ones[W];
    for (int j = 0; j < W; ++j) {
      for (int i = 0; i < W; ++i) m[i][j] = block.x[0][j][i];
    }
    for (int j = 0; j < W; ++j) {
      scale[j] = 1 / m[j][j];
      ones[j] = 1;
      for (int i = j + 1; i < W; ++i) {
        m[i][j] *= scale[j];
        for (int k = j + 1; k < W; ++k) m[i][k] -= m[i][j] * m[j][k];
      }
    }
    for (int j = 0; j < W; ++j) {
      over[c + j] = scale[j];
      for (int i = j + 1; i < W; ++i) L[(c + j) * p + c + i] = m[i][j];
      for (int k = j; k < W; ++k) Ut[(c + j) * p + c + k] = ut[k][j] = m[j][k];
    }
    invert_corner<W>(m, ones, over + p + 4 * c);
    invert_corner<W>(ut, scale, over + 5 * p + 4 * c);
    by_eights(c + 4, p, FactorRows<N, W>{n, c, p, L, of_Ut, over + c});
    by_eights(c + 4, p, FactorRows<N, W>{n, c, p, Ut, of_L, nullptr});
  }
};

// Sums of the numbers of each of four vectors.
[[gnu::always_inline]] inline void sums_of(const Four (&s)[4], Four& sums) {
  const Four ab = __builtin_shufflevector(s[0], s[1], 0, 4, 2, 6) +
                  __builtin_shufflevector(s[0], s[1], 1, 5, 3, 7);
  const Four cd = __builtin_shufflevector(s[2], s[3], 0, 4, 2, 6) +
                  __builtin_shufflevector(s[2], s[3], 1, 5, 3, 7);
  sums = __builtin_shufflevector(ab, cd, 0, 1, 4, 5) + __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
}

// x, whose rows from n on are zero, becomes L^-1 x, four columns at a time. Each step waits for one
// product with a block's inverse, not for a chain of its numbers.
template <int N>
struct SolveLower {
  Index n;
  const double *L, *corners;  // inverses of the diagonal's blocks
  double* x;

  template <int W>
  [[gnu::always_inline]] void operator()(Index c) const {
    const Index p = rows<N>(n);
    const double *const a = L + c * p, *const v = corners + 4 * c;
    Four solved = four(v).v * x[c];
    for (int k = 1; k < W; ++k) solved += four(v + 4 * k).v * x[c + k];
    four(x + c).v = solved;
    for (Index i = c + 4; i < p; i += 4) {
      Four taken = four(a + i).v * solved[0];
      for (int k = 1; k < W; ++k) taken += four(a + k * p + i).v * solved[k];
      four(x + i).v -= taken;
    }
  }
};
// x becomes L^-T x.
template <int N>
struct SolveTransposed {
  Index n;
  const double *L, *corners;
  double* x;

  template <int W>
  [[gnu::always_inline]] void operator()(Index c) const {
    const Index p = rows<N>(n);
    const double *const a = L + c * p, *const v = corners + 4 * c;
    Four part[4] = {}, sums;
    for (Index i = c + 4; i < p; i += 4) {
      for (int k = 0; k < W; ++k) part[k] += four(a + k * p + i).v * four(x + i).v;
    }
    sums_of(part, sums);
    const Four rest = four(x + c).v - sums;
    for (int k = 0; k < 4; ++k) part[k] = four(v + 4 * k).v * rest;
    sums_of(part, sums);
    four(x + c).v = sums;
  }
};

// y -= A x, and y -= A^T x.
template <int N>
struct TakeTimes {
  Index n;
  const double *A, *x;
  double* y;
  template <int W>
  [[gnu::always_inline]] void operator()(Index c) const {
    const Index p = rows<N>(n);
    const double* const a = A + c * p;
    for (Index i = 0; i < p; i += 4) {
      Four taken = four(a + i).v * x[c];
      for (int k = 1; k < W; ++k) taken += four(a + k * p + i).v * x[c + k];
      four(y + i).v -= taken;
    }
  }
};
template <int N>
struct TakeTransposedTimes {
  Index n;
  const double *A, *x;
  double* y;
  template <int W>
  [[gnu::always_inline]] void operator()(Index c) const {
    const Index p = rows<N>(n);
    const double* const a = A + c * p;
    Four part[4] = {}, sums;
    for (Index i = 0; i < p; i += 4) {
      for (int k = 0; k < W; ++k) part[k] += four(a + k * p + i).v * four(x + i).v;
    }
    sums_of(part, sums);
    four(y + c).v -= sums;
  }
};

// Clears everything above the diagonal blocks of four.
template <int N>
[[gnu::always_inline]] inline void clear_above_in(Index n, double* L) {
  const Index p = rows<N>(n);
  for (Index c = 4; c < columns<N>(n); ++c) {
    for (Index i = 0; i < c / 4 * 4; i += 4) four(L + c * p + i).v = Four{};
  }
}

// B becomes A^T.
template <int N>
[[gnu::always_inline]] inline void turn_in(Index n, const double* A, double* B) {
  const Index p = rows<N>(n);
  for (Index j = 0; j < p; j += 4) {
    for (Index i = 0; i < p; i += 4) {
      const double* const from = A + j * p + i;
      Four a[4] = {};
      for (Index k = 0; k < 4; ++k) {
        if (j + k < columns<N>(n)) a[k] = four(from + k * p).v;
      }
      const Four ab_low = __builtin_shufflevector(a[0], a[1], 0, 4, 2, 6);
      const Four ab_high = __builtin_shufflevector(a[0], a[1], 1, 5, 3, 7);
      const Four cd_low = __builtin_shufflevector(a[2], a[3], 0, 4, 2, 6);
      const Four cd_high = __builtin_shufflevector(a[2], a[3], 1, 5, 3, 7);
      const Four b[4] = {__builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5),
                         __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5),
                         __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7),
                         __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7)};
      for (Index k = 0; k < 4; ++k) {
        if (i + k < columns<N>(n)) four(B + (i + k) * p + j).v = b[k];
      }
    }
  }
}

// W becomes A, whose columns have n rows.
template <int N>
[[gnu::always_inline]] inline void widen_in(Index n, const double* A, double* W) {
  const Index p = rows<N>(n), most = columns<N>(n), whole = most / 4 * 4;
  for (Index c = 0; c < most; ++c, A += most, W += p) {
    Index i = 0;
    for (; i + 8 <= whole; i += 8) {
      four(W + i).v = four(A + i).v;
      four(W + i + 4).v = four(A + i + 4).v;
    }
    if (i < whole) four(W + i).v = four(A + i).v;
    if (most - whole == 1) four(W + whole).v = Four{A[whole]};
    if (most - whole == 2) four(W + whole).v = Four{A[whole], A[whole + 1]};
    if (most - whole == 3) four(W + whole).v = Four{A[whole], A[whole + 1], A[whole + 2]};
  }
}

// The functions from here on are compiled in wide.cpp, for 7 joints and for any number.
// C -= A B; C = - A B^T.
template <int N>
void take_product(Index n, const double* A, const double* B, double* C);
template <int N>
void minus_product_turned(Index n, const double* A, const double* B, double* C);
// W becomes A, whose columns have n rows.
template <int N>
void widen(Index n, const double* A, double* W);
// B becomes A^T.
template <int N>
void turn(Index n, const double* A, double* B);
// D, given as Adot, becomes the rate of L in A = L L^T; S, given as C, becomes C - L Ldot^T where
// that is skew.
template <int N>
void factor_rate(Index n, const double* L, const double* over, double* D);
template <int N>
void skew_rest(Index n, const double* L, const double* Ldot, double* S);
// Clears everything above the diagonal blocks of four, before products with L.
template <int N>
void clear_above(Index n, double* L);
// x becomes L^-T x.
template <int N>
void solve_transposed(Index n, const double* L, const double* over, double* x);
// A, given in L, becomes L of A = L L^T; or L and Ut of A = L Ut^T as in FactorHalves.
template <int N>
void factor(Index n, double* L, double* over);
template <int N>
void factor_halves(Index n, double* L, double* Ut, double* over);
// X becomes X (L L^T)^-1, or X (L Ut^T)^-1.
template <int N>
void divide(Index n, const double* L, const double* over, double* X);
template <int N>
void divide_halves(Index n, const double* L, const double* Ut, const double* over, double* X);
// x becomes (L L^T)^-1 x, or (L Ut^T)^-1 x.
template <int N>
void solve(Index n, const double* L, const double* over, double* x);
template <int N>
void solve_halves(Index n, const double* L, const double* Ut, const double* over, double* x);
// y -= A x; y -= A^T x.
template <int N>
void take_times(Index n, const double* A, const double* x, double* y);
template <int N>
void take_turned_times(Index n, const double* A, const double* x, double* y);

}  // namespace wide

template <int N>
Wide<N> widened(const Mat<N>& A) {
  if constexpr (N == 3) {
    return A;
  } else {
    Wide<N> W(whole_fours(static_cast<int>(A.rows())), A.cols());
    wide::widen<N>(A.cols(), A.data(), W.data());
    return W;
  }
}
// A^T.
template <int N>
Wide<N> turned(const Wide<N>& A) {
  if constexpr (N == 3) {
    return A.transpose();
  } else {
    Wide<N> W(A.rows(), A.cols());
    wide::turn<N>(A.cols(), A.data(), W.data());
    return W;
  }
}
template <int N>
WideVec<N> widened_vector(const Vec<N>& x) {
  WideVec<N> w(whole_fours(static_cast<int>(x.size())));
  std::copy_n(x.data(), x.size(), w.data());
  std::fill_n(w.data() + x.size(), w.size() - x.size(), 0.0);
  return w;
}
template <int N>
Mat<N> narrowed(const Wide<N>& W) {
  return W.topRows(W.cols());
}

// C -= A B.
template <int N>
void take_product(const Wide<N>& A, const Wide<N>& B, Wide<N>& C) {
  if constexpr (N == 3) {
    C.noalias() -= A * B;
  } else {
    wide::take_product<N>(A.cols(), A.data(), B.data(), C.data());
  }
}
// - A B^T.
template <int N>
Wide<N> minus_product_turned(const Wide<N>& A, const Wide<N>& B) {
  if constexpr (N == 3) {
    return -A * B.transpose();
  } else {
    Wide<N> C(A.rows(), A.cols());
    wide::minus_product_turned<N>(A.cols(), A.data(), B.data(), C.data());
    return C;
  }
}

// A x, A^T x.
template <int N>
Vec<N> times(const Wide<N>& A, const Vec<N>& x) {
  if constexpr (N == 3) {
    return A * x;
  } else {
    WideVec<N> y = WideVec<N>::Zero(A.rows());
    wide::take_times<N>(x.size(), A.data(), x.data(), y.data());
    return -y.head(x.size());
  }
}
template <int N>
Vec<N> turned_times(const Wide<N>& A, const Vec<N>& x) {
  if constexpr (N == 3) {
    return A.transpose() * x;
  } else {
    const WideVec<N> in = widened_vector<N>(x);
    WideVec<N> y = WideVec<N>::Zero(A.rows());
    wide::take_turned_times<N>(x.size(), A.data(), in.data(), y.data());
    return -y.head(x.size());
  }
}

}  // namespace limpid
