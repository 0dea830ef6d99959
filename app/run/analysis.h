// Passivity and stability of settings, without simulating: (3), (22)-(25), and the smallest stable
// eta.
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

// Smallest stable eta in a grip where the coupling's spring holds the proxy, not rigidly. Otherwise
// like eta_min_grip of core/coupling/eta_min.h, with the shape system of (22): the proxy's damper
// b_v is felt through k_vc and b_vc of `p`, so above k_vc / b_v [rad/s] no more. The proxy weighs
// nothing. M_L inertia [kg m^2], b_d the device's damping of each joint [N m s/rad], K_h and B_h
// the grip's stiffness and damping in joint space [N m/rad, N m s/rad]; alpha of `p` [N m s/rad].
// Found by bisection to 1e-6, from `least` on; 1 if none below is stable.
double eta_min_compliant(const Eigen::MatrixXd& M_L, const Eigen::VectorXd& b_d,
                         const Parameters& p, const Eigen::MatrixXd& K_h,
                         const Eigen::MatrixXd& B_h, double least = 0);

// Longest tick that the ledger's promise was tried at, with room for rounding [s].
inline constexpr double kTriedTick = 1.001e-3;

// Figures of one setting, by (3) and (22)-(25).
struct Analysis {
  std::vector<LockedMode> modes;       // lightest first
  std::vector<double> w_f, w_c;        // of each mode [rad/s]
  double b = 0;                        // b_d + b_v at the least damped joint [N m s/rad]
  double eta_min = 0;                  // (25), the worst mode
  std::optional<double> eta_min_band;  // eta_min if only frequencies up to w_b count
  double eta_min_grip = 0;             // Routh, for hand.stiffness and hand.damping
  double eta_min_compliant = 0;        // the same with the proxy behind the coupling's spring
  double delay = 0;                    // of the motors, in (3) [s]
  double link = 0;                     // of the link each way, in (3) [s]
  bool measured = false;  // inertia, damping and delay are measured on the device itself
  Condition3 condition3;
  double line_margin = 0;  // of `wave`: b_d less three dampers of the line, two without the matched
                           // one, at the joint with the least [N m s/rad]
  bool above_eta_min = false;  // eta >= eta_min, (25); this is about the proposed law alone
};

// Whether the chosen law is passive: gives no more energy than it took, or than its account allows.
struct Passivity {
  std::optional<bool> passive;  // nothing: no limit is known
  std::string by;               // reason in words: "condition (3)"
};
// Judges the chosen law; `a` is the analysis of `p`.
Passivity passivity(const Analysis& a, const Parameters& p);

// Laws that are told of beside the chosen one: those with a button of their own, or all.
std::vector<CouplingKind> laws_told(CouplingKind chosen, bool all = false);

// Returns b_d of every joint: the setting, or the value of the arm's file [N m s/rad].
Eigen::VectorXd device_damping(const ArmDescription& arm, const Parameters& p);
// Returns the Coulomb friction of every joint, likewise [N m].
Eigen::VectorXd device_friction(const ArmDescription& arm, const Parameters& p);

// Returns the coupling's spring of every joint [N m/rad].
Eigen::VectorXd coupling_springs(const ArmDescription& arm, const Parameters& p);

// Returns the delay from a reading to the torque that answers it, beyond the tick [s]: as measured
// on the arm, else by model.delay or the virtual arm's device.delay.
double device_delay(const ArmDescription& arm, const Parameters& p);

// Checks condition (3) for these, and for the link that is set.
Condition3 condition3(const ArmDescription& arm, const Parameters& p);

// Says for people where the figures come from: "inertia, damping and a delay of 2.1 ms, measured".
std::string basis_text(const ArmDescription& arm, const Parameters& p);

// An arm at rest at configuration x [rad].
struct ArmAt {
  Eigen::MatrixXd M;  // inertia (n x n) [kg m^2]
  Eigen::MatrixXd J;  // of the tip (3 x n) [m]
};
ArmAt arm_at(const ArmDescription& arm, const Eigen::VectorXd& x);

// Analyzes an arm at configuration x, with the hand's spring and damper at the tip. w_b [rad/s].
Analysis analyze(const ArmDescription& arm, const Eigen::VectorXd& x, const Parameters& p,
                 std::optional<double> w_b);
// Returns the poles of the locked system in the hand at configuration x [rad/s].
std::vector<std::complex<double>> handle_poles(const ArmDescription& arm, const Eigen::VectorXd& x,
                                               const Parameters& p);
// Analyzes a scalar inertia [kg m^2]; the hand's stiffness and damping count in joint space.
Analysis analyze(double mass, const ArmDescription& arm, const Parameters& p,
                 std::optional<double> w_b);

}  // namespace limpid
