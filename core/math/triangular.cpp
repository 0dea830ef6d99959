#include "core/math/triangular.h"

namespace limpid {

template <>
LIMPID_WIDE void factor_in<kAnyDof>(Eigen::Index n, double* L) {
  factor_in<kByFours>(n, L);
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
