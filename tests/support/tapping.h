// Hands that shake, tap and press, on arms above a wall, drawn at random.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/coupling/walls.h"
#include "core/dynamics/arm.h"
#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"
#include "tests/support/rows.h"

namespace limpid::test {

// Mass and damping that a press along `out` meets at the built-in arm's tip.
inline TipAlong met_by_press(const Vec3& tip, const Vec3& out) {
  const ArmDescription description = omni();
  const Arm<3> arm(description);
  Arm<3>::Frames frames;
  const Vec<3> x = rest_at(description, tip).x1;
  arm.frames(x, frames);
  Mat<3> M;
  arm.inertia(frames, M);
  Jacobian<3> J;
  arm.point_jacobian(frames, 2, arm.tip(frames), J);
  return tip_along(J, M, Eigen::Vector3d::Constant(0.012), out);
}

// A run under the law of `p`.
struct Tapping {
  ArmDescription arm;
  Parameters p{};
  double wall = 600;   // 0: no wall [N/m]
  double press = 4;    // [N]
  double shaking = 5;  // [rad/s]
  double seconds = 2;

  Rows run() const {
    RigStart start;
    start.x1 = start.x2 = rest_pose(arm);
    start.v1 = start.v2 = start.f1_hat = Eigen::VectorXd::Zero(start.x1.size());
    const Vec3 home = Arm<kAnyDof>(arm).tip_at(start.x1);
    constexpr double kAbove = 0.01;
    Scene scene;
    if (wall > 0) {
      scene.add({"", pose_at(home - kAbove * Vec3::UnitZ()), Plane{Vec3::UnitZ()}, {wall}});
    }
    start.target = home;
    Rig rig(arm, scene);
    rig.start(p, start);
    Rows rows(rig.layout());
    const auto ticks = static_cast<std::size_t>(seconds / p.tick);
    for (std::size_t k = 0; k < ticks && !rig.diverged(); ++k) {
      const double t = static_cast<double>(k) * p.tick;
      const double way = (kAbove + press / p.hand_stiffness) * (1 - std::cos(shaking * t)) / 2;
      const Vec3 aside(0.01 * std::sin(1.7 * shaking * t), 0.01 * std::sin(0.6 * shaking * t), 0);
      const bool rests = t > 0.7 * seconds;  // at its present place
      if (!rests) start.target = home + aside - way * Vec3::UnitZ();
      rig.step(p, {{start.target, 1}}, rows.add());
    }
    EXPECT_FALSE(rig.diverged());
    return rows;
  }
};

// Highest value of a column, which is above no row's.
inline double highest(const Rows& rows, Column column = Column::energy_total) {
  double most = -HUGE_VAL;
  for (std::size_t k = 0; k < rows.size(); ++k) most = std::max(most, rows.at(k, column));
  return most;
}

// Arm, link, gains, hand and wall drawn by `seed`; the law is `kind`.
inline Tapping at_random(unsigned seed, CouplingKind kind) {
  Random random(seed);
  Tapping t;
  const int dof = random.one_of({2, 3, 3, 5});
  t.arm = dof == 3 && random.between(0, 1) < 0.6 ? omni() : random_arm(dof, seed);
  t.p.kind = kind;
  t.p.link_delay = static_cast<int>(random.between(0, 1) < 0.2 ? 0 : random.log_between(1, 200.9));
  t.p.link_jitter = static_cast<int>(random.one_of({0.0, 1.0}) * random.between(0, 50.9));
  t.p.link_loss = random.one_of({0.0, 0.0, 0.3, 0.9});
  t.p.link_seed = static_cast<int>(seed);
  t.p.k_vc = random.log_between(1, 50);
  t.p.b_vc = random.one_of({0.0, 0.001, 0.02});
  t.p.b_v = random.log_between(1e-3, 0.1);
  t.p.hand_stiffness = random.log_between(50, 3000);
  t.p.hand_damping = random.one_of({0.0, 2.0});
  t.p.inertia_ratio = random.log_between(1e-4, 1);
  t.p.tank_share = random.log_between(1e-3, 1);
  t.wall = random.one_of({0.0, 1.0}) * random.log_between(100, 20000);
  t.press = random.between(0.5, 8);
  t.shaking = random.log_between(2, 60);
  return t;
}

}  // namespace limpid::test
