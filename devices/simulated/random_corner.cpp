#include "devices/simulated/random_corner.h"

#include <algorithm>
#include <numbers>

#include "core/dynamics/arm.h"
#include "core/dynamics/random.h"
#include "core/dynamics/random_arm.h"

namespace limpid {
namespace {

constexpr double kAway = 0.008;  // distance of the start from the planes [m]

// A start at rest in a random pose.
RigStart anywhere(const ArmDescription& description, Random& random) {
  const int dof = description.dof();
  const Arm<kAnyDof> arm(description);
  RigStart start;
  start.x1 = start.x2 = random.vector(dof, 0.6);
  start.v1 = start.v2 = start.f1_hat = Eigen::VectorXd::Zero(dof);
  start.target = arm.tip_at(start.x1);
  return start;
}

}  // namespace

Vec3 LimitedCorner::hand(double t) const {
  const double in = std::clamp((t - 0.02) / rise, 0.0, 1.0);
  const double rubs = t > 0.4 ? 0.01 * sine(2 * std::numbers::pi * 5 * (t - 0.4)) : 0;
  return start.target - in * way * out + rubs * along;
}

LimitedCorner limited_corner(unsigned seed, const CornerWidth& width,
                             const ArmDescription& desktop) {
  Random random(seed);
  LimitedCorner c;
  const int dof = random.one_of(width.dofs);
  c.arm = dof == desktop.dof() ? desktop : random_arm(dof, seed);
  c.limit = random.log_between(0.1, 0.6);
  c.p.kind = CouplingKind::predictive;
  c.p.torque_limit = c.limit;
  c.p.eta = width.eta ? random.log_between(0.2, 5) : 1;
  c.p.hand_stiffness = random.log_between(100, width.grip);
  c.p.hand_damping = 1;
  c.p.hand_mass_at_tip = random.one_of(width.masses);
  c.out = random.direction();
  c.start = dof == desktop.dof() ? rest_at(c.arm, Vec3(0.13, 0, 0) + random.point(0.02))
                                 : anywhere(c.arm, random);
  c.along = c.out.unitOrthogonal();
  const double stiffness = random.log_between(300, 10'000);
  const double friction = random.one_of(width.friction);
  const int planes = 1 + static_cast<int>(random.between(0, width.planes - 1e-9));
  for (int i = 0; i < planes; ++i) {
    Vec3 normal = c.out;
    while (i > 0) {
      // Draws one number a statement: compilers may evaluate arguments in any order.
      const Vec3 aside = random.direction();
      normal = (c.out + random.between(0.05, 1) * aside).normalized();
      if (normal.dot(c.out) > 0.3) break;
    }
    const double K = i > 0 && random.between(0, 1) < 0.5 ? stiffness / 3 : stiffness;
    c.scene.add(
        {"", pose_at(c.start.target - kAway * c.out), Plane{normal}, {K, 0, friction, friction}});
  }
  c.press = random.between(1, 5);
  c.rise = random.between(0.02, 0.2);
  c.way = kAway + c.press / c.p.hand_stiffness + c.press / stiffness;
  return c;
}

}  // namespace limpid
