// Arms of any number of joints, bent, with the tip pressed against a plane.
#pragma once

#include "core/dynamics/arm_description.h"
#include "core/touch/scene.h"

namespace limpid::bench {

// A chain half a metre long and a quarter of a kilogram in all, its axes turning about z, y, x and
// askew by turns.
ArmDescription chain(int joints);

// A posture without anything special about it [rad].
Eigen::VectorXd bent(const ArmDescription& arm);
// Where the tip then is [m].
Vec3 tip_of(const ArmDescription& arm, const Eigen::VectorXd& x);

// A level surface 2 mm above that point.
Scene plane_over(const Vec3& tip);

}  // namespace limpid::bench
