// The smallest stable eta in a grip where the proxy is held by the coupling's spring, not rigidly.
#pragma once

#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "core/coupling/eta_min.h"
#include "core/dynamics/arm_description.h"
#include "core/math/sizes.h"
#include "core/tick/parameters.h"

namespace limpid {

// As eta_min_grip of core/coupling/eta_min.h, with the shape system of (22): the proxy's damper
// b_v is felt through k_vc and b_vc of `p`, so above k_vc / b_v [rad/s] no more. The proxy weighs
// nothing. M_L inertia [kg m^2], b_d the device's damping of each joint [N m s/rad], K_h the grip's
// stiffness in joint space [N m/rad]; alpha of `p` [N m s/rad]. Found by bisection to 1e-6; 1 if
// none below is stable.
double eta_min_compliant(const Eigen::MatrixXd& M_L, const Eigen::VectorXd& b_d,
                         const Parameters& p, const Eigen::MatrixXd& K_h);

// Passivity and stability of a setting, without simulating, (3) and (22)-(25).
struct Analysis {
  std::vector<LockedMode> modes;       // lightest first
  std::vector<double> w_f, w_c;        // of each mode [rad/s]
  double b = 0;                        // b_d + b_v at the least damped joint [N m s/rad]
  double eta_min = 0;                  // (25), the worst mode
  std::optional<double> eta_min_band;  // where only frequencies up to w_b count
  double eta_min_grip = 0;             // Routh, for hand.stiffness and hand.damping
  double delay = 0;                    // of the motors, that (3) reckons with [s]
  double link = 0;                     // of the link each way, that it reckons with [s]
  bool measured = false;               // inertia, damping and delay were, of the device itself
  Condition3 condition3;
  bool above_eta_min = false;  // eta >= eta_min: (25), which is about the proposed law alone
};

// Whether the law that is chosen is passive: gives no more energy than it took, or than its account
// allows.
struct Passivity {
  std::optional<bool> passive;  // none: no bound is known
  std::string by;               // what says so, in words: "condition (3)"
};
// Passivity of the law chosen; `p`: the parameters that `a` is the analysis of.
Passivity passivity(const Analysis& a, const Parameters& p);

// b_d of every joint: the setting, or what the arm's file says [N m s/rad].
Eigen::VectorXd device_damping(const ArmDescription& arm, const Parameters& p);

// From a reading to the torque that answers it, beyond the tick [s]: as the arm was measured, else
// as model.delay or the virtual arm's device.delay say.
double device_delay(const ArmDescription& arm, const Parameters& p);

// Condition (3) for these, and for the link that is set.
Condition3 condition3(const ArmDescription& arm, const Parameters& p);

// What the figures rest on, for people: "inertia, damping and a delay of 2.1 ms, measured".
std::string basis_text(const ArmDescription& arm, const Parameters& p);

// An arm at rest at configuration x [rad].
struct ArmAt {
  Eigen::MatrixXd M;  // inertia (n x n) [kg m^2]
  Eigen::MatrixXd J;  // of the tip (3 x n) [m]
};
ArmAt arm_at(const ArmDescription& arm, const Eigen::VectorXd& x);

// At configuration x, the hand's spring and damper at the tip. w_b [rad/s].
Analysis analyze(const ArmDescription& arm, const Eigen::VectorXd& x, const Parameters& p,
                 std::optional<double> w_b);
// Poles of the locked system in the hand at configuration x [rad/s].
std::vector<std::complex<double>> handle_poles(const ArmDescription& arm, const Eigen::VectorXd& x,
                                               const Parameters& p);
// For a scalar inertia [kg m^2]; the hand's stiffness and damping count in joint space.
Analysis analyze(double mass, const ArmDescription& arm, const Parameters& p,
                 std::optional<double> w_b);

}  // namespace limpid
