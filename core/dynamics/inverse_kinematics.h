// Configurations that put the tip somewhere.
#pragma once

#include <optional>

#include "core/dynamics/arm_description.h"

namespace limpid {

// A configuration within the joint limits with the tip at `target` [m], to a micrometre; of many,
// one near `guess`. Nothing if none is found.
std::optional<Eigen::VectorXd> inverse_kinematics(const ArmDescription& arm, const Vec3& target,
                                                  const Eigen::VectorXd& guess);

// No point further than this from the first joint can be reached [m].
double reach(const ArmDescription& arm);

}  // namespace limpid
