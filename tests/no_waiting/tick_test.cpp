// Ticks of a rig, and of the check of axes, without allocations and locks.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <vector>

#include "core/realtime/trace_ring.h"
#include "core/realtime/triple_buffer.h"
#include "devices/hid/axis_check.h"
#include "devices/simulated/hands.h"
#include "devices/simulated/rig.h"
#include "tests/no_waiting/watch.h"
#include "tests/support/meshes.h"
#include "tests/support/random_arm.h"
#include "tests/support/wisher.h"

namespace limpid {
namespace {

using test::Random;
using test::random_arm;

TEST(Watch, SeesAllocationsAndLocks) {
  std::mutex mutex;
  int seen = 0, locked = 0;
  {
    const Watch watch;
    const std::vector<double> vector(1000, 1.0);
    const std::lock_guard lock(mutex);
    seen = watched.allocations + (vector[7] > 2 ? 1 : 0);
    locked = watched.locks;
  }
  EXPECT_GE(seen, 1);
  EXPECT_GE(locked, 1);
}

// A plane, balls, boxes and meshes around the tip, a capsule on the arm, a stop: all at once.
Scene crowd(const ArmDescription& description, const Vec3& tip) {
  Random random(150);
  Scene scene;
  scene.tip_radius = 0.003;
  scene.add({"", pose_at(tip - Vec3(0, 0, 0.005)), Plane{Vec3::UnitZ()}, 600});
  for (int i = 0; i < 8; ++i) {
    scene.add({"", pose_at(tip + 0.03 * random.direction()), Sphere{0.02}, 600});
    Object box{.shape = Box{}};
    box.pose.linear() = random.rotation();
    box.pose.translation() = tip + 0.08 * random.direction();
    scene.add(box);
  }
  Object body = test::obstacle(test::bumpy_body(4, 0.3)),
         sheet = test::obstacle(test::sheet(20, 0.3));
  test::mesh_of(body).scale = 0.02;
  body.pose.translation() = tip + Vec3(0.01, 0.03, -0.01);
  sheet.pose.linear() = random.rotation();
  sheet.pose.translation() = tip + 0.01 * random.direction();
  scene.add(body);
  scene.add(sheet);
  scene.add({.shape = JointStop{0, 0.02, 1}, .material = {20}});
  scene.probes.push_back(
      {"", description.dof() - 1, Vec3::Zero(), description.tip.translation(), 0.01});
  return scene;
}

// Starts the rig at rest with all joints at zero; returns that start.
RigStart start_at_zero(Rig& rig, int joints) {
  RigStart start;
  start.x1 = start.v1 = start.x2 = start.v2 = start.f1_hat = Eigen::VectorXd::Zero(joints);
  start.warmth = start.x1;
  rig.start(Parameters{}, start);
  return start;
}

class NoWaiting : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Arms, NoWaiting, testing::Values(1, 3, 7, 32));

TEST_P(NoWaiting, NeitherAllocatesNorLocksInATick) {
  const int n = GetParam();
  ArmDescription arm = random_arm(n, 151);
  for (Joint& joint : arm.joints) {
    joint.continuous = 0.1 * joint.effort;
    joint.warming = 1;
  }
  Rig rig(arm, Scene{});
  RigStart start = start_at_zero(rig, n);
  const Vec3 home = rig.tip();
  Rig crowded(arm, crowd(arm, home));
  start.target = home;
  crowded.start(Parameters{}, start);

  std::vector<double> row(static_cast<std::size_t>(rig.layout().stride()));
  TraceRing ring(1 << 10, row.size());
  TripleBuffer<std::array<double, kMaxStride>> snapshots;
  MouseHand hand;
  hand.reset(home);
  RigStart present = start;
  std::size_t touched = 0;
  test::Wisher wisher(true);
  {
    const Watch watch;
    for (int k = 0; k < 1200; ++k) {
      Parameters p;
      p.kind = static_cast<CouplingKind>(k / 100 % kLaws);
      p.hand_mass_at_tip = k / 150 % 2 ? 0.1 : 0;
      p.device_delay = p.delay = k / 170 % 3;
      p.link_delay = k / 130 % 3 * 8;
      p.link_jitter = k / 110 % 2 * 5;
      p.link_loss = k / 140 % 2 * 0.3;
      p.velocity = static_cast<VelocitySource>(k / 200 % 3);
      p.encoder_step = k % 300 < 150 ? 4e-4 : 0;
      p.inertia_ratio = k / 250 % 2 ? 1e-4 : 1e-2;
      p.anti_windup = k % 2 == 0;
      p.eta = k / 70 % 2 ? 0.8 : 2;
      p.weighs = p.holds_weight = k / 90 % 2 == 0;
      p.springy = p.holds_springs = k / 80 % 2 == 0;
      p.friction_share = k / 60 % 2 ? 0.7 : 0;
      p.friction = 0.01;
      const double t = 1e-3 * k;
      const Vec3 goal = home + 0.03 * Vec3(std::sin(9 * t), std::sin(7 * t), -std::sin(5 * t));
      const HandInput input =
          hand.step(k % 500 < 400, goal, crowded.tip(), p.hand_stiffness, p.tick);
      crowded.step(p, {input, wisher.at(k % 600 < 500)}, row);
      touched +=
          std::ranges::count(rig.layout().in(std::span(row), Column::contact_force), 0.0) < 12;
      ring.push(row);
      std::copy(row.begin(), row.end(), snapshots.back().begin());
      snapshots.publish();
      if (k % 333 == 332) {  // as at the start of a recording
        crowded.restart_here(p, present, goal);
      }
    }
  }
  EXPECT_EQ(watched.allocations, 0);
  EXPECT_EQ(watched.locks, 0);
  EXPECT_GT(touched, 100u);
  EXPECT_FALSE(crowded.diverged());
}

// Bodies of every shape fall on each other, on a plane, a mesh and the tip. They hang on every kind
// of joint, of the world and of each other; two are on a spring, and the magnet takes one.
Scene heap(const Vec3& tip) {
  Random random(152);
  Scene scene;
  scene.tip_radius = 0.003;
  scene.add({"floor", pose_at(tip - Vec3(0, 0, 0.03)), Plane{Vec3::UnitZ()}, 600});
  Object ground = test::obstacle(test::bumpy_body(4, 0.3));
  test::mesh_of(ground).scale = 0.02;
  ground.pose.translation() = tip + Vec3(0.03, 0.03, -0.03);
  scene.add(ground);
  const std::array<Shape, 4> shapes{Box{Vec3::Constant(0.02)}, Sphere{0.01}, Cylinder{0.01, 0.02},
                                    Capsule{0.008, 0.02}};
  for (int i = 0; i < 12; ++i) {
    Object o{.name = "body " + std::to_string(i), .shape = shapes[static_cast<std::size_t>(i % 4)]};
    o.pose.linear() = random.rotation();
    o.pose.translation() = tip + 0.01 * random.direction() + Vec3(0, 0, 0.025 * (i + 1));
    o.material = {2000, 0, 0.4, 0.3};
    o.body = Body{};
    o.body->mass = random.log_between(0.002, 0.1);
    o.body->magnet = true;
    if (i % 4 == 3) o.body->joint.emplace().kind = static_cast<BodyJoint::Kind>(i / 4);
    if (i == 5 || i == 9) {  // on another body that moves
      BodyJoint& joint = o.body->joint.emplace();
      joint.kind = i == 5 ? BodyJoint::Kind::slider : BodyJoint::Kind::hinge;
      joint.to = "body " + std::to_string(i - 1);
      joint.low = -0.01;
      joint.force.detent_force = 0.01;
    }
    if (o.body->joint) {
      o.body->joint->damping = 1e-4;
      o.body->joint->friction = 1e-3;
    }
    scene.add(o);
  }
  scene.springs.push_back({.between = {"body 0", "body 1"}, .length = 0.02});
  return scene;
}

TEST_P(NoWaiting, NeitherAllocatesNorLocksWithBodiesThatMove) {
  const int n = GetParam();
  const ArmDescription arm = random_arm(n, 151);
  Rig rig(arm, Scene{});
  RigStart start = start_at_zero(rig, n);
  start.target = rig.tip();
  Rig heaped(arm, heap(rig.tip()));
  heaped.start(Parameters{}, start);
  RigStart present = start;
  heaped.present(present);  // sizes it to the scene's needs
  const RowLayout& layout = heaped.layout();
  std::vector<double> row(static_cast<std::size_t>(layout.stride()));
  double moved = 0, held = 0;
  {
    const Watch watch;
    for (int k = 0; k < 1500; ++k) {
      Parameters p;
      p.kind = static_cast<CouplingKind>(k / 100 % kLaws);
      p.torque_limit = k / 150 % 2 ? 0.05 : 1;
      RigInput input;
      const double t = 1e-3 * k;
      input.hand.target = start.target + 0.02 * Vec3(std::sin(9 * t), std::sin(7 * t), 0);
      input.hand.magnet = k % 300 > 150;
      heaped.step(p, input, row);
      moved = std::max(moved, layout.in(std::span<const double>(row), Column::objects_awake)[0]);
      held = std::max(held, layout.in(std::span<const double>(row), Column::magnet)[0]);
      if (k % 333 == 332) heaped.restart_here(p, present, input.hand.target);
    }
  }
  EXPECT_EQ(watched.allocations, 0);
  EXPECT_EQ(watched.locks, 0);
  EXPECT_EQ(moved, 12);
  EXPECT_GT(held, 0);
}

TEST(NoWaiting, NeitherAllocatesNorLocksWhileAxesAreChecked) {
  DeviceTraits traits;
  traits.dof = 2;
  traits.pushes = true;
  traits.lower = {-0.5, -0.5};
  traits.upper = traits.effort = {0.5, 0.5};
  AxisCheck check(traits);
  std::array<double, 2> x{};
  {
    const Watch watch;
    for (int k = 0; k < 6000 && !check.done(); ++k) {
      const auto torque = check.step({x, 1e-3, true});
      x = {0.6 * torque[0], -0.6 * torque[1]};
    }
  }
  EXPECT_EQ(watched.allocations, 0);
  EXPECT_EQ(watched.locks, 0);
  EXPECT_TRUE(check.passed());
}

}  // namespace
}  // namespace limpid
