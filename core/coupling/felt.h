// Impedance of an arm felt by the hand under each coupling, in closed form over frequency.
#pragma once

#include <complex>

#include "core/coupling/inertia_network.h"

namespace limpid {

// Lateness of the motors' torque for the inertia networks and for damping [s].
struct LateMotors {
  double networks = 0, damping = 0;
};

// A joint of the locked system (23) as a loop with ticks of T makes it; for a tip along a line the
// same in kg, N s/m and N/m.
//
// Three effects add to (23). First, the spring of (1) takes the proxy where it was half a tick
// before the midpoint of (2): a damper k_vc T / 2 beside b_v. Second, the proxy trails the device
// by b_v / k_vc, so the contact is felt late. Third, the estimate looks back a tick and every
// torque is held for one: half a tick on average.
struct FeltJoint {
  double m = 0;               // M1 + M2 [kg m^2]
  double b_d = 0, b_v = 0;    // [N m s/rad]
  double k_vc = 0, b_vc = 0;  // [N m/rad, N m s/rad]
  double T = 0;               // [s]
  double K = 0;               // stiffness of the contact, 0 in free space [N m/rad]
  double trip = 0;            // delay through a link to the proxy and back [s]

  // The impedances below are torque over velocity at f [Hz], in full [N m s/rad]. Proposed
  // coupling, (24) with f2 = -K x: the human torque observed with bandwidth w_f [rad/s], the
  // contact torque known.
  std::complex<double> proposed(double f, double eta, double w_f) const;
  // Standard coupling, (1)-(2): the contact behind spring and damper, and perhaps a link; a
  // massless proxy.
  std::complex<double> standard(double f) const;
  // Predictive coupling: the share `damping` of b_d + b_v stays felt. Networks shape the inertia up
  // to `band` [Hz] or to the edge of the added mass; the contact acts as it is.
  std::complex<double> predictive(double f, const AddedMass& added, double damping, double band,
                                  const LateMotors& late = {}) const;
  // Ideal coupling, without any lag: eta (m s + b) + K/s.
  std::complex<double> ideal(double f, double eta) const;
  double b() const { return b_d + b_v + k_vc * T / 2; }

  // Least damping that any passive law must leave to be felt for an inertia of eta m up to `band`
  // [Hz]; 0 for eta >= 1 [N m s/rad].
  double least_damping(double eta, double band) const;
};

}  // namespace limpid
