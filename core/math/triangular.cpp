#include "core/math/triangular.h"

// Sanitizers cannot do with functions that are chosen while the program is loaded. No clone may
// multiply and add in one: recordings are to be the same on all machines.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define LIMPID_WIDE [[gnu::target_clones("avx2", "default")]]
#else
#define LIMPID_WIDE
#endif

namespace limpid {

LIMPID_WIDE void factor_many(Eigen::Index n, double* L) { factor_in<kAnyDof>(n, L); }

LIMPID_WIDE void rate_many(Eigen::Index n, const double* L, double* D) {
  rate_in<kAnyDof>(n, L, D);
}

LIMPID_WIDE void skew_many(Eigen::Index n, const double* L, const double* Ldot, double* S) {
  skew_in<kAnyDof>(n, L, Ldot, S);
}

LIMPID_WIDE void solve_lower_many(Eigen::Index n, const double* L, double* x) {
  solve_lower_in<kAnyDof>(n, L, x);
}

LIMPID_WIDE void solve_transposed_many(Eigen::Index n, const double* L, double* x) {
  solve_transposed_in<kAnyDof>(n, L, x);
}

LIMPID_WIDE void eliminate_many(Eigen::Index n, double* A, int* rows) {
  eliminate_in<kAnyDof>(n, A, rows);
}

LIMPID_WIDE void solve_eliminated_many(Eigen::Index n, const double* LU, const int* rows,
                                       double* x) {
  solve_eliminated_in<kAnyDof>(n, LU, rows, x);
}

}  // namespace limpid
