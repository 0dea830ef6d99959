// How far an arm gets.
#pragma once

#include "core/dynamics/arm_description.h"

namespace limpid {

struct FarthestTip {
  double distance = 0;  // from the origin of the first joint [m]
  Eigen::VectorXd at;   // a configuration within the limits in which the tip is there [rad]
};

// The point farthest from the origin of the first joint that the tip gets to within the joints'
// limits; a slide without limits stays at 0. Found by climbing from many configurations, the same
// ones every time: never farther than the arm gets, and where links fold in many ways it may be
// somewhat nearer. Takes milliseconds.
FarthestTip farthest_tip(const ArmDescription& arm);

}  // namespace limpid
