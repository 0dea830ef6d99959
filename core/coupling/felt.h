// What the hand feels of an arm under each coupling, in closed form: impedance over frequency.
#pragma once

#include <complex>

#include "core/coupling/inertia_network.h"

namespace limpid {

// How late comes what motors give for the inertia networks and for damping [s].
struct LateMotors {
  double networks = 0, damping = 0;
};

// A joint of the locked system (23) as the loop in ticks of T makes it; of a tip along a line the
// same in kg, N s/m and N/m.
//
// Three things come on top of (23). The spring of (1) takes the proxy where it was half a tick
// before the middle that (2) puts in place: a damper k_vc T / 2 beside b_v. The proxy trails the
// device by b_v / k_vc, so that the contact is felt late. And the estimate looks back a tick, and
// every torque is held for one: half a tick on average.
struct FeltJoint {
  double m = 0;               // M1 + M2 [kg m^2]
  double b_d = 0, b_v = 0;    // [N m s/rad]
  double k_vc = 0, b_vc = 0;  // [N m/rad, N m s/rad]
  double T = 0;               // [s]
  double K = 0;               // of the contact, 0 in free space [N m/rad]
  double trip = 0;            // through a link to the proxy and back [s]

  // Torque over velocity at f [Hz], all of it [N m s/rad]:
  // Proposed coupling, (24) with f2 = -K x: the human torque observed with bandwidth w_f [rad/s],
  // the contact torque known.
  std::complex<double> proposed(double f, double eta, double w_f) const;
  // Standard coupling, (1)-(2): the contact behind spring and damper, and maybe a link; the proxy
  // weighs nothing.
  std::complex<double> standard(double f) const;
  // Predictive coupling: the share `damping` of b_d + b_v stays felt, networks shape the inertia up
  // to `band` [Hz] or to the edge of what is added, the contact acts as it is.
  std::complex<double> predictive(double f, const AddedMass& added, double damping, double band,
                                  const LateMotors& late = {}) const;
  // Without any lag: eta (m s + b) + K/s.
  std::complex<double> ideal(double f, double eta) const;
  double b() const { return b_d + b_v + k_vc * T / 2; }

  // Least damping that any passive law has to make felt for an inertia of eta m up to `band` [Hz];
  // 0 from eta 1 on [N m s/rad].
  double least_damping(double eta, double band) const;
};

}  // namespace limpid
