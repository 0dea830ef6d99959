#include "core/math/wide.h"

#include "core/math/triangular.h"

namespace limpid::wide {

template <>
LIMPID_WIDE void take_product<kAnyDof>(Index n, const double* A, const double* B, double* C) {
  columns_by_fours(columns<kByFours>(n),
                   TakeProduct<kByFours, false>{n, A, turned<kByFours>(B, n), C});
}

template <>
LIMPID_WIDE void minus_product_turned<kAnyDof>(Index n, const double* A, const double* B,
                                               double* C) {
  columns_by_fours(columns<kByFours>(n),
                   TakeProduct<kByFours, true>{n, A, straight<kByFours>(B, n), C});
}

template <>
LIMPID_WIDE void widen<kAnyDof>(Index n, const double* A, double* W) {
  widen_in<kByFours>(n, A, W);
}

template <>
LIMPID_WIDE void turn<kAnyDof>(Index n, const double* A, double* B) {
  turn_in<kByFours>(n, A, B);
}

template <>
LIMPID_WIDE void factor_rate<kAnyDof>(Index n, const double* L, const double* over, double* D) {
  columns_by_fours(columns<kByFours>(n), FactorRate<kByFours>{n, L, over, D});
}

template <>
LIMPID_WIDE void skew_rest<kAnyDof>(Index n, const double* L, const double* Ldot, double* S) {
  columns_by_fours(columns<kByFours>(n), SkewRest<kByFours>{n, L, Ldot, S});
}

template <>
LIMPID_WIDE void solve_transposed<kAnyDof>(Index n, const double* L, const double* over,
                                           double* x) {
  columns_by_fours_back(columns<kByFours>(n),
                        SolveTransposed<kByFours>{n, L, over + rows<kByFours>(n), x});
}

template <>
LIMPID_WIDE void clear_above<kAnyDof>(Index n, double* L) {
  clear_above_in<kByFours>(n, L);
}

template <>
LIMPID_WIDE void factor<kAnyDof>(Index n, double* L, double* over) {
  columns_by_fours(columns<kByFours>(n), FactorSymmetric<kByFours>{n, L, over});
}

template <>
LIMPID_WIDE void factor_halves<kAnyDof>(Index n, double* L, double* Ut, double* over) {
  columns_by_fours(columns<kByFours>(n), FactorHalves<kByFours>{n, L, Ut, over});
}

template <>
LIMPID_WIDE void divide<kAnyDof>(Index n, const double* L, const double* over, double* X) {
  columns_by_fours(columns<kByFours>(n),
                   Divide<kByFours, true>{n, straight<kByFours>(L, n), over, X});
  columns_by_fours_back(columns<kByFours>(n),
                        Divide<kByFours, false>{n, turned<kByFours>(L, n), over, X});
}

template <>
LIMPID_WIDE void divide_halves<kAnyDof>(Index n, const double* L, const double* Ut,
                                        const double* over, double* X) {
  columns_by_fours(columns<kByFours>(n),
                   Divide<kByFours, true>{n, straight<kByFours>(Ut, n), over, X});
  columns_by_fours_back(columns<kByFours>(n),
                        Divide<kByFours, false>{n, turned<kByFours>(L, n), nullptr, X});
}

template <>
LIMPID_WIDE void solve<kAnyDof>(Index n, const double* L, const double* over, double* x) {
  columns_by_fours(columns<kByFours>(n), SolveLower<kByFours>{n, L, over + rows<kByFours>(n), x});
  columns_by_fours_back(columns<kByFours>(n),
                        SolveTransposed<kByFours>{n, L, over + rows<kByFours>(n), x});
}

template <>
LIMPID_WIDE void solve_halves<kAnyDof>(Index n, const double* L, const double* Ut,
                                       const double* over, double* x) {
  columns_by_fours(columns<kByFours>(n), SolveLower<kByFours>{n, L, over + rows<kByFours>(n), x});
  columns_by_fours_back(columns<kByFours>(n),
                        SolveTransposed<kByFours>{n, Ut, over + 5 * rows<kByFours>(n), x});
}

template <>
LIMPID_WIDE void take_times<kAnyDof>(Index n, const double* A, const double* x, double* y) {
  columns_by_fours(columns<kByFours>(n), TakeTimes<kByFours>{n, A, x, y});
}

template <>
LIMPID_WIDE void take_turned_times<kAnyDof>(Index n, const double* A, const double* x, double* y) {
  columns_by_fours(columns<kByFours>(n), TakeTransposedTimes<kByFours>{n, A, x, y});
}

template <>
LIMPID_WIDE void take_product<7>(Index n, const double* A, const double* B, double* C) {
  columns_by_fours(columns<7>(n), TakeProduct<7, false>{n, A, turned<7>(B, n), C});
}

template <>
LIMPID_WIDE void minus_product_turned<7>(Index n, const double* A, const double* B, double* C) {
  columns_by_fours(columns<7>(n), TakeProduct<7, true>{n, A, straight<7>(B, n), C});
}

template <>
LIMPID_WIDE void widen<7>(Index n, const double* A, double* W) {
  widen_in<7>(n, A, W);
}

template <>
LIMPID_WIDE void turn<7>(Index n, const double* A, double* B) {
  turn_in<7>(n, A, B);
}

template <>
LIMPID_WIDE void factor_rate<7>(Index n, const double* L, const double* over, double* D) {
  columns_by_fours(columns<7>(n), FactorRate<7>{n, L, over, D});
}

template <>
LIMPID_WIDE void skew_rest<7>(Index n, const double* L, const double* Ldot, double* S) {
  columns_by_fours(columns<7>(n), SkewRest<7>{n, L, Ldot, S});
}

template <>
LIMPID_WIDE void solve_transposed<7>(Index n, const double* L, const double* over, double* x) {
  columns_by_fours_back(columns<7>(n), SolveTransposed<7>{n, L, over + rows<7>(n), x});
}

template <>
LIMPID_WIDE void clear_above<7>(Index n, double* L) {
  clear_above_in<7>(n, L);
}

template <>
LIMPID_WIDE void factor<7>(Index n, double* L, double* over) {
  columns_by_fours(columns<7>(n), FactorSymmetric<7>{n, L, over});
}

template <>
LIMPID_WIDE void factor_halves<7>(Index n, double* L, double* Ut, double* over) {
  columns_by_fours(columns<7>(n), FactorHalves<7>{n, L, Ut, over});
}

template <>
LIMPID_WIDE void divide<7>(Index n, const double* L, const double* over, double* X) {
  columns_by_fours(columns<7>(n), Divide<7, true>{n, straight<7>(L, n), over, X});
  columns_by_fours_back(columns<7>(n), Divide<7, false>{n, turned<7>(L, n), over, X});
}

template <>
LIMPID_WIDE void divide_halves<7>(Index n, const double* L, const double* Ut, const double* over,
                                  double* X) {
  columns_by_fours(columns<7>(n), Divide<7, true>{n, straight<7>(Ut, n), over, X});
  columns_by_fours_back(columns<7>(n), Divide<7, false>{n, turned<7>(L, n), nullptr, X});
}

template <>
LIMPID_WIDE void solve<7>(Index n, const double* L, const double* over, double* x) {
  columns_by_fours(columns<7>(n), SolveLower<7>{n, L, over + rows<7>(n), x});
  columns_by_fours_back(columns<7>(n), SolveTransposed<7>{n, L, over + rows<7>(n), x});
}

template <>
LIMPID_WIDE void solve_halves<7>(Index n, const double* L, const double* Ut, const double* over,
                                 double* x) {
  columns_by_fours(columns<7>(n), SolveLower<7>{n, L, over + rows<7>(n), x});
  columns_by_fours_back(columns<7>(n), SolveTransposed<7>{n, Ut, over + 5 * rows<7>(n), x});
}

template <>
LIMPID_WIDE void take_times<7>(Index n, const double* A, const double* x, double* y) {
  columns_by_fours(columns<7>(n), TakeTimes<7>{n, A, x, y});
}

template <>
LIMPID_WIDE void take_turned_times<7>(Index n, const double* A, const double* x, double* y) {
  columns_by_fours(columns<7>(n), TakeTransposedTimes<7>{n, A, x, y});
}

}  // namespace limpid::wide
