// Successive force augmentation: its soft spring, its increments in closed form, and what it is
// for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/coupling/walls.h"
#include "core/dynamics/arm.h"
#include "core/math/eigen.h"
#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/rows.h"
#include "tests/support/tapping.h"

namespace limpid {
namespace {

using test::Rows;

const Vec3 kSoftWallAt(0.16, 0.03, -0.02);  // where the wall begins [m]

// A press along z on a plane: the hand's target over time, as depth below the plane [m].
struct SoftPress {
  double K = 2000;
  Material material{K};
  Parameters p{};

  SoftPress() {
    p.kind = CouplingKind::sfa;
    p.torque_limit = 100;  // never met
    p.hand_stiffness = 300;
    p.hand_damping = 4;
  }
  template <class Depth>
  Rows run(double seconds, const Depth& depth) const {
    const ArmDescription arm = test::omni();
    Scene scene;
    scene.add({"", pose_at(kSoftWallAt), Plane{Vec3::UnitZ()}, material});
    Rig rig(arm, scene);
    rig.start(p, rest_at(arm, kSoftWallAt + Vec3(0, 0, 0.002)));
    Rows rows(rig.layout());
    for (std::size_t k = 0; static_cast<double>(k) * p.tick < seconds; ++k) {
      const double t = static_cast<double>(k) * p.tick;
      rig.step(p, {{kSoftWallAt - Vec3(0, 0, depth(t)), 1}}, rows.add());
    }
    return rows;
  }
};

// Goes in within 0.2 s and stays.
auto to_rest_at(double depth) {
  return [=](double t) { return -0.002 + std::min(1.0, t / 0.2) * (depth + 0.002); };
}

double depth_in(const Rows& rows, std::size_t k) {
  static const Arm<3> arm(test::omni());
  return kSoftWallAt.z() - arm.tip_at(rows.vec(k, Column::device_position)).z();
}

// Stiffness of the soft spring at the tip: rho b_n/(T/2 + delay).
double soft_spring(const Parameters& p) {
  const TipAlong tip = test::met_by_press(kSoftWallAt, Vec3::UnitZ());
  return p.sfa_soft * tip.damping / (p.tick / 2 + p.delay * p.tick);
}

TEST(Augmentation, BeginsWithASoftSpring) {
  for (const int delay : {0, 2}) {
    SoftPress press;
    press.p.sfa_extended = false;
    press.p.device_delay = press.p.delay = delay;
    const Rows rows = press.run(0.2, to_rest_at(0.004));
    const double soft = soft_spring(press.p) / press.K;
    int seen = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (depth_in(rows, k) <= 1e-5) continue;
      EXPECT_NEAR(rows.at(k, Column::torque_governor), soft, 0.03 * soft) << k;
      ++seen;
    }
    EXPECT_GT(seen, 20);
  }
}

// Extended: the wall itself, bit for bit, until the tip first turns or rests.
TEST(Augmentation, BeginsWithTheWholeWallWhereItIsExtended) {
  SoftPress press;
  const auto way = to_rest_at(0.01);
  const Rows grows = press.run(0.15, way);
  press.p.kind = CouplingKind::direct;
  const Rows direct = press.run(0.15, way);
  std::size_t k = 0;
  while (k < grows.size() && grows.at(k, Column::torque_governor) == 1) ++k;
  for (std::size_t i = 0; i < k; ++i) {
    ASSERT_EQ(grows.vec(i, Column::motor_torque), direct.vec(i, Column::motor_torque)) << i;
  }
  ASSERT_GT(k, 0u);
  EXPECT_GT(depth_in(direct, k - 1), 1e-4) << "the wall was met";
}

// At rest each increment leaves 1 - sigma K_r (K + k_h)/(K (K_r + k_h)) of what is missing, d -
// F/K.
TEST(Augmentation, ComesCloserByTheSamePartWithEachIncrement) {
  for (const double hand : {300.0, 1500.0}) {
    for (const double sigma : {0.2, 0.5}) {
      SoftPress press;
      press.p.hand_stiffness = hand;
      press.p.hand_damping = 6;
      press.p.sfa_extended = false;
      press.p.sfa_step = sigma;
      const Rows rows = press.run(4, to_rest_at(0.004));
      const double K = press.K, K_r = soft_spring(press.p);
      // An increment changes the share, which the tip's own motion hardly does in a tick.
      std::vector<double> missing;
      for (std::size_t k = 500; k < rows.size(); ++k) {
        const double share = rows.at(k, Column::torque_governor),
                     before = rows.at(k - 1, Column::torque_governor);
        if (share - before < 0.5 * sigma * K_r / K * (1 - before)) continue;
        missing.push_back(depth_in(rows, k - 1) * (1 - before));
      }
      ASSERT_GT(missing.size(), 4u);
      const double theory = 1 - sigma * K_r * (K + hand) / (K * (K_r + hand));
      for (std::size_t i = 1; i < missing.size(); ++i) {
        if (missing[i] < 1e-6) break;
        EXPECT_NEAR(missing[i] / missing[i - 1], theory, 0.03 * theory) << hand << " " << i;
      }
    }
  }
}

TEST(Augmentation, ShowsAStiffWallAtRest) {
  for (const bool extended : {true, false}) {
    SoftPress press;
    press.p.sfa_extended = extended;
    const Rows rows = press.run(2.5, to_rest_at(0.01));
    EXPECT_NEAR(rows.at(rows.size() - 1, Column::torque_governor), 1, 0.05) << extended;
  }
}

// After the wall is left it is as at first.
TEST(Augmentation, ForgetsAWallThatIsLeft) {
  SoftPress press;
  press.p.sfa_extended = false;
  const Rows rows = press.run(2.5, [](double t) { return t > 1 && t < 1.3 ? -0.01 : 0.004; });
  const double soft = soft_spring(press.p) / press.K;
  std::size_t back = 1300;
  while (depth_in(rows, back) <= 1e-5) ++back;
  EXPECT_GT(rows.at(999, Column::torque_governor), 0.9);
  EXPECT_NEAR(rows.at(back + 1, Column::torque_governor), soft, 0.03 * soft);
}

// Motors at their limit cannot follow an increment, which would only wind it up: the share stays
// the soft spring's.
TEST(Augmentation, DoesNotWindUpWhereMotorsAreAtTheirLimit) {
  SoftPress press;
  press.p.sfa_extended = false;
  press.p.torque_limit = 0.02;
  press.p.hand_stiffness = 1000;
  const Rows rows = press.run(2, to_rest_at(0.01));
  EXPECT_GT(rows.vec(1999, Column::commanded_torque).norm(), 0.1);
  const double soft = soft_spring(press.p) / press.K;
  EXPECT_NEAR(rows.at(1999, Column::torque_governor), soft, 0.05 * soft);
}

// Friction keeps its part of the normal force, whatever share of it there is.
TEST(Augmentation, RubsAsTheWallPushes) {
  SoftPress press;
  press.material = {press.K, 0, 0.6, 0.4};
  const ArmDescription arm = test::omni();
  Scene scene;
  scene.add({"", pose_at(kSoftWallAt), Plane{Vec3::UnitZ()}, press.material});
  Rig rig(arm, scene);
  rig.start(press.p, rest_at(arm, kSoftWallAt));
  Rows rows(rig.layout());
  for (std::size_t k = 0; k < 900; ++k) {
    const double t = static_cast<double>(k) * press.p.tick;
    const Vec3 along(0, 0.03 * std::max(0.0, t - 0.3), -0.01 * std::min(1.0, t / 0.2));
    rig.step(press.p, {{kSoftWallAt + along, 1}}, rows.add());
    if (t < 0.7) continue;
    Arm<3>::Frames frames;
    const Arm<3> model(arm);
    model.frames(rows.vec(k, Column::device_position), frames);
    Jacobian<3> J;
    model.point_jacobian(frames, 2, model.tip(frames), J);
    const Vec3 force = least_squares(J.transpose(), rows.vec(k, Column::commanded_torque));
    EXPECT_NEAR(force.head<2>().norm(), 0.4 * force.z(), 0.01 * force.z()) << k;
    EXPECT_LT(force.y(), 0);
  }
}

TEST(Augmentation, RunsAgainBitForBit) {
  SoftPress press;
  press.p.encoder_step = 1e-4;
  press.p.device_delay = press.p.delay = 1;
  const auto way = [](double t) { return 0.004 * std::sin(9 * t); };
  EXPECT_EQ(test::first_difference(press.run(0.6, way), press.run(0.6, way)), -1);
}

// A switch begins softly: the wall that is pressed comes back with the increments.
TEST(Augmentation, BeginsSoftlyWhereItTakesOver) {
  const ArmDescription arm = test::omni();
  SoftPress press;
  Scene scene;
  scene.add({"", pose_at(kSoftWallAt), Plane{Vec3::UnitZ()}, press.material});
  Rig rig(arm, scene);
  rig.start(press.p, rest_at(arm, kSoftWallAt + Vec3(0, 0, 0.002)));
  Rows rows(rig.layout());
  for (std::size_t k = 0; k < 1500; ++k) {
    press.p.kind = k < 500 ? CouplingKind::direct : CouplingKind::sfa;
    const double t = static_cast<double>(k) * press.p.tick;
    rig.step(press.p, {{kSoftWallAt - Vec3(0, 0, to_rest_at(0.004)(t)), 1}}, rows.add());
  }
  const double soft = soft_spring(press.p) / press.K;
  EXPECT_NEAR(rows.at(501, Column::torque_governor), soft, 0.05 * soft);
  EXPECT_NEAR(rows.at(1499, Column::torque_governor), 1, 0.1);
}

}  // namespace
}  // namespace limpid
