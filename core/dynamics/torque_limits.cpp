#include "core/dynamics/torque_limits.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace limpid {

template <int N>
double tip_force(const Vec<N>& tau, const Jacobian<N>& J) {
  Mat3 A = J * J.transpose();
  A.diagonal().array() += 1e-9 * (A.trace() + 1e-12);  // for an arm stretched out, or in a plane
  const Vec3 b = J * tau;
  return A.ldlt().solve(b).norm();
}

template <int N>
Vec<N> TorqueLimits<N>::along(const Vec<N>& tau) const {
  constexpr double kAside = 0.01;  // of the largest: left where the torque has no component
  if (!tip_cuts(tau)) return joints;
  const Vec<N> held = within(tau);
  double largest = 0;
  for (Eigen::Index i = 0; i < held.size(); ++i) largest = std::max(largest, std::abs(held[i]));
  Vec<N> most = joints;
  for (Eigen::Index i = 0; i < held.size(); ++i) {
    most[i] = std::min(std::max(std::abs(held[i]), kAside * largest), joints[i]);
  }
  return most;
}

template <int N>
Vec<N> TorqueLimits<N>::reached(const Vec<N>& tau) const {
  const double force = J != nullptr ? tip_force<N>(tau, *J) : 0;
  if (!(force > 0)) return joints;
  return (most_force / force * tau.cwiseAbs()).cwiseMin(joints);
}

template struct TorqueLimits<3>;
template struct TorqueLimits<7>;
template struct TorqueLimits<kAnyDof>;
template double tip_force<3>(const Vec<3>&, const Jacobian<3>&);
template double tip_force<7>(const Vec<7>&, const Jacobian<7>&);
template double tip_force<kAnyDof>(const Vec<kAnyDof>&, const Jacobian<kAnyDof>&);

}  // namespace limpid
