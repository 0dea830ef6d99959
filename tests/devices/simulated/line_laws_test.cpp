// Wave variables and two-port passivity through links of all kinds: energy, and what is felt in
// closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/coupling/walls.h"
#include "core/dynamics/arm.h"
#include "core/math/eigen.h"
#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"
#include "tests/support/rows.h"
#include "tests/support/tapping.h"

namespace limpid {
namespace {

using test::Random;
using test::Rows;

const Vec3 kFarWallAt(0.16, 0.03, -0.02);  // where the wall begins [m]

Scene far_wall(const Vec3& out, double stiffness) {
  Scene scene;
  scene.add({"", pose_at(kFarWallAt), Plane{out}, {stiffness}});
  return scene;
}

Parameters through(CouplingKind kind, int delay) {
  Parameters p;
  p.kind = kind;
  p.link_delay = delay;
  p.torque_limit = 100;  // never met
  return p;
}

struct FarPress {
  double felt;   // stiffness, from the motors' torque and the device's depth [N/m]
  double total;  // highest E_c [J]
  double port;   // most that the hand was given [J]
};

// A hand that goes into the wall by `depth` in 0.2 s and stays for `seconds`.
FarPress press_far(const Parameters& p, const Vec3& out, double K, double depth, double seconds) {
  const ArmDescription arm = test::omni();
  const Arm<3> model(arm);
  Rig rig(arm, far_wall(out, K));
  rig.start(p, rest_at(arm, kFarWallAt + 0.002 * out));
  Rows rows(rig.layout());
  FarPress pressed{0, 0, 0};
  for (std::size_t k = 0; static_cast<double>(k) * p.tick < seconds; ++k) {
    const double in = std::min(1.0, static_cast<double>(k) * p.tick / 0.2);
    rig.step(p, {{kFarWallAt + (0.002 - in * (depth + 0.002)) * out, 1}}, rows.add());
    pressed.total = std::max(pressed.total, rows.at(k, Column::energy_total));
    pressed.port = std::max(pressed.port, rows.at(k, Column::energy_port));
  }
  const Eigen::VectorXd x = rows.vec(rows.size() - 1, Column::device_position);
  Arm<3>::Frames frames;
  model.frames(x, frames);
  Jacobian<3> J;
  model.point_jacobian(frames, 2, model.tip(frames), J);
  const Vec3 force = least_squares(J.transpose(), rows.vec(rows.size() - 1, Column::motor_torque));
  pressed.felt = out.dot(force) / out.dot(kFarWallAt - model.tip_at(x));
  return pressed;
}

TEST(Waves, GiveNothingThroughAnyLink) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    const Vec3 out = (Vec3(0, 0, 1) + 0.5 * random.direction()).normalized();
    Parameters p = through(CouplingKind::wave, static_cast<int>(random.between(0, 100)));
    p.link_jitter = static_cast<int>(random.one_of({0.0, 5.0, 30.0}));
    p.link_loss = random.one_of({0.0, 0.2, 0.6});
    p.hand_stiffness = random.log_between(50, 2000);
    p.hand_damping = random.one_of({0.0, 2.0});
    p.wave_b = random.log_between(0.002, 0.012);
    const double K = random.log_between(200, 10'000), pace = random.log_between(2, 60);
    const ArmDescription arm = test::omni();
    Rig rig(arm, far_wall(out, K));
    rig.start(p, rest_at(arm, kFarWallAt));
    Rows rows(rig.layout());
    for (std::size_t k = 0; k < 1500; ++k) {
      const double t = static_cast<double>(k) * p.tick;
      rig.step(p, {{kFarWallAt - 0.015 * std::sin(pace * t) * out, 1}}, rows.add());
      ASSERT_LE(rows.at(k, Column::energy_total), 1e-9) << seed << " " << k;
    }
  }
}

// 1/(1/K + 1/k_vc + (t_l + T/2)/b): spring, line and wall in a row.
TEST(Waves, AreAsSoftAsSpringAndLineInARow) {
  const Vec3 out = Vec3::UnitZ();
  const TipAlong tip = test::met_by_press(kFarWallAt, out);
  for (const int delay : {0, 5, 20}) {
    Parameters p = through(CouplingKind::wave, delay);
    p.hand_damping = 4;
    const double line = line_at_tip(tip, p.k_vc, p.line(), (delay + 0.5) * p.tick);
    const double theory = 1 / (1 / 5000.0 + 1 / line);
    const FarPress pressed = press_far(p, out, 5000, 0.01, 4);
    EXPECT_NEAR(pressed.felt, theory, 0.06 * theory) << delay;
    EXPECT_LE(pressed.total, 1e-9);
  }
}

// At a steady pace the hand pulls against the device's damper, the line's and the proxy's.
TEST(Waves, DragAsTheirDampersDo) {
  const ArmDescription arm = test::omni();
  for (const int delay : {0, 20}) {
    Parameters p = through(CouplingKind::wave, delay);
    p.hand_stiffness = 3000;
    p.wave_b = 0.02;
    Rig rig(arm, Scene{});
    rig.start(p, rest_at(arm, kFarWallAt));
    Rows rows(rig.layout());
    Eigen::VectorXd torque = Eigen::VectorXd::Zero(3), speed = torque;
    for (std::size_t k = 0; k < 700; ++k) {
      const double t = static_cast<double>(k) * p.tick;
      rig.step(p, {{kFarWallAt + Vec3(0, 0, 0.1 * t), 1}}, rows.add());
      if (k < 500) continue;
      torque += rows.vec(k, Column::motor_torque);
      speed += rows.vec(k, Column::device_velocity);
    }
    const Eigen::VectorXd wanted = -(p.wave_b + p.b_v) * speed;
    EXPECT_LT((torque - wanted).norm(), 0.05 * wanted.norm()) << delay;
  }
}

TEST(TwoPorts, GiveLittleThroughLinksToFiftyMilliseconds) {
  for (const int delay : {0, 5, 20, 50}) {
    for (const double hand : {0.0, 2.0}) {
      for (const double K : {600.0, 5000.0}) {
        Parameters p = through(CouplingKind::tdpn, delay);
        p.hand_damping = hand;
        EXPECT_LE(press_far(p, Vec3::UnitZ(), K, 0.01, 2).port, 5e-3) << delay << " " << hand;
      }
    }
  }
}

TEST(TwoPorts, AreStifferThanMatchedWaves) {
  for (const int delay : {5, 10, 20}) {
    Parameters p = through(CouplingKind::tdpn, delay);
    p.hand_damping = 4;
    const double mine = press_far(p, Vec3::UnitZ(), 5000, 0.01, 3).felt;
    p.kind = CouplingKind::wave;
    EXPECT_GT(mine, press_far(p, Vec3::UnitZ(), 5000, 0.01, 3).felt) << delay;
  }
}

// The same fate of packets, the same rows.
TEST(TwoPorts, AndWavesRunAgainBitForBit) {
  const ArmDescription arm = test::omni();
  for (const CouplingKind kind : {CouplingKind::wave, CouplingKind::tdpn}) {
    Parameters p = through(kind, 7);
    p.link_jitter = 5;
    p.link_loss = 0.3;
    const auto run = [&] {
      Rig rig(arm, far_wall(Vec3::UnitZ(), 2000));
      rig.start(p, rest_at(arm, kFarWallAt));
      Rows rows(rig.layout());
      for (std::size_t k = 0; k < 400; ++k) {
        const double t = static_cast<double>(k) * p.tick;
        rig.step(p, {{kFarWallAt - Vec3(0, 0, 0.02 * std::sin(9 * t)), 1}}, rows.add());
      }
      return rows;
    };
    EXPECT_EQ(test::first_difference(run(), run()), -1) << name(kind);
  }
}

}  // namespace
}  // namespace limpid
