// Where a hand may be asked to go.
#pragma once

#include "core/dynamics/arm_description.h"
#include "core/dynamics/inverse_kinematics.h"

namespace limpid {

// Held where the arm can follow.
inline Vec3 within_reach(const ArmDescription& arm, const Vec3& point) {
  const Vec3 base = arm.joints.front().origin.translation();
  const double limit = 0.985 * reach(arm);
  const Vec3 out = point - base;
  return out.norm() > limit ? Vec3(base + out.normalized() * limit) : point;
}

}  // namespace limpid
