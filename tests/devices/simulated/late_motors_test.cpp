// Motors with a delay, known or not: energy that the predictive law gives to the hand in free
// motion and at the walls that it recommends.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/coupling/walls.h"
#include "core/dynamics/arm.h"
#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

using test::Rows;

struct Late {
  int delay = 0;         // [ticks]
  bool known = false;    // the law knows the delay
  bool bounded = false;  // the law is given a bound of 3 ticks
  double eta = 1;
  double grip = 300, damping = 2;  // [N/m, N s/m]
  double step = 0;                 // step of the encoders [rad]
  double wall = 0;                 // 0: free motion [N/m]

  Parameters parameters() const {
    Parameters p;
    p.kind = CouplingKind::predictive;
    p.eta = eta;
    p.encoder_step = step;
    p.device_delay = delay;
    p.delay = known ? delay : 0;
    if (bounded) p.delay_most = 3;
    p.hand_stiffness = grip;
    p.hand_damping = damping;
    return p;
  }
};

class LateMotors : public testing::Test {
 protected:
  LateMotors() {
    const Eigen::VectorXd x = rest_pose(arm_), zero = Eigen::VectorXd::Zero(3);
    start_.x1 = start_.x2 = x;
    start_.v1 = start_.v2 = start_.f1_hat = zero;
    const Arm<3> arm(arm_);
    Arm<3>::Frames frames;
    arm.frames(x, frames);
    start_.target = arm.tip(frames);
    Mat<3> M;
    arm.inertia(frames, M);
    Jacobian<3> J;
    arm.point_jacobian(frames, 2, start_.target, J);
    tip_ = easiest(J, M);
  }

  double named(const Late& l) const {
    const Parameters p = l.parameters();
    return predictive_wall(
               tip_, {{p.tick, p.k_vc, p.b_v, p.eta, p.hand_damping, 0, p.device_delay * p.tick},
                      p.encoder_step,
                      0,
                      p.hand_mass,
                      p.delay * p.tick,
                      p.inertia_ratio})
        .stiffness;
  }

  // Most energy that the hand is given [J]: in a tap that is held, or a free motion that ends.
  double given(const Late& l) const {
    constexpr double kAbove = 0.02, kSpeed = 0.15, kPress = 4;  // [m, m/s, N]
    const Parameters p = l.parameters();
    Scene scene;
    if (l.wall > 0) {
      scene.add(
          {"", pose_at(start_.target - kAbove * Vec3::UnitZ()), Plane{Vec3::UnitZ()}, {l.wall}});
    }
    Rig rig(arm_, scene);
    rig.start(p, start_);
    Rows rows(rig.layout());
    double most = 0;
    for (std::size_t k = 0; k < 2000 && !rig.diverged(); ++k) {
      const double t = static_cast<double>(k) * p.tick;
      Vec3 hand = start_.target;
      if (l.wall > 0) {
        const double way = kAbove + kPress / l.grip + kPress / l.wall;
        hand -= std::clamp(kSpeed * (t - 0.05), 0.0, way) * Vec3::UnitZ();
      } else if (t < 1.5) {
        hand +=
            0.01 * std::min(1.0, 4 * t) * Vec3(std::sin(9 * t), std::sin(23 * t), std::sin(14 * t));
      }
      rig.step(p, {{hand, 1}}, rows.add());
      most = std::max(most, rows.at(k, Column::energy_port));
    }
    EXPECT_FALSE(rig.diverged());
    return most;
  }

  // Calls `use` for all etas, grips and delays.
  template <class Use>
  static void each(const Use& use) {
    for (const bool known : {false, true}) {
      for (int delay = known ? 1 : 0; delay <= 3; ++delay) {
        for (const double eta : {0.1, 0.6, 1.0, 2.0, 5.0}) {
          for (const double grip : {100.0, 1000.0, 3000.0}) {
            Late late;
            late.known = known;
            late.delay = delay;
            late.eta = eta;
            late.grip = grip;
            use(late);
          }
        }
      }
    }
  }

  const ArmDescription arm_ = test::omni();
  RigStart start_;
  TipMoved tip_{};
};

constexpr double kPromised = 5e-3;  // [J]

TEST_F(LateMotors, GiveTheHandNoMoreThanThePromiseInFreeMotion) {
  double most = 0;
  each([&](Late late) {
    for (const double damping : {2.0, 0.0}) {
      late.damping = damping;
      const double given = this->given(late);
      most = std::max(most, given);
      EXPECT_LE(given, kPromised) << (late.known ? "known" : "unknown") << " delay " << late.delay
                                  << ", eta " << late.eta << ", grip " << late.grip << " N/m, "
                                  << damping << " N s/m";
    }
  });
  EXPECT_GT(most, 1e-3) << "nothing was tried";
}

TEST_F(LateMotors, GiveTheHandNoMoreThanThePromiseAtWallsThatAreNamed) {
  each([&](Late late) {
    late.wall = named(late);
    for (const double damping : {2.0, 0.0}) {
      late.damping = damping;
      late.step = damping > 0 ? 1e-4 : 0;
      EXPECT_LE(given(late), kPromised)
          << (late.known ? "known" : "unknown") << " delay " << late.delay << ", eta " << late.eta
          << ", grip " << late.grip << " N/m, " << damping << " N s/m, wall " << late.wall;
    }
  });
}

// An absent delay costs nothing: with a bound of 3 ms and no delay no torque is held back.
TEST_F(LateMotors, ThatAreNotLateAreNotHeldBack) {
  for (const double eta : {0.3, 1.0, 5.0}) {
    Late late;
    late.bounded = true;
    late.eta = eta;
    EXPECT_LE(given(late), 1e-5) << eta;
    late.wall = 5000;
    EXPECT_LE(given(late), 1e-5) << eta;
  }
}

}  // namespace
}  // namespace limpid
