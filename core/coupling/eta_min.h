// Lower bounds of eta: positive-realness of the locked system and Routh's limit in the user's grip,
// (22)-(25).
#pragma once

#include <complex>
#include <vector>

#include "core/math/sizes.h"

namespace limpid {

// A mode of the locked system, (23)-(24). b is b_d + b_v: the proxy's damper is felt through the
// coupling.
struct LockedMode {
  double m = 0;      // [kg m^2]
  double b = 0;      // [N m s/rad]
  double alpha = 0;  // [N m s/rad]

  double w_f() const { return alpha / m; }  // observer bandwidth [rad/s]
  double w_c() const { return b / m; }      // bandwidth of the open-loop locked system [rad/s]
};

// H_L(jw) of (24) [rad/s per N m]; infinite at w = 0 without damping.
std::complex<double> locked_response(const LockedMode& mode, double eta, double w);

// Smallest eta for which H_L is positive real: w_f / (w_c + w_f), (25).
double eta_min(const LockedMode& mode);

// Smallest eta when only frequencies up to w_b count: R_L(w) >= 0 for w <= w_b,
//     max(0, (w_f - w_c w_f^2 / w_b^2) / (w_c + w_f)).
double eta_min_band(const LockedMode& mode, double w_b);

// Smallest stable eta with the handle held by a spring and damper k_h [N m/rad], b_h [N m s/rad]:
// Routh-Hurwitz on (m s^2 + b s)(s + w_f) + (k_h + b_h s)(s + w_f / eta). 0 if every eta is stable.
double eta_min_grip(const LockedMode& mode, double k_h, double b_h);

// The n modes of the locked system, lightest first. M_L: inertia (n x n, symmetric positive
// definite [kg m^2]); b: damping of each joint (n [N m s/rad]); alpha: observer gain [N m s/rad].
std::vector<LockedMode> locked_modes(const Eigen::MatrixXd& M_L, const Eigen::VectorXd& b,
                                     double alpha);

// The 3n poles of the locked system in a grip with joint stiffness K_h and damping B_h (n x n)
// [rad/s]: position, velocity, estimate.
Eigen::VectorXcd grip_poles(const Eigen::MatrixXd& M_L, const Eigen::VectorXd& b, double alpha,
                            double eta, const Eigen::MatrixXd& K_h, const Eigen::MatrixXd& B_h);

// Smallest stable eta in a grip with K_h and B_h. Matrices that share no modes leave no closed
// form: it is found by bisection on whether all of grip_poles() decay, to 1e-6.
double eta_min_grip(const Eigen::MatrixXd& M_L, const Eigen::VectorXd& b, double alpha,
                    const Eigen::MatrixXd& K_h, const Eigen::MatrixXd& B_h);

}  // namespace limpid
