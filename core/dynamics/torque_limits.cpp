#include "core/dynamics/torque_limits.h"

#include <Eigen/Cholesky>

namespace limpid {

template <int N>
double tip_force(const Vec<N>& tau, const Jacobian<N>& J) {
  Mat3 A = J * J.transpose();
  A.diagonal().array() += 1e-9 * (A.trace() + 1e-12);  // for an arm stretched out, or in a plane
  const Vec3 b = J * tau;
  return A.ldlt().solve(b).norm();
}

template double tip_force<3>(const Vec<3>&, const Jacobian<3>&);
template double tip_force<7>(const Vec<7>&, const Jacobian<7>&);
template double tip_force<kAnyDof>(const Vec<kAnyDof>&, const Jacobian<kAnyDof>&);

}  // namespace limpid
