// The loop around a virtual device: repeatable to the last bit from any start.
#include "devices/simulated/rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "devices/simulated/virtual_device.h"
#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

using test::first_difference;
using test::Random;
using test::random_arm;
using test::Rows;

// Objects in the way of any arm: a plane just below the tip, a ball, a stop.
Scene things(const ArmDescription& description) {
  const Arm<kAnyDof> arm(description);
  Arm<kAnyDof>::Frames f;
  arm.frames(rest_pose(description), f);
  const Vec3 tip = arm.tip(f);
  Scene scene;
  scene.tip_radius = 0.003;
  scene.add({"", pose_at(tip - Vec3(0, 0, 0.008)), Plane{Vec3(0.1, 0.2, 1).normalized()}, 600});
  scene.add({"", pose_at(tip + Vec3(0.04, 0.01, 0)), Sphere{0.03}, 800});
  scene.add({.shape = JointStop{0, rest_pose(description)[0] + 0.05, 1}, .material = {20}});
  return scene;
}

// A hand on its way around the tip's place, which lets go at times; force is cut at times.
class Script {
 public:
  explicit Script(const Vec3& home) : home_(home) {}

  RigInput at(std::size_t k) const {
    const double t = 1e-3 * static_cast<double>(k);
    const Vec3 way(std::sin(3 * t), std::sin(4.1 * t), std::sin(5.3 * t));
    return {{home_ + 0.02 * way, k % 900 < 700 ? 1.0 : 0.3}, wish(k)};
  }
  static bool armed(std::size_t k) { return k % 1300 < 1000; }
  static ForceRequest wish(std::size_t k) {
    if (k == 0 || armed(k) == armed(k - 1)) return ForceRequest::as_it_is;
    return armed(k) ? ForceRequest::arm : ForceRequest::cut;
  }
  static Parameters parameters(std::size_t k) {
    Parameters p;
    p.kind = static_cast<CouplingKind>(k / 500 % kLaws);
    p.hand_mass_at_tip = k / 550 % 2 ? 0.1 : 0;
    p.device_delay = k / 650 % 2 ? 1 : 0;
    p.eta = k / 300 % 2 ? 0.8 : 2;
    p.velocity = static_cast<VelocitySource>(k / 400 % 3);
    p.encoder_step = k / 350 % 2 ? 4e-4 : 0;
    p.inertia_ratio = k / 450 % 2 ? 1e-4 : 1e-2;
    return p;
  }

 private:
  Vec3 home_;
};

Rows run_script(Rig& rig, const Script& script, std::size_t from, std::size_t ticks) {
  Rows rows(rig.layout());
  for (std::size_t k = from; k < from + ticks; ++k) {
    rig.step(Script::parameters(k), script.at(k), rows.add());
  }
  return rows;
}

Vec3 home_of(const ArmDescription& description) {
  const Arm<kAnyDof> arm(description);
  Arm<kAnyDof>::Frames f;
  arm.frames(rest_pose(description), f);
  return arm.tip(f);
}

class RigOfJoints : public testing::TestWithParam<int> {
 protected:
  const ArmDescription arm_ = random_arm(GetParam(), 140);
  const Scene scene_ = things(arm_);
  const Vec3 home_ = home_of(arm_);
  const Script script_{home_};
};
INSTANTIATE_TEST_SUITE_P(Arms, RigOfJoints, testing::Values(1, 2, 3, 7));

TEST_P(RigOfJoints, GivesTheSameBitsTwice) {
  Rig one(arm_, scene_), two(arm_, scene_);
  one.start(Script::parameters(0), rest_at(arm_, home_));
  two.start(Script::parameters(0), rest_at(arm_, home_));
  const Rows a = run_script(one, script_, 0, 3000);
  EXPECT_EQ(first_difference(a, run_script(two, script_, 0, 3000)), -1);
  // Also in a rig that was used before.
  one.start(Script::parameters(0), rest_at(arm_, home_));
  EXPECT_EQ(first_difference(a, run_script(one, script_, 0, 3000)), -1);
}

// The rig does not depend on the type of the device.
TEST_P(RigOfJoints, DrivesASimulatedDeviceThatIsPluggedInAsItDoesItsOwn) {
  Rig own(arm_, scene_);
  own.start(Script::parameters(0), rest_at(arm_, home_));
  const Rows expected = run_script(own, script_, 0, 2000);
  const auto expect_same = [&](Device& device) {
    Rig rig(arm_, scene_, &device);
    rig.start(Script::parameters(0), rest_at(arm_, home_));
    EXPECT_EQ(first_difference(expected, run_script(rig, script_, 0, 2000)), -1);
  };
  with_dof(arm_.dof(), [&](auto n) {
    VirtualDevice<n> device(arm_);
    expect_same(device);
  });
}

TEST_P(RigOfJoints, GoesOnFromItsPresentStateAsARecordingDoes) {
  // A loop in motion is restarted at its present state, as when a recording begins. Its first row
  // then suffices for another rig to give the same rows.
  Rig live(arm_, scene_);
  live.start(Script::parameters(0), rest_at(arm_, home_));
  run_script(live, script_, 0, 777);
  RigStart start = rest_at(arm_, home_);
  live.restart_here(Script::parameters(777), start, script_.at(777).hand.target);
  const Rows recorded = run_script(live, script_, 777, 2000);

  Rig again(arm_, scene_);
  again.start(Script::parameters(777), start_of(recorded.layout(), recorded.row(0)));
  EXPECT_GT(recorded.vec(0, Column::device_velocity).norm(), 1e-3);  // it was in motion
  EXPECT_GT(recorded.vec(0, Column::proxy_velocity).norm(), 1e-3);

  Rig undisturbed(arm_, scene_);
  undisturbed.start(Script::parameters(0), rest_at(arm_, home_));
  const Rows whole = run_script(undisturbed, script_, 0, 778);
  for (const Column c : {Column::device_position, Column::device_velocity, Column::proxy_position,
                         Column::proxy_velocity})
    EXPECT_EQ(recorded.vec(0, c), whole.vec(777, c)) << "column " << static_cast<int>(c);
  EXPECT_EQ(first_difference(recorded, run_script(again, script_, 777, 2000)), -1);
}

