// Limits of the motors' torque: at each joint, and of the force at the tip.
#pragma once

#include <limits>

#include "core/dynamics/arm.h"

namespace limpid {

// Smallest force at the tip that makes this torque, as far as a force there can [N].
template <int N>
double tip_force(const Vec<N>& tau, const Jacobian<N>& J);

// Both limits allow convex sets of torques about zero: torques between two allowed ones are
// allowed, and so are parts of one.
template <int N>
struct TorqueLimits {
  // Limits at the joints alone.
  TorqueLimits(const Vec<N>& most) : joints(most) {}  // NOLINT(google-explicit-constructor)
  TorqueLimits(const Vec<N>& most, const Jacobian<N>& tip, double force)
      : joints(most),
        J(force < std::numeric_limits<double>::infinity() ? &tip : nullptr),
        most_force(force) {}

  // Clips each joint to its limit, then scales all by one factor to the tip's limit; the factor
  // takes no joint beyond its limit again.
  Vec<N> within(const Vec<N>& tau) const {
    const Vec<N> held = tau.cwiseMin(joints).cwiseMax(-joints);
    return held * part(held);
  }
  // True if the tip's limit cuts more than the joints' limits do.
  bool tip_cuts(const Vec<N>& tau) const {
    return part(tau.cwiseMin(joints).cwiseMax(-joints)) < 1;
  }
  // Joint limits that keep the tip's limit for torques in about this direction: clipping to them
  // takes a torque in this direction to the same value as within() [N m].
  Vec<N> along(const Vec<N>& tau) const;
  // Joint limits that a torque in this direction ends at as it grows [N m].
  Vec<N> reached(const Vec<N>& tau) const;

  const Vec<N>& joints;            // 0 where a joint has no motor [N m]
  const Jacobian<N>* J = nullptr;  // of the tip
  double most_force = 0;           // [N]

 private:
  double part(const Vec<N>& held) const {
    const double force = J != nullptr ? tip_force<N>(held, *J) : 0;
    return force > most_force ? most_force / force : 1;
  }
};

extern template struct TorqueLimits<3>;
extern template struct TorqueLimits<7>;
extern template struct TorqueLimits<kAnyDof>;
extern template double tip_force<3>(const Vec<3>&, const Jacobian<3>&);
extern template double tip_force<7>(const Vec<7>&, const Jacobian<7>&);
extern template double tip_force<kAnyDof>(const Vec<kAnyDof>&, const Jacobian<kAnyDof>&);

}  // namespace limpid
