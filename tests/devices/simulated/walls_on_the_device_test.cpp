// Laws that render walls on the device itself: against sampled-data theory, closed forms, and hands
// that try to get energy out of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/coupling/walls.h"
#include "core/dynamics/arm.h"
#include "core/math/eigen.h"
#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

using test::Random;
using test::Rows;

const Vec3 kWallAt(0.16, 0.03, -0.02);  // where the wall begins [m]
constexpr double kStrong = 100;         // limit of motors that never meet it [N m]

Scene one_wall(const Vec3& out, const Material& material) {
  Scene scene;
  scene.add({"", pose_at(kWallAt), Plane{out}, material});
  return scene;
}

struct TipAt {
  Eigen::MatrixXd J, M;
};
TipAt tip_there(const ArmDescription& description, const Eigen::VectorXd& x) {
  const Arm<3> arm(description);
  Arm<3>::Frames frames;
  arm.frames(x, frames);
  Mat<3> M;
  arm.inertia(frames, M);
  Jacobian<3> J;
  arm.point_jacobian(frames, 2, arm.tip(frames), J);
  return {J, M};
}

Eigen::VectorXd damping(const ArmDescription& arm) {
  Eigen::VectorXd b(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) b[i] = arm.joints[static_cast<std::size_t>(i)].damping;
  return b;
}

// A hand that goes into the wall by `depth` within 0.1 s and stays.
Rows pressed_in(const ArmDescription& arm, const Scene& scene, const Vec3& out, double depth,
                double seconds, const Parameters& p) {
  Rig rig(arm, scene);
  rig.start(p, rest_at(arm, kWallAt + 0.001 * out));
  Rows rows(rig.layout());
  for (std::size_t k = 0; static_cast<double>(k) * p.tick < seconds; ++k) {
    const double in = std::min(1.0, static_cast<double>(k) * p.tick / 0.1);
    rig.step(p, {{kWallAt + (0.001 - in * (depth + 0.001)) * out, 1}}, rows.add());
  }
  return rows;
}

TEST(WallsOnTheDevice, PushAsTheirSpringDoesAtTheReading) {
  const ArmDescription arm = test::omni();
  const Arm<3> model(arm);
  for (unsigned seed = 1; seed <= 8; ++seed) {
    Random random(seed);
    const Vec3 out = (Vec3(0, 0, 1) + 0.6 * random.direction()).normalized();
    const double K = random.log_between(200, 2000);
    Parameters p;
    p.kind = CouplingKind::direct;
    p.torque_limit = kStrong;
    const Rows rows = pressed_in(arm, one_wall(out, {K}), out, 0.02, 0.3, p);
    double deepest = 0;
    for (std::size_t k = 1; k < rows.size(); ++k) {
      const Eigen::VectorXd x = rows.vec(k, Column::device_position);
      const double depth = out.dot(kWallAt - model.tip_at(x));
      const Eigen::VectorXd wanted =
          K * std::max(0.0, depth) * tip_there(arm, x).J.transpose() * out;
      EXPECT_LT((rows.vec(k, Column::commanded_torque) - wanted).norm(),
                2e-3 * wanted.norm() + 1e-5)
          << seed << " " << k;
      deepest = std::max(deepest, depth);
    }
    EXPECT_GT(deepest, 0.002);
    EXPECT_LT(
        (rows.vec(200, Column::proxy_position) - rows.vec(199, Column::device_position)).norm(),
        1e-12)
        << "the proxy is where the last reading was";
  }
}

