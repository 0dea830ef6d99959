#include "core/math/wide.h"

#include "core/math/triangular.h"

namespace limpid::wide {

LIMPID_WIDE void take_product(Index n, const double* A, const double* B, double* C) {
  columns_by_fours(n, TakeProduct<false>{n, A, turned(B, n), C});
}

LIMPID_WIDE void minus_product_turned(Index n, const double* A, const double* B, double* C) {
  columns_by_fours(n, TakeProduct<true>{n, A, straight(B, n), C});
}

LIMPID_WIDE void widen(Index n, const double* A, double* W) { widen_in(n, A, W); }

LIMPID_WIDE void turn(Index n, const double* A, double* B) { turn_in(n, A, B); }

LIMPID_WIDE void factor_rate(Index n, const double* L, const double* over, double* D) {
  columns_by_fours(n, FactorRate{n, L, over, D});
}

LIMPID_WIDE void skew_rest(Index n, const double* L, const double* Ldot, double* S) {
  columns_by_fours(n, SkewRest{n, L, Ldot, S});
}

LIMPID_WIDE void solve_transposed(Index n, const double* L, const double* over, double* x) {
  columns_by_fours_back(n, SolveTransposed{n, L, over + rows(n), x});
}

LIMPID_WIDE void clear_above(Index n, double* L) { clear_above_in(n, L); }

LIMPID_WIDE void factor(Index n, double* L, double* over) {
  columns_by_fours(n, FactorSymmetric{n, L, over});
}

LIMPID_WIDE void factor_halves(Index n, double* L, double* Ut, double* over) {
  columns_by_fours(n, FactorHalves{n, L, Ut, over});
}

LIMPID_WIDE void divide(Index n, const double* L, const double* over, double* X) {
  columns_by_fours(n, Divide<true>{n, straight(L, n), over, X});
  columns_by_fours_back(n, Divide<false>{n, turned(L, n), over, X});
}

LIMPID_WIDE void divide_halves(Index n, const double* L, const double* Ut, const double* over,
                               double* X) {
  columns_by_fours(n, Divide<true>{n, straight(Ut, n), over, X});
  columns_by_fours_back(n, Divide<false>{n, turned(L, n), nullptr, X});
}

LIMPID_WIDE void solve(Index n, const double* L, const double* over, double* x) {
  columns_by_fours(n, SolveLower{n, L, over + rows(n), x});
  columns_by_fours_back(n, SolveTransposed{n, L, over + rows(n), x});
}

LIMPID_WIDE void solve_halves(Index n, const double* L, const double* Ut, const double* over,
                              double* x) {
  columns_by_fours(n, SolveLower{n, L, over + rows(n), x});
  columns_by_fours_back(n, SolveTransposed{n, Ut, over + 5 * rows(n), x});
}

LIMPID_WIDE void take_times(Index n, const double* A, const double* x, double* y) {
  columns_by_fours(n, TakeTimes{n, A, x, y});
}

LIMPID_WIDE void take_turned_times(Index n, const double* A, const double* x, double* y) {
  columns_by_fours(n, TakeTransposedTimes{n, A, x, y});
}

}  // namespace limpid::wide
