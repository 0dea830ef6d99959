// What a hand feels of one joint: impedance, measured and in theory.
#pragma once

#include <complex>
#include <vector>

#include "app/experiments/excitation.h"
#include "devices/files/session/session.h"

namespace limpid {

// Torque over velocity [N m s/rad] at increasing frequencies.
struct Impedance {
  std::vector<double> f;  // [Hz]
  std::vector<std::complex<double>> Z;
};

// Human torque over velocity of a joint at the lines of a shaking hand; the session's rows from
// `from` on, but for the last, last whole periods of it.
Impedance measured_impedance(const Session& session, std::size_t from, int joint,
                             const Multisine& shaking);

// What a hand feels of the whole arm along its own motion, at one frequency.
struct FeltMotion {
  double f = 0;        // [Hz]
  double inertia = 0;  // by that of M [-]
  double damping = 0;  // [N m s/rad]
  double mass = 0;     // of M along the motion [kg m^2]
};

// The same as measured_impedance(), of all joints together: the force's part in and against the
// motion. M is the inertia matrix where the arm is shaken [kg m^2].
std::vector<FeltMotion> measured_motion(const Session& session, std::size_t from,
                                        const Eigen::MatrixXd& M, const Multisine& shaking);

// A joint of the locked system (23) as the loop in ticks of T makes it.
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

  // Proposed coupling, (24) with f2 = -K x: the human torque observed with bandwidth w_f, the
  // contact torque known.
  std::complex<double> proposed(double f, double eta, double w_f) const;
  // Standard coupling, (1)-(2): the contact behind spring and damper; the proxy weighs nothing.
  std::complex<double> standard(double f) const;
  // Without any lag: eta (m s + b) + K/s.
  std::complex<double> ideal(double f, double eta) const;
  double b() const { return b_d + b_v + k_vc * T / 2; }
};

// Least-squares slope of Im Z on w through the origin over frequencies up to `highest` [Hz]: the
// apparent inertia of a free joint [kg m^2].
double apparent_inertia(const Impedance& felt, double highest);

}  // namespace limpid