TEST_P(RigOfJoints, RestsWhereItIsPut) {
  Rig rig(arm_, Scene{});
  const RigStart start = rest_at(arm_, home_);
  rig.start(Parameters{}, start);
  EXPECT_LT((rig.tip() - home_).norm(), 1e-6);
  Rows rows(rig.layout());
  for (int k = 0; k < 500; ++k) rig.step(Parameters{}, {{home_, 1}}, rows.add());
  EXPECT_LT((rows.vec(499, Column::device_position) - start.x1).norm(), 1e-5);
  EXPECT_LT((rows.vec(499, Column::proxy_position) - start.x1).norm(), 1e-5);
  EXPECT_TRUE(rig.steady());
  EXPECT_FALSE(rig.diverged());
}

TEST_P(RigOfJoints, WritesWhatTheHandDid) {
  Rig rig(arm_, scene_);
  rig.start(Script::parameters(0), rest_at(arm_, home_));
  const Rows rows = run_script(rig, script_, 0, 1500);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const RigInput input = script_.at(k);
    ASSERT_EQ(rows.vec(k, Column::hand_target), Eigen::VectorXd(input.hand.target));
    ASSERT_EQ(rows.at(k, Column::hand_grip), input.hand.grip);
    ASSERT_EQ(rows.at(k, Column::force_wanted), Script::armed(k) ? 1 : 0);
    ASSERT_EQ(rows.at(k, Column::eta), Script::parameters(k).eta);
    ASSERT_NEAR(rows.at(k, Column::time), 1e-3 * static_cast<double>(k), 1e-12);
  }
}

TEST(Rig, RecordsTheContactsThatPush) {
  const ArmDescription arm = test::omni();
  Scene smooth = test::omni_scene("table.toml");
  for (Object& object : smooth.objects) {
    object.material.friction_static = object.material.friction_kinetic = 0;
  }
  Rig rig(arm, smooth);
  const Vec3 home(0.19, 0, 0);
  rig.start(Parameters{}, rest_at(arm, home));
  Rows rows(rig.layout());
  rig.step(Parameters{}, {{home, 1}}, rows.add());
  EXPECT_EQ(rows.vec(0, Column::contact_force), Eigen::VectorXd::Zero(12));
  EXPECT_EQ(rows.vec(0, Column::contact_point), Eigen::VectorXd::Zero(12));
  for (int k = 0; k < 3000; ++k) {
    const Vec3 target = home - Vec3(0, 0, std::min(0.045, 3e-5 * k));
    rig.step(Parameters{}, {{target, 1}}, rows.add());
  }
  const auto touches = rows.touches(rows.size() - 1);
  ASSERT_EQ(touches.size(), 1u);
  EXPECT_GT(touches[0].force.z(), 0.3);
  EXPECT_LT(touches[0].force.head<2>().norm(), 1e-12);
  EXPECT_NEAR(touches[0].point.z(), -0.04 - touches[0].force.z() / 600, 1e-5);
}

// The contact forces at their points make the torque at the joints: a plane at the tip, a ball at
// the middle of the last link.
TEST(Rig, RecordsContactForcesThatMakeTheContactTorque) {
  const ArmDescription description = test::omni();
  const Arm<kAnyDof> arm(description);
  Arm<kAnyDof>::Frames f;
  arm.frames(rest_pose(description), f);
  const Vec3 home = arm.tip(f), middle = 0.5 * (f.p[2] + home);
  Scene scene = things(description);
  std::erase_if(scene.objects, has_shape<JointStop>);
  std::erase_if(scene.objects, has_shape<Sphere>);
  scene.add({"", pose_at(middle + Vec3(0, 0.024, 0)), Sphere{0.02}, 500});
  scene.probes.push_back({"link", 2, Vec3::Zero(), description.tip.translation(), 0.005});
  Rig rig(description, scene);
  rig.start(Script::parameters(0), rest_at(description, home));
  const Rows rows = run_script(rig, Script(home), 0, 2000);
  int at_tip = 0, on_link = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    arm.frames(rows.vec(k, Column::proxy_position), f);
    Eigen::VectorXd torque = Eigen::VectorXd::Zero(3);
    for (const Rows::Touch& touch : rows.touches(k)) {
      Jacobian<kAnyDof> J;
      arm.point_jacobian(f, 2, touch.point, J);
      torque += J.transpose() * touch.force;
      ++((touch.point - arm.tip(f)).norm() < 1e-9 ? at_tip : on_link);
    }
    ASSERT_LT((torque - rows.vec(k, Column::contact_torque)).norm(), 1e-12) << k;
  }
  EXPECT_GT(at_tip, 100);
  EXPECT_GT(on_link, 100);
}

TEST(RestAt, RefusesWhatIsOutOfReach) {
  EXPECT_THROW(rest_at(test::omni(), Vec3(1, 0, 0)), std::invalid_argument);
}

}  // namespace
}  // namespace limpid
