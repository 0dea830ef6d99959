#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/tick/parameters.h"
#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/meshes.h"
#include "tests/support/rows.h"

namespace limpid::test {
namespace {

Object loose_block(double mass, const Vec3& at, double friction, double stiffness) {
  Object o;
  o.name = "block";
  o.shape = Box{Vec3::Constant(0.03)};
  o.pose = pose_at(at);
  o.material = {stiffness, 0, friction, friction};
  o.body = Body{};
  o.body->mass = mass;
  return o;
}

struct PushOutcome {
  double energy = 0;        // highest E_c [J]
  double beyond = 0;        // most energy to the hand beyond what bodies gave [J]
  double gain = 0;          // most energy that the bodies' world made [J]
  double force = 0;         // largest contact force [N]
  Vec3 end = Vec3::Zero();  // end of the last body's centre
};

PushOutcome push(const Scene& scene, double eta, double grip, int ticks,
                 const std::function<HandInput(double)>& hand) {
  const ArmDescription arm = omni();
  Parameters p;
  p.kind = CouplingKind::predictive;
  p.eta = eta;
  p.hand_stiffness = grip;
  Rig rig(arm, scene);
  rig.start(p, rest_at(arm, hand(0).target));
  const RowLayout& layout = rig.layout();
  std::vector<double> row(static_cast<std::size_t>(layout.stride()));
  const auto at = [&](Column c) { return layout.in(std::span<const double>(row), c); };
  PushOutcome all;
  for (int k = 0; k < ticks; ++k) {
    rig.step(p, {hand(k * p.tick)}, row);
    all.energy = std::max(all.energy, at(Column::energy_total)[0]);
    all.beyond =
        std::max(all.beyond, at(Column::energy_port)[0] + at(Column::energy_to_objects)[0]);
    all.gain = std::max(all.gain, at(Column::objects_gain)[0]);
    const auto force = at(Column::contact_force);
    all.force = std::max(all.force, Vec3(force[0], force[1], force[2]).norm());
  }
  const auto pose = at(Column::body_pose);
  const std::size_t last = pose.size() - 7;
  all.end = Vec3(pose[last], pose[last + 1], pose[last + 2]);
  return all;
}

HandInput across(double t) { return {Vec3(0.18, -0.01 + 0.04 * std::min(t, 1.5), 0)}; }

class MovingBodies : public testing::TestWithParam<double> {};  // stiffness [N/m]

TEST_P(MovingBodies, ArePushedWithoutEnergyFromContact) {
  for (const double eta : {1.0, 0.3}) {
    for (const double mass : {0.0005, 0.005, 0.5}) {
      Scene scene;
      scene.tip_radius = 0.004;
      scene.gravity.setZero();
      scene.add(loose_block(mass, {0.18, 0.03, 0}, 0, GetParam()));
      const PushOutcome r = push(scene, eta, 300, 2000, across);
      EXPECT_LE(r.energy, 5e-5) << mass;
      EXPECT_LE(r.beyond, 5e-5) << mass;
      EXPECT_LE(r.gain, 1e-6) << mass;
      EXPECT_GT(r.end.y(), 0.04) << mass;  // the body moved
    }
  }
}

TEST_P(MovingBodies, FallOnTheTipAndGiveNoMoreThanTheyHad) {
  Scene scene;
  scene.tip_radius = 0.004;
  scene.add(loose_block(0.05, {0.18, 0, 0.119}, 0.5, GetParam()));
  const PushOutcome r =
      push(scene, 1, 300, 500, [](double) { return HandInput{Vec3(0.18, 0, 0)}; });
  EXPECT_GT(r.force, 1);
  EXPECT_LE(r.beyond, 5e-5);
  EXPECT_LE(r.gain, 1e-6);
}

// The hand's wish, as recorded, leads a run again. The held body would not do, as the hold broke.
TEST(MagnetThatBreaks, IsWantedAgainAsTheHandDid) {
  Scene scene;
  scene.tip_radius = 0.004;
  Object o = loose_block(0.05, {0.18, 0.018, 0}, 0, 2000);
  o.body->magnet = true;
  BodyJoint& joint = o.body->joint.emplace();  // a strong spring holds it back
  joint.axis = Vec3::UnitY();
  joint.force.spring = 1000;
  scene.add(o);
  const ArmDescription arm = omni();
  Parameters p;
  p.kind = CouplingKind::predictive;
  p.torque_limit = 5;  // strong enough to break the hold
  Rig first(arm, scene), second(arm, scene);
  const RigStart start = rest_at(arm, Vec3(0.18, -0.002, 0));
  first.start(p, start);
  second.start(p, start);
  const RowLayout& layout = first.layout();
  std::vector<double> row(static_cast<std::size_t>(layout.stride())), again = row;
  bool held = false, broke = false;
  for (int k = 0; k < 1500; ++k) {
    RigInput input;
    input.hand.target = Vec3(0.18, -0.002 - 4e-5 * k, 0);
    input.hand.magnet = true;
    first.step(p, input, row);
    input.hand.magnet = layout.in(std::span<const double>(row), Column::hand_magnet)[0] > 0;
    second.step(p, input, again);
    ASSERT_EQ(test::differences(layout, row, again), 0) << k;
    const bool holds = layout.in(std::span<const double>(row), Column::magnet)[0] > 0;
    broke = broke || (held && !holds);
    held = holds;
  }
  EXPECT_TRUE(broke);
  EXPECT_FALSE(held);
}

TEST_P(MovingBodies, HangOnTheMagnetHoweverLight) {
  for (const double mass : {0.0001, 0.05}) {
    Scene scene;
    scene.tip_radius = 0.004;
    scene.gravity.setZero();
    Object o = loose_block(mass, {0.18, 0.018, 0}, 0, GetParam());
    o.body->magnet = true;
    scene.add(o);
    const PushOutcome r = push(scene, 1, 300, 1500, [](double t) {
      HandInput hand{Vec3(0.18, 0.02 * std::sin(6 * t) - 0.002, 0)};
      hand.magnet = t < 1;
      return hand;
    });
    EXPECT_LE(r.energy, 5e-5) << mass;
    EXPECT_LE(r.beyond, 5e-5) << mass;
    EXPECT_LE(r.gain, 1e-6) << mass;
    EXPECT_GT((r.end - Vec3(0.18, 0.018, 0)).norm(), 0.005) << mass;  // the tip moved it
  }
}

// A body pulled against the tip gives the hand no more energy than it got.
TEST_P(MovingBodies, ArePulledAgainstTheTip) {
  Scene scene;
  scene.tip_radius = 0.004;
  scene.gravity.setZero();
  scene.add(loose_block(0.05, {0.18, 0.05, 0}, 0, GetParam()));
  const ArmDescription arm = omni();
  Parameters p;
  p.kind = CouplingKind::predictive;
  Rig first(arm, scene), second(arm, scene);
  first.start(p, rest_at(arm, Vec3(0.18, 0, 0)));
  second.start(p, rest_at(arm, Vec3(0.18, 0, 0)));
  const RowLayout& layout = first.layout();
  std::vector<double> row(static_cast<std::size_t>(layout.stride())), again = row;
  const auto at = [&](Column c) { return layout.in(std::span<const double>(row), c); };
  double most = -1, touched = 0, gain = -1;
  for (int k = 0; k < 2000; ++k) {
    RigInput input;
    input.hand.target = Vec3(0.18, 0, 0);
    if (k % 500 < 400) {
      input.hand.pull = {0, {0.005, 0, 0.005}, {0.18, 0.05 - 0.1 * std::sin(0.01 * k), 0.005}};
    }
    first.step(p, input, row);
    // The second run takes its input from the first one's row, as from a recording.
    input.hand.pull.body = static_cast<int>(at(Column::hand_pull)[0]) - 1;
    for (int i = 0; i < 3; ++i) {
      const auto j = static_cast<std::size_t>(i);
      input.hand.pull.point[i] = at(Column::pull_point)[j];
      input.hand.pull.target[i] = at(Column::pull_target)[j];
    }
    second.step(p, input, again);
    ASSERT_EQ(test::differences(layout, row, again), 0) << k;
    most = std::max(most, at(Column::energy_port)[0] + at(Column::energy_to_objects)[0]);
    touched = std::max(touched, at(Column::contact_potential)[0]);
    gain = std::max(gain, at(Column::objects_gain)[0]);
  }
  EXPECT_GT(touched, 0);
  EXPECT_LE(most, 5e-5);
  EXPECT_LE(gain, 1e-6);
  EXPECT_GT(at(Column::energy_pulled)[0], 1e-4);
}

// The tip touches a model's triangles, not its hull.
TEST(Magnet, PicksUpAModel) {
  Scene scene;
  scene.tip_radius = 0.004;
  Object o = loose_block(0.05, {0.18, 0, -0.02}, 0, 2000);
  o.shape = Mesh{.triangles = box(Vec3::Constant(0.03)).mesh()};
  o.body->magnet = true;
  scene.add(o);
  scene.add({.name = "floor", .pose = pose_at({0, 0, -0.035}), .shape = Plane{}});
  const PushOutcome r = push(scene, 1, 300, 1500, [](double t) {
    HandInput hand{Vec3(0.18, 0, std::min(0.03, std::abs(0.03 * (t - 0.2)) - 0.0015))};
    hand.magnet = true;
    return hand;
  });
  EXPECT_GT(r.end.z(), 0);  // lifted by 2 cm, the hand's way, less the sag by its weight
  EXPECT_LE(r.energy, 5e-5);
  EXPECT_LE(r.gain, 1e-6);
}

// A contact's place is used again, by a joint's stop where a body was touched before.
TEST(Stop, TouchedAfterABodyIsFelt) {
  constexpr double kStop = -0.3;
  const ArmDescription arm = omni();
  for (std::uint8_t kind = 0; kind < std::tuple_size_v<Laws>; ++kind) {
    Scene scene;
    scene.tip_radius = 0.004;
    scene.gravity.setZero();
    scene.add(loose_block(0.5, {0.18, 0.03, 0}, 0.3, 1000));
    scene.add({.name = "stop", .shape = JointStop{0, kStop, -1}, .material = {20, 0, 0, 0}});
    Parameters p;
    p.kind = static_cast<CouplingKind>(kind);
    p.hand_stiffness = 300;
    const auto hand = [](double t) {  // to the block, back, and on beyond the stop
      const double y = t < 0.5 ? 0.03 * t / 0.5 : 0.03 - 0.14 * std::min((t - 0.5) / 0.7, 1.0);
      return HandInput{Vec3(0.18, y, 0)};
    };
    Rig rig(arm, scene);
    rig.start(p, rest_at(arm, hand(0).target));
    std::vector<double> row(static_cast<std::size_t>(rig.layout().stride()));
    const auto at = [&](Column c) { return rig.layout().in(std::span<const double>(row), c); };
    double moved = 0;
    for (int k = 0; k < 1500; ++k) {
      rig.step(p, {hand(k * p.tick)}, row);
      ASSERT_TRUE(std::isfinite(at(Column::proxy_position)[0])) << int(kind) << " in tick " << k;
      moved = std::max(moved, at(Column::body_pose)[1] - 0.03);
    }
    EXPECT_GT(moved, 0.001) << int(kind);
    const double led_to = std::atan2(-0.11, 0.18);
    EXPECT_LT(at(Column::proxy_position)[0], kStop) << int(kind);
    EXPECT_GT(at(Column::proxy_position)[0], led_to + 0.02) << int(kind);
  }
}

INSTANTIATE_TEST_SUITE_P(Stiffnesses, MovingBodies, testing::Values(600, 2000, 5000));

}  // namespace
}  // namespace limpid::test
