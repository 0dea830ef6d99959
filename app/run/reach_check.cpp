#include "app/run/reach_check.h"

#include <fmt/format.h>

#include "core/dynamics/inverse_kinematics.h"

namespace limpid {

std::string out_of_reach(const RunPlan& plan) {
  const Vec3 base = plan.arm.joints.front().origin.translation();
  const double limit = reach(plan.arm) * (1 + 1e-9);  // stretched out is in reach
  for (std::size_t i = 0; i < plan.hand.position.size(); ++i) {
    const double distance = (plan.hand.position[i] - base).norm();
    if (distance <= limit) continue;
    return fmt::format(
        "{}: the point at {:.3f} s is {:.4f} m from the first joint; the arm {} reaches {:.4f} m",
        plan.hand.source, plan.hand.time[i], distance, plan.arm.name, limit);
  }
  if (plan.start) return {};
  const Vec3& p = plan.hand.position.front();
  if (inverse_kinematics(plan.arm, p, rest_pose(plan.arm))) return {};
  return fmt::format(
      "{}: the first point ({:.4f}, {:.4f}, {:.4f}) m is out of reach of the arm {} within its "
      "joint limits",
      plan.hand.source, p.x(), p.y(), p.z(), plan.arm.name);
}

}  // namespace limpid
