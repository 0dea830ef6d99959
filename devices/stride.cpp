#include "devices/stride.h"

#include "core/math/widest.h"

namespace limpid {
namespace {

// The hand's force at an arm that moves so, to the change of what it is where the arm was looked
// at.
template <int M>
[[gnu::always_inline]] inline void hold(const WideSubsteps& s, Four& force) {
  const Eigen::Index p = wide::rows<M>(s.n);
  Four part[4] = {};
  for (Eigen::Index i = 0; i < p; i += 4) {
    const Four along = four(s.u + i) * s.stiffness + four(s.v + i) * s.along_rate;
    for (int a = 0; a < 3; ++a) part[a] += four(s.J_T + a * p + i) * along;
  }
  wide::sums_of(part, force);
}

template <int M>
[[gnu::always_inline]] inline void take(const WideSubsteps& s) {
  for (Eigen::Index i = 0; i < wide::rows<M>(s.n); i += 4) {
    four(s.sum_u + i) += four(s.u + i);
    four(s.u + i) += (four(s.v + i) + four(s.dv + i) * 0.5) * s.h;
    four(s.v + i) += four(s.dv + i);
  }
}

template <int M>
[[gnu::always_inline]] inline void go_wide(const WideSubsteps& s) {
  using namespace wide;
  const Eigen::Index p = rows<M>(s.n);
  Vec3 force = s.force;
  for (int k = 0; k < s.count; ++k, force += s.force_step) {
    Four moved;
    hold<M>(s, moved);
    const double x = force.x() - moved[0], y = force.y() - moved[1], z = force.z() - moved[2];
    for (Eigen::Index i = 0; i < p; i += 4) {
      const double* const J = s.J_T + i;
      four(s.dv + i) = (four(s.steady + i) - four(s.damping + i) * four(s.v + i)) +
                       (four(J) * x + four(J + p) * y + four(J + 2 * p) * z);
    }
    columns_by_fours(columns<M>(s.n), SolveLower<M>{s.n, s.lower, s.corners, s.dv});
    columns_by_fours_back(columns<M>(s.n), SolveTransposed<M>{s.n, s.lower, s.corners, s.dv});
    take<M>(s);
  }
}

// The same by dv = r - E v + K f, of what A^-1 makes of the rest: of few joints that costs as much
// as the solves of five substeps, and what each of them waits for is less.
template <int M>
[[gnu::always_inline]] inline void go_prepared(const WideSubsteps& s) {
  using namespace wide;
  constexpr Eigen::Index p = rows<M>(M);
  double E[M * p] = {}, K[3 * p] = {}, r[p] = {};
  for (Eigen::Index c = 0; c < M; ++c) E[c * p + c] = 1;
  const double* const over = s.corners - p;
  columns_by_fours(M, Divide<M, true>{M, straight<M>(s.lower, M), over, E});
  columns_by_fours_back(M, Divide<M, false>{M, turned<M>(s.lower, M), over, E});
  for (Eigen::Index i = 0; i < p; i += 4) {
    for (Eigen::Index c = 0; c < M; ++c) {
      four(r + i) += four(E + c * p + i) * s.steady[c];
      for (int a = 0; a < 3; ++a) four(K + a * p + i) += four(E + c * p + i) * s.J_T[a * p + c];
      four(E + c * p + i) *= s.damping[c];
    }
  }
  Vec3 force = s.force;
  for (int k = 0; k < s.count; ++k, force += s.force_step) {
    Four moved;
    hold<M>(s, moved);
    const double x = force.x() - moved[0], y = force.y() - moved[1], z = force.z() - moved[2];
    for (Eigen::Index i = 0; i < p; i += 4) {
      Four damped = four(E + i) * s.v[0];
      for (Eigen::Index c = 1; c < M; ++c) damped += four(E + c * p + i) * s.v[c];
      four(s.dv + i) = (four(r + i) - damped) +
                       (four(K + i) * x + four(K + p + i) * y + four(K + 2 * p + i) * z);
    }
    take<M>(s);
  }
}

template <int M>
[[gnu::always_inline]] inline void stiffen_wide(Eigen::Index n, double by, double answer,
                                                const double* J_T, double* A) {
  const Eigen::Index p = wide::rows<M>(n);
  for (Eigen::Index c = 0; c < wide::columns<M>(n); ++c, A += p) {
    const double x = answer * J_T[c], y = answer * J_T[p + c], z = answer * J_T[2 * p + c];
    for (Eigen::Index i = 0; i < p; i += 4) {
      const double* const J = J_T + i;
      four(A + i) = four(A + i) * by + (four(J) * x + four(J + p) * y + four(J + 2 * p) * z);
    }
  }
}

}  // namespace

template <>
LIMPID_WIDE void stiffen<kAnyDof>(Eigen::Index n, double by, double answer, const double* J_T,
                                  double* A) {
  stiffen_wide<kByFours>(n, by, answer, J_T, A);
}

template <>
LIMPID_WIDE void stiffen<7>(Eigen::Index n, double by, double answer, const double* J_T,
                            double* A) {
  stiffen_wide<7>(n, by, answer, J_T, A);
}

template <>
LIMPID_WIDE void go<kAnyDof>(const WideSubsteps& steps) {
  go_wide<kByFours>(steps);
}

template <>
LIMPID_WIDE void go<7>(const WideSubsteps& steps) {
  if (steps.count > 2) {
    go_prepared<7>(steps);
  } else {
    go_wide<7>(steps);
  }
}

}  // namespace limpid
