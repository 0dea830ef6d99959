// Rigs side by side on one hand: none knows of the other.
#include "devices/simulated/lockstep.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/dynamics/arm.h"
#include "tests/support/built_in.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

using test::first_difference;
using test::Rows;

constexpr std::size_t kTicks = 4000;

// Input of a hand that goes down through the table, along it and up again; its grip gives way at
// times.
RigInput input_at(const Vec3& home, std::size_t k) {
  const double t = 1e-3 * static_cast<double>(k);
  const Vec3 way(0.02 * std::sin(2 * t), 0.02 * std::sin(3 * t), -0.08 * std::sin(1.5 * t));
  return {.hand = {home + way, k % 900 < 700 ? 1.0 : 0.3}};
}

TEST(Lockstep, GivesEachRigTheRowsOfItsOwnRunBitForBit) {
  const ArmDescription arm = test::omni();
  const Scene scene = test::omni_scene("table.toml");
  Parameters standard, proposed;
  standard.kind = CouplingKind::standard;
  proposed.kind = CouplingKind::proposed;
  proposed.eta = 0.8;
  Lockstep both;
  both.add(arm, scene, standard);
  both.add(arm, scene, proposed);
  Rig alone_standard(arm, scene), alone_proposed(arm, scene);

  const Arm<kAnyDof> model(arm);
  Arm<kAnyDof>::Frames frames;
  model.frames(rest_pose(arm), frames);
  const Vec3 home = model.tip(frames);
  const RigStart start = rest_at(arm, home);
  both.start(start);
  alone_standard.start(standard, start);
  alone_proposed.start(proposed, start);

  Rows lanes[2] = {Rows(both[0].rig.layout()), Rows(both[1].rig.layout())};
  Rows alone[2] = {lanes[0], lanes[1]};
  int touched = 0;
  for (std::size_t k = 0; k < kTicks; ++k) {
    const RigInput input = input_at(home, k);
    both.step(input);
    for (std::size_t i = 0; i < 2; ++i) lanes[i].add(both[i].row);
    alone_standard.step(standard, input, alone[0].add());
    alone_proposed.step(proposed, input, alone[1].add());
    touched += lanes[0].vec(k, Column::contact_torque).norm() > 1e-3 ? 1 : 0;
  }
  EXPECT_GT(touched, 500) << "in contact";
  EXPECT_EQ(first_difference(lanes[0], alone[0]), -1);
  EXPECT_EQ(first_difference(lanes[1], alone[1]), -1);
  EXPECT_NE(first_difference(lanes[0], lanes[1]), -1) << "they are two";
}

}  // namespace
}  // namespace limpid
