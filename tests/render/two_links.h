// An arm for pictures, and their size.
#pragma once

#include "core/dynamics/arm_description.h"
#include "render/scene_view.h"

namespace limpid::test {

inline constexpr int kWidth = 320, kHeight = 200;  // [pixels]

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

// Pose of such an arm at angles of its joints [rad].
inline ArmPose pose_of(const ArmDescription& arm, double first, double second) {
  Pose a = arm.joints[0].origin;
  a.rotate(Eigen::AngleAxisd(first, Vec3::UnitY()));
  Pose b = a * arm.joints[1].origin;
  b.rotate(Eigen::AngleAxisd(second, Vec3::UnitY()));
  return {{a, b}, b * Vec3(arm.tip.translation()), {}};
}

}  // namespace limpid::test
