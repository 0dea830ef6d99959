#include "core/math/triangular.h"

#include "core/math/widest.h"

namespace limpid {

template <>
LIMPID_WIDE void factor_in<kAnyDof>(Eigen::Index n, double* L) {
  factor_in<kByFours>(n, L);
}

template <>
LIMPID_WIDE void rate_in<kAnyDof>(Eigen::Index n, const double* L, double* D) {
  rate_in<kByFours>(n, L, D);
}

template <>
LIMPID_WIDE void skew_in<kAnyDof>(Eigen::Index n, const double* L, const double* Ldot, double* S) {
  skew_in<kByFours>(n, L, Ldot, S);
}

template <>
LIMPID_WIDE void solve_lower_in<kAnyDof>(Eigen::Index n, const double* L, double* x) {
  solve_lower_in<kByFours>(n, L, x);
}

template <>
LIMPID_WIDE void solve_transposed_in<kAnyDof>(Eigen::Index n, const double* L, double* x) {
  solve_transposed_in<kByFours>(n, L, x);
}

template <>
LIMPID_WIDE void eliminate_in<kAnyDof>(Eigen::Index n, double* A, int* rows) {
  eliminate_in<kByFours>(n, A, rows);
}

template <>
LIMPID_WIDE void solve_eliminated_in<kAnyDof>(Eigen::Index n, const double* LU, const int* rows,
                                              double* x) {
  solve_eliminated_in<kByFours>(n, LU, rows, x);
}

}  // namespace limpid
