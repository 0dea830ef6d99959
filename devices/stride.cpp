#include "devices/stride.h"

#include "core/math/widest.h"

namespace limpid {
namespace {

template <int M>
[[gnu::always_inline]] inline void go_wide(const WideSubsteps& s) {
  using namespace wide;
  const Eigen::Index p = rows<M>(s.n);
  double x = s.force.x(), y = s.force.y(), z = s.force.z();
  for (int k = 0; k < s.count; ++k) {
    Four part[4] = {}, moved;
    for (Eigen::Index i = 0; i < p; i += 4) {
      const Four along = four(s.u + i) * s.stiffness + four(s.v + i) * s.along_rate;
      for (int a = 0; a < 3; ++a) part[a] += four(s.J_T + a * p + i) * along;
    }
    sums_of(part, moved);
    const double fx = x - moved[0], fy = y - moved[1], fz = z - moved[2];
    for (Eigen::Index i = 0; i < p; i += 4) {
      const double* const J = s.J_T + i;
      four(s.dv + i) = (four(s.steady + i) - four(s.damping + i) * four(s.v + i)) +
                       (four(J) * fx + four(J + p) * fy + four(J + 2 * p) * fz);
    }
    columns_by_fours(columns<M>(s.n), SolveLower<M>{s.n, s.lower, s.corners, s.dv});
    columns_by_fours_back(columns<M>(s.n), SolveTransposed<M>{s.n, s.lower, s.corners, s.dv});
    for (Eigen::Index i = 0; i < p; i += 4) {
      four(s.sum_u + i) += four(s.u + i);
      four(s.u + i) += (four(s.v + i) + four(s.dv + i) * 0.5) * s.h;
      four(s.v + i) += four(s.dv + i);
    }
    x += s.force_step.x(), y += s.force_step.y(), z += s.force_step.z();
  }
}

}  // namespace

template <>
LIMPID_WIDE void go<kAnyDof>(const WideSubsteps& steps) {
  go_wide<kByFours>(steps);
}

template <>
LIMPID_WIDE void go<7>(const WideSubsteps& steps) {
  go_wide<7>(steps);
}

}  // namespace limpid
