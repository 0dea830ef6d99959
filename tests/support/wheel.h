// An arm of one joint, whose motion is known in closed form.
#pragma once

#include "core/dynamics/arm_description.h"

namespace limpid::test {

// Returns a joint about z with a link of this inertia [kg m^2] and its tip a metre ahead.
inline ArmDescription wheel(double inertia) {
  ArmDescription arm;
  arm.joints.resize(1);
  arm.links.resize(1);
  arm.joints[0].effort = 1;
  arm.links[0].inertia = inertia * Mat3::Identity();
  arm.tip.translation() = Vec3::UnitX();
  return arm;
}

}  // namespace limpid::test