// M v' = -b v - K_h x + tau over a tick, tau held: x and v after it, from series. The wall's torque
// -K_w x of a reading acts `delay` ticks later. Returns the largest growth in a tick.
double growth_in_a_tick(const Eigen::MatrixXd& M, const Eigen::MatrixXd& b,
                        const Eigen::MatrixXd& K_h, const Eigen::MatrixXd& K_w, double T,
                        int delay) {
  const Eigen::Index n = M.rows();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  A.block(0, n, n, n).setIdentity();
  const Eigen::MatrixXd per_mass = M.inverse();
  A.block(n, 0, n, n) = -per_mass * K_h;
  A.block(n, n, n, n) = -per_mass * b;
  A.block(n, 2 * n, n, n) = per_mass;
  Eigen::MatrixXd step = Eigen::MatrixXd::Identity(3 * n, 3 * n), term = step;
  const Eigen::MatrixXd small = A * T / 64;
  for (int k = 1; k < 16; ++k) step += term = (term * small / k).eval();
  for (int i = 0; i < 6; ++i) step = (step * step).eval();
  // State: x, v, and the torques on their way, the next to act first.
  const Eigen::Index late = delay, size = (2 + late) * n;
  Eigen::MatrixXd loop = Eigen::MatrixXd::Zero(size, size);
  loop.topLeftCorner(2 * n, 2 * n) = step.topLeftCorner(2 * n, 2 * n);
  const Eigen::MatrixXd held = step.block(0, 2 * n, 2 * n, n);
  if (late == 0) {
    loop.topLeftCorner(2 * n, n) -= held * K_w;
  } else {
    loop.block(0, 2 * n, 2 * n, n) = held;
    for (Eigen::Index j = 0; j + 1 < late; ++j) {
      loop.block((2 + j) * n, (3 + j) * n, n, n).setIdentity();
    }
    loop.block((1 + late) * n, 0, n, n) = -K_w;
  }
  return eigenvalues(loop).cwiseAbs().maxCoeff();
}

// Beside the stiffest stable wall of the sampled system the loop trembles more and more; below it
// any trembling dies out.
TEST(WallsOnTheDevice, AreStableAsFarAsTheSampledSystemIs) {
  const ArmDescription arm = test::omni();
  const Vec3 out = Vec3::UnitZ();
  for (const int delay : {0, 1, 3}) {
    Parameters p;
    p.kind = CouplingKind::direct;
    p.torque_limit = kStrong;
    p.device_delay = p.delay = delay;
    p.hand_stiffness = 300;
    p.hand_damping = 1;
    const Eigen::VectorXd x = rest_at(arm, kWallAt).x1;
    const TipAt tip = tip_there(arm, x);
    const Eigen::MatrixXd normal = tip.J.transpose() * out * out.transpose() * tip.J;
    const Eigen::MatrixXd all = tip.J.transpose() * tip.J;
    const Eigen::MatrixXd b = Eigen::MatrixXd(damping(arm).asDiagonal()) + p.hand_damping * all;
    double low = 10, high = 1e5;
    for (int i = 0; i < 50; ++i) {
      const double K = std::sqrt(low * high);
      (growth_in_a_tick(tip.M, b, p.hand_stiffness * all, K * normal, p.tick, delay) < 1 ? low
                                                                                         : high) =
          K;
    }
    // Trembling in the last tenth of a second over that a second before [-].
    const auto lasts = [&](double K) {
      const double force = 3;  // presses so deep that the tip never leaves the wall
      const Rows rows =
          pressed_in(arm, one_wall(out, {K}), out, force / K + force / p.hand_stiffness, 1.6, p);
      const auto speed = [&](double from) {
        double most = 0;
        for (std::size_t k = 0; k < 100; ++k) {
          const auto row = static_cast<std::size_t>(1000 * from) + k;
          most = std::max(most, rows.vec(row, Column::device_velocity).norm());
        }
        return most;
      };
      return speed(1.5) / speed(0.5);
    };
    EXPECT_LT(lasts(0.93 * low), 0.5) << delay;
    EXPECT_GT(lasts(1.07 * low), 0.9) << delay;
  }
}

