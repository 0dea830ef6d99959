// An arm for pictures.
#pragma once

#include "core/dynamics/arm_description.h"

namespace limpid::test {

// Two links of 0.2 m in the xz plane, without visuals: drawn as capsules.
inline ArmDescription two_links() {
  ArmDescription arm;
  arm.joints.resize(2);
  arm.links.resize(2);
  for (Joint& joint : arm.joints) joint.axis = Vec3::UnitY();
  arm.joints[1].origin.translation() = Vec3(0.2, 0, 0);
  arm.tip.translation() = Vec3(0.2, 0, 0);
  return arm;
}

}  // namespace limpid::test
