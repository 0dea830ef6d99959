// Loops that start with the tip deep inside of a wall, which no hand has pressed it into.
#include <gtest/gtest.h>

#include <algorithm>

#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

class StartInAWall : public testing::TestWithParam<CouplingKind> {};
INSTANTIATE_TEST_SUITE_P(Laws, StartInAWall,
                         testing::Values(CouplingKind::predictive, CouplingKind::tank));

// The wall of 2,000 N/m holds 3.6 J at a depth of 6 cm.
TEST_P(StartInAWall, GivesTheHandNoMoreThanWhatTheAccountStartsWith) {
  const ArmDescription arm = test::omni();
  const Vec3 tip(0.19, 0, 0);
  Scene scene;
  scene.add({"", pose_at(tip + Vec3(0, 0, 0.06)), Plane{Vec3::UnitZ()}, {2000}});
  Parameters p;
  p.kind = GetParam();
  p.hand_stiffness = 10;
  p.hand_damping = 0;
  Rig rig(arm, scene);
  rig.start(p, rest_at(arm, tip));
  test::Rows rows(rig.layout());
  RigInput input;
  input.hand = {tip, 1};
  double given = 0, least = 0, most = 0;
  for (std::size_t k = 0; k < 1000; ++k) {
    rig.step(p, input, rows.add());
    given -= p.tick * rows.vec(k, Column::hand_torque).dot(rows.vec(k, Column::device_velocity));
    least = std::min(least, given);
    most = std::max(most, given - least);
  }
  EXPECT_LE(most, p.energy);
  EXPECT_LT(rows.at(0, Column::energy_ledger), -3.5);
}

}  // namespace
}  // namespace limpid
