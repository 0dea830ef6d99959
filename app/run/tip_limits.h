// Limits of each coupling at the tip of an arm, without simulating: walls, and what is felt in free
// motion.
#pragma once

#include <array>
#include <string>

#include "core/coupling/felt.h"
#include "core/coupling/walls.h"
#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"
#include "core/touch/scene.h"

namespace limpid {

// Says that no joint moves the tip from the rest pose, so that it has no limits; empty if one does.
std::string still_tip(const ArmDescription& arm);

// Limits along the direction in which the arm's own dampers hold the tip least; walls of the
// predictive coupling along the worst.
struct TipLimits {
  TipAlong tip;
  double delay = 0;  // of the device, as used for walls [s]
  // Stiffest wall that a coupling renders well, or that can be felt through it [N/m], and what
  // bounds it.
  struct Wall {
    double stiffness;
    std::string bound;
  };
  std::array<Wall, kLaws> walls;  // in the order of the laws
  double every_hand;  // stiffest wall that a plain spring renders passively in every hand [N/m]
  double scene;       // stiffest thing in the scene, 0 without any [N/m]
  FeltJoint felt;     // the tip in free motion, in kg, N s/m, N/m
  double w_f;         // of the observer at the tip [rad/s]
  AddedMass added;    // of the predictive coupling: eta as the possible delay leaves it
  int delay_most;     // possible delay [ticks]
};

// Finds the limits at configuration x [rad].
TipLimits tip_limits(const ArmDescription& arm, const Eigen::VectorXd& x, const Parameters& p,
                     const Scene& scene);

// Finds the limits as if the device's torque answered its readings at once.
TipLimits without_delay(const ArmDescription& arm, const Eigen::VectorXd& x, const Parameters& p,
                        const Scene& scene);

// Says what the possible delay leaves of an eta above 1 under the predictive coupling: "5 up to 3.3
// Hz, as the torque may be 3 ms late"; empty if it leaves all of it.
std::string late_text(const TipLimits& limits, const Parameters& p);

// Mass and damping felt in free motion at f [Hz].
struct FeltAtTip {
  double mass;     // [kg]
  double damping;  // [N s/m]
};
FeltAtTip felt_at_tip(const TipLimits& limits, const Parameters& p, CouplingKind kind, double f);

}  // namespace limpid
