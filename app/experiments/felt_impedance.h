// Measured impedance of one joint, or of the whole arm, as the hand feels it.
#pragma once

#include <complex>
#include <vector>

#include "app/experiments/experiment.h"
#include "app/experiments/signals.h"
#include "devices/files/session/session.h"

namespace limpid {

// Torque over velocity [N m s/rad] at increasing frequencies.
struct Impedance {
  std::vector<double> f;  // [Hz]
  std::vector<std::complex<double>> Z;
};

// Human torque over velocity of a joint at the frequencies of the shaking. Uses the session's rows
// from `from` on, without the last, over whole periods.
Impedance measured_impedance(const Session& session, std::size_t from, int joint,
                             const Multisine& shaking);

// Inertia and damping of the whole arm along its own motion, as felt at one frequency.
struct FeltMotion {
  double f = 0;        // [Hz]
  double inertia = 0;  // over that of M [-]
  double damping = 0;  // [N m s/rad]
  double mass = 0;     // of M, along the motion [kg m^2]
};

// Like measured_impedance(), for all joints together: the force in phase with acceleration and
// velocity. M is the inertia matrix where the arm is shaken [kg m^2].
std::vector<FeltMotion> measured_motion(const Session& session, std::size_t from,
                                        const Eigen::MatrixXd& M, const Multisine& shaking);

// Least-squares slope of Im Z on w through the origin over frequencies up to `highest` [Hz]: the
// apparent inertia of a free joint [kg m^2].
double apparent_inertia(const Impedance& felt, double highest);

// World of the roaming arm: free space.
inline constexpr const char* kFreeSpace = "title = \"Free space\"\nabout = \"Nothing to touch.\"\n";
inline const Vec3 kHome(0.2, 0, -0.02);  // middle of the motion [m]

// Lets an arm roam while eta changes. Adds a panel of E_c, and the check that E_c of the predictive
// law stays zero.
void roam(TrialRunner& lab, Outcome& outcome);

}  // namespace limpid
