// How much torque may leave for the motors: so much a joint, and so much force at the tip.
#pragma once

#include <limits>

#include "core/dynamics/arm.h"

namespace limpid {

// The smallest force at the tip that makes this torque, as far as a force there can [N].
template <int N>
double tip_force(const Vec<N>& tau, const Jacobian<N>& J);

// Both limits leave convex sets of torques about zero: a torque between two that are allowed is
// allowed, and so is a part of one.
template <int N>
struct TorqueLimits {
  // Without a limit for the tip.
  TorqueLimits(const Vec<N>& most) : joints(most) {}  // NOLINT(google-explicit-constructor)
  TorqueLimits(const Vec<N>& most, const Jacobian<N>& tip, double force)
      : joints(most),
        J(force < std::numeric_limits<double>::infinity() ? &tip : nullptr),
        most_force(force) {}

  // Each joint to its limit, then all of them by one factor to that of the tip: the factor takes no
  // joint beyond its limit again.
  Vec<N> within(const Vec<N>& tau) const {
    const Vec<N> held = tau.cwiseMin(joints).cwiseMax(-joints);
    return held * part(held);
  }
  // Whether the tip's limit takes something off what the joints' leave.
  bool tip_cuts(const Vec<N>& tau) const {
    return part(tau.cwiseMin(joints).cwiseMax(-joints)) < 1;
  }
  // Joint limits that keep the tip's limit for torques in about this direction: clipping each joint
  // to them takes a torque in this direction where within() does [N m].
  Vec<N> along(const Vec<N>& tau) const {
    constexpr double kAside = 0.01;  // of a joint's limit is left where the torque has none of it
    if (!tip_cuts(tau)) return joints;
    return within(tau).cwiseAbs().cwiseMax(kAside * joints);
  }

  const Vec<N>& joints;            // > 0 [N m]
  const Jacobian<N>* J = nullptr;  // of the tip
  double most_force = 0;           // [N]

 private:
  double part(const Vec<N>& held) const {
    const double force = J != nullptr ? tip_force<N>(held, *J) : 0;
    return force > most_force ? most_force / force : 1;
  }
};

extern template double tip_force<3>(const Vec<3>&, const Jacobian<3>&);
extern template double tip_force<7>(const Vec<7>&, const Jacobian<7>&);
extern template double tip_force<kAnyDof>(const Vec<kAnyDof>&, const Jacobian<kAnyDof>&);

}  // namespace limpid
