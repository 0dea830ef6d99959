// Inverse kinematics: configurations for a given position of the tip.
#pragma once

#include <optional>

#include "core/dynamics/arm_description.h"

namespace limpid {

// Returns a configuration within the joint limits with the tip at `target` [m], to a micrometre; of
// many, one near `guess`. Empty if none is found.
std::optional<Eigen::VectorXd> inverse_kinematics(const ArmDescription& arm, const Vec3& target,
                                                  const Eigen::VectorXd& guess);

// Bound of the distance from the first joint that the tip can reach [m].
double reach(const ArmDescription& arm);

}  // namespace limpid
