#include "tests/bench/bench_arm.h"

#include <cmath>

#include "core/dynamics/arm.h"

namespace limpid::bench {

ArmDescription chain(int joints) {
  const double length = 0.5 / joints;
  const double mass = 0.25 / joints;
  const std::vector<Vec3> axes{Vec3::UnitZ(), Vec3::UnitY(), Vec3(1, 2, 3).normalized(),
                               Vec3::UnitX()};
  ArmDescription arm;
  arm.name = "chain";
  for (int i = 0; i < joints; ++i) {
    Joint joint;
    joint.name = "joint" + std::to_string(i);
    joint.axis = axes[static_cast<std::size_t>(i) % axes.size()];
    if (i > 0) joint.origin.translation() = Vec3(length, 0, 0);
    joint.effort = 1;
    joint.damping = 0.012;
    arm.joints.push_back(joint);

    Link link;
    link.name = "link" + std::to_string(i);
    link.mass = mass;
    link.com = Vec3(length / 2, 0.002, -0.001);
    link.inertia.diagonal() << 2e-6, 3e-6 + mass * length * length / 12,
        4e-6 + mass * length * length / 12;
    arm.links.push_back(link);
  }
  arm.tip.translation() = Vec3(length, 0, 0);
  return arm;
}

Eigen::VectorXd bent(const ArmDescription& arm) {
  Eigen::VectorXd x(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) x[i] = 0.9 * std::cos(1.7 * i) / std::sqrt(1 + i);
  return x;
}

Vec3 tip_of(const ArmDescription& description, const Eigen::VectorXd& x) {
  const Arm<kAnyDof> arm(description);
  Arm<kAnyDof>::Frames f;
  arm.frames(x, f);
  return arm.tip(f);
}

Scene plane_over(const Vec3& tip) {
  Scene scene;
  scene.add({"plane", pose_at(tip + Vec3(0, 0, 0.002)), Plane{}});
  return scene;
}

}  // namespace limpid::bench