TEST(WallsOnTheDevice, RubWithinTheConeOfFriction) {
  const ArmDescription arm = test::omni();
  Parameters p;
  p.kind = CouplingKind::direct;
  p.torque_limit = kStrong;
  Rig rig(arm, one_wall(Vec3::UnitZ(), {800, 0, 0.6, 0.4}));
  rig.start(p, rest_at(arm, kWallAt));
  Rows rows(rig.layout());
  for (std::size_t k = 0; k < 900; ++k) {
    const double t = static_cast<double>(k) * p.tick;
    const Vec3 along(0, 0.03 * std::max(0.0, t - 0.3), -0.01 * std::min(1.0, t / 0.2));
    rig.step(p, {{kWallAt + along, 1}}, rows.add());
    const auto touches = rows.touches(k);
    if (t < 0.7) continue;
    ASSERT_EQ(touches.size(), 1U);
    const Vec3 f = touches[0].force;
    EXPECT_NEAR(f.head<2>().norm(), 0.4 * f.z(), 1e-6);
    EXPECT_LT(f.y(), 0);
  }
}

// Hands of all kinds, motors that are late and weak, walls far stiffer than the law can show.
TEST(EnergyBounding, GivesNoHandAnything) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    const ArmDescription arm = test::omni();
    const Vec3 out = (Vec3(0, 0, 1) + 0.5 * random.direction()).normalized();
    Parameters p;
    p.kind = CouplingKind::eba;
    p.device_delay = p.delay = static_cast<int>(random.between(0, 3.999));
    p.torque_limit = random.log_between(0.05, 10);
    p.hand_stiffness = random.log_between(20, 5000);
    p.hand_damping = random.one_of({0.0, 0.5, 2.0});
    p.hand_mass_at_tip = random.one_of({0.0, 0.1});
    const double K = random.log_between(100, 20'000), way = random.between(0.005, 0.02);
    const double pace = random.log_between(3, 100);
    Rig rig(arm, one_wall(out, {K}));
    rig.start(p, rest_at(arm, kWallAt));
    Rows rows(rig.layout());
    for (std::size_t k = 0; k < 1500; ++k) {
      const double t = static_cast<double>(k) * p.tick;
      rig.step(p, {{kWallAt - way * std::sin(pace * t) * out, 1}}, rows.add());
      ASSERT_LE(rows.at(k, Column::energy_port), 1e-12) << seed << " " << k;
    }
  }
}

// A slow press sees 2 b_n/(T (1 + d)): the torque whose price the damping of a press just pays.
TEST(EnergyBounding, ShowsASlowHandAsMuchAsTheDampingPaysFor) {
  const ArmDescription arm = test::omni();
  const Eigen::VectorXd x = rest_at(arm, kWallAt).x1;
  const TipAt at = tip_there(arm, x);
  const Vec3 out = least_damped(at.J, damping(arm));
  const TipAlong tip = tip_along(at.J, at.M, damping(arm), out);
  for (const int delay : {0, 1, 3}) {
    Parameters p;
    p.kind = CouplingKind::eba;
    p.torque_limit = kStrong;
    p.device_delay = p.delay = delay;
    p.hand_stiffness = 1000;
    p.hand_damping = 5;
    Rig rig(arm, one_wall(out, {5000}));
    rig.start(p, rest_at(arm, kWallAt));
    Rows rows(rig.layout());
    double force = 0, depth = 0;
    for (std::size_t k = 0; k < 500; ++k) {
      const double t = static_cast<double>(k) * p.tick;
      rig.step(p, {{kWallAt - 0.03 * t * out, 1}}, rows.add());
      if (t < 0.3) continue;
      const Eigen::VectorXd tau = rows.vec(k, Column::motor_torque);
      const Eigen::VectorXd now = rows.vec(k, Column::device_position);
      const TipAt here = tip_there(arm, now);
      force += out.dot(Vec3(least_squares(here.J.transpose(), tau)));
      depth += out.dot(kWallAt - Arm<3>(arm).tip_at(now));
    }
    const double theory = 2 * tip.damping / (p.tick * (1 + delay));
    EXPECT_NEAR(force / depth, theory, 0.1 * theory) << delay;
  }
}

