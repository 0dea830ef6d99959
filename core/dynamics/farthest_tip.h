// The farthest point that an arm's tip reaches.
#pragma once

#include "core/dynamics/arm_description.h"

namespace limpid {

struct FarthestTip {
  double distance = 0;  // distance from the origin of the first joint [m]
  Eigen::VectorXd at;   // configuration of the tip there, within the limits [rad]
};

// Finds the point farthest from the origin of the first joint that the tip reaches within the
// joints' limits; a slide without limits stays at 0. Climbs from many configurations, always the
// same ones: never too far, and where links fold in many ways perhaps somewhat too near. Takes
// milliseconds.
FarthestTip farthest_tip(const ArmDescription& arm);

}  // namespace limpid
