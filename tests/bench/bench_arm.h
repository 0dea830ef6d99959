// Arms of any number of joints, bent, with the tip pressed against a plane.
#pragma once

#include "core/dynamics/arm_description.h"
#include "core/touch/scene.h"

namespace limpid::bench {

// A chain of half a metre and a quarter of a kilogram in all; its axes turn about z, y, x and askew
// by turns.
ArmDescription chain(int joints);

// A posture without any singularity [rad].
Eigen::VectorXd bent(const ArmDescription& arm);
// The tip in posture x [m].
Vec3 tip_of(const ArmDescription& arm, const Eigen::VectorXd& x);

// A level plane 2 mm above the tip.
Scene plane_over(const Vec3& tip);

}  // namespace limpid::bench