// With more damping believed than there is, the promise ends: the account rests on it alone.
TEST(EnergyBounding, IsAsGoodAsTheDampingItBelieves) {
  const ArmDescription arm = test::omni();
  Parameters p;
  p.kind = CouplingKind::eba;
  p.eba_damping = 4 * damping(arm)[0];
  p.torque_limit = kStrong;
  p.hand_stiffness = 300;
  p.hand_damping = 0;
  const Rows rows = pressed_in(arm, one_wall(Vec3::UnitZ(), {3000}), Vec3::UnitZ(), 0.02, 1, p);
  double most = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    most = std::max(most, rows.at(k, Column::energy_port));
  }
  EXPECT_GT(most, 1e-3);
}

// An arm as heavy as those of the papers.
ArmDescription heavy(double by) {
  ArmDescription arm = test::omni();
  for (Link& link : arm.links) {
    link.mass *= by;
    link.inertia *= by;
  }
  return arm;
}

// The most that a hand was given in three taps [J].
double given_in_taps(const ArmDescription& arm, double K, const Parameters& p) {
  Rig rig(arm, one_wall(Vec3::UnitZ(), {K}));
  rig.start(p, rest_at(arm, kWallAt + Vec3(0, 0, 0.01)));
  Rows rows(rig.layout());
  double most = 0;
  for (std::size_t k = 0; k < 1500; ++k) {
    const double t = static_cast<double>(k) * p.tick;
    const double in = 0.5 - 0.5 * std::cos(4 * M_PI * t);
    rig.step(p, {{kWallAt + Vec3(0, 0, 0.01 - in * (0.01 + 3 / p.hand_stiffness)), 1}}, rows.add());
    most = std::max(most, rows.at(k, Column::energy_port));
  }
  return most;
}

// The direct law gives what the observer sees and the controller takes back.
TEST(PassivityController, TakesBackWhatWallsGaveOnAnArmOfSeventyGrams) {
  const ArmDescription arm = heavy(7);
  for (const double grip : {300.0, 3000.0}) {
    for (const double hand : {0.0, 2.0}) {
      for (const double K : {500.0, 2000.0, 8000.0}) {
        Parameters p;
        p.kind = CouplingKind::popc;
        p.torque_limit = kStrong;
        p.hand_stiffness = grip;
        p.hand_damping = hand;
        EXPECT_LE(given_in_taps(arm, K, p), 1e-3) << grip << " " << hand << " " << K;
      }
    }
  }
  Parameters p;
  p.kind = CouplingKind::direct;
  p.torque_limit = kStrong;
  p.hand_damping = 0;
  EXPECT_GT(given_in_taps(arm, 8000, p), 0.02) << "what the same walls give without it";
}

// Without anything to take back the law is the walls alone, bit for bit.
TEST(PassivityController, LeavesWallsAloneThatGiveNothing) {
  const ArmDescription arm = test::omni();
  Parameters p;
  p.hand_damping = 4;
  p.torque_limit = kStrong;
  p.kind = CouplingKind::direct;
  const Rows direct = pressed_in(arm, one_wall(Vec3::UnitZ(), {100}), Vec3::UnitZ(), 0.01, 0.4, p);
  p.kind = CouplingKind::popc;
  const Rows braked = pressed_in(arm, one_wall(Vec3::UnitZ(), {100}), Vec3::UnitZ(), 0.01, 0.4, p);
  for (std::size_t k = 0; k < direct.size(); ++k) {
    ASSERT_EQ(direct.vec(k, Column::motor_torque), braked.vec(k, Column::motor_torque)) << k;
    ASSERT_EQ(braked.at(k, Column::damping_governor), 1);
  }
}

}  // namespace
}  // namespace limpid
