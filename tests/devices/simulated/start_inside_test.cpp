// Loops that start with the tip inside of a wall.
#include <gtest/gtest.h>

#include <algorithm>

#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

using test::Rows;

constexpr double kReserve = 5e-3;  // of the account at a start [J]

// Runs a hand that holds still for a second and lifts the tip by 40 mm in the next; a wall's
// surface is `above` the start.
Rows lifted_out(double stiffness, double above) {
  Scene scene;
  scene.tip_radius = 0.002;
  Object wall;
  wall.name = "wall";
  wall.shape = Plane{};
  wall.pose = pose_at({0.19, 0, -0.02 + above});
  wall.material = {stiffness, 0, 0, 0};
  scene.add(wall);
  Parameters p;
  p.kind = CouplingKind::predictive;
  p.hand_stiffness = 300;
  p.hand_damping = 2;
  const auto hand = [](double t) {
    return Vec3(0.19, 0, -0.02 + 0.04 * std::clamp(t - 1, 0.0, 1.0));
  };
  const ArmDescription arm = test::omni();
  Rig rig(arm, scene);
  rig.start(p, rest_at(arm, hand(0)));
  Rows rows(rig.layout());
  for (int k = 0; k < 2000; ++k) rig.step(p, {{hand(k * p.tick), 1}}, rows.add());
  return rows;
}

// The wall holds up to 2 J then; the hand is given no more than the account has, and the work of a
// tick.
TEST(AStartInsideOfAWall, GivesNoMoreThanTheAccountHas) {
  for (const double stiffness : {300.0, 2000.0, 10000.0}) {
    for (const double above : {0.001, 0.005, 0.02}) {
      SCOPED_TRACE(testing::Message() << stiffness << " N/m, " << above << " m");
      const Rows rows = lifted_out(stiffness, above);
      double given = 0;
      for (std::size_t k = 0; k < rows.size(); ++k) {
        given = std::max(given, rows.at(k, Column::energy_port));
      }
      EXPECT_LE(given, 1.03 * kReserve);
    }
  }
}

}  // namespace
}  // namespace limpid
