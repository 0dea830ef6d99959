// Limits of each coupling at the tip of an arm, without simulating: walls, and what is felt in free
// motion.
#pragma once

#include <array>
#include <string>

#include "core/coupling/law_at_tip.h"
#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"
#include "core/touch/scene.h"

namespace limpid {

// Says that no joint moves the tip from the rest pose, so that it has no limits; empty if one does.
std::string still_tip(const ArmDescription& arm);

// Limits along the direction in which the arm's own dampers hold the tip least; walls of the
// predictive coupling along the worst.
struct TipLimits : LawAtTip {
  std::array<TipWall, kLaws> walls;  // in the order of the laws
  double every_hand = 0;  // stiffest wall that a plain spring renders passively in every hand [N/m]
  double scene = 0;       // stiffest thing in the scene, 0 without any [N/m]
  int delay_most = 0;     // possible delay [ticks]

  const TipWall& wall(CouplingKind kind) const { return walls[static_cast<std::size_t>(kind)]; }
};

// Finds the limits at configuration x [rad].
TipLimits tip_limits(const ArmDescription& arm, const Eigen::VectorXd& x, const Parameters& p,
                     const Scene& scene);

// Finds the limits as if the device's torque answered its readings at once.
TipLimits without_delay(const ArmDescription& arm, const Eigen::VectorXd& x, const Parameters& p,
                        const Scene& scene);

// Says what possible delay and proxy leave of an eta above 1 under the predictive coupling: "5 up
// to 3.3 Hz, because the torque may be 3 ms late"; empty if they leave all of it.
std::string less_added_text(const TipLimits& limits, const Parameters& p);

}  // namespace limpid
