// The loop around a real device, here one that the test plays.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "devices/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/fake_device.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

// Held 0.05 rad inside a stop of its first joint: it is pushed back.
struct RealRig : testing::Test {
  RealRig() : rig(arm, stop_at(x0[0]), true), rows(rig.layout()) {
    for (Eigen::Index i = 0; i < 3; ++i) device.reading.x[static_cast<std::size_t>(i)] = x0[i];
    RigStart start{x0,
                   Eigen::Vector3d::Zero(),
                   x0,
                   Eigen::Vector3d::Zero(),
                   Eigen::Vector3d::Zero(),
                   Vec3::Zero(),
                   false};
    rig.start({}, start);
    rig.plug(&device);
  }
  static Scene stop_at(double x) {
    Scene scene;
    scene.joint_contacts.push_back({"stop", 0, x - 0.05, 1, 20});
    return scene;
  }
  ForceState step(int ticks = 1) {
    for (int i = 0; i < ticks; ++i) {
      if (alive) ++device.reading.count;
      rig.step({}, {{rig.tip(), 1}, armed}, rows.add());
    }
    return rig.force_state();
  }
  void push() {
    armed = true;
    ASSERT_EQ(step(1000), ForceState::on);
    ASSERT_LT(device.told[0], -0.1);
  }
  bool pushes() const { return device.told != std::array<double, kMaxDof>{}; }
  // After what made it so is over.
  void expect_stays_off(ForceState reason) {
    EXPECT_EQ(step(2000), reason);
    EXPECT_FALSE(pushes());
    armed = false;
    EXPECT_EQ(step(), ForceState::off);
    push();
  }

  const ArmDescription arm = test::omni();
  const Eigen::Vector3d x0 = rest_pose(arm);
  test::FakeDevice device{3};
  bool armed = false, alive = true;
  Rig rig;
  test::Rows rows;
};

TEST_F(RealRig, PushesNothingUntilItIsArmed) {
  EXPECT_EQ(step(500), ForceState::off);
  EXPECT_FALSE(pushes());
  push();
}

TEST_F(RealRig, FadesInAndJumpsNowhere) {
  armed = true;
  step(1000);
  const double limit = arm.joints[0].effort;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const double before = rows.vec(k - 1, Column::motor_torque)[0];
    const double now = rows.vec(k, Column::motor_torque)[0];
    ASSERT_LE(std::abs(now - before), limit * 1e-3 / SafetyLimits{}.slew + 1e-12);
    if (k < 100) {
      ASSERT_LE(std::abs(now), 0.2 * std::abs(rows.vec(k, Column::commanded_torque)[0]) + 1e-9);
    }
  }
}

TEST_F(RealRig, IsLostWithoutADevice) {
  push();
  rig.plug(nullptr);
  EXPECT_EQ(step(), ForceState::lost);
  rig.plug(&device);
  device.told.fill(0);
  expect_stays_off(ForceState::lost);
}

TEST_F(RealRig, StopsAtOnceWhenTheDeviceIsLost) {
  push();
  device.here = false;
  EXPECT_EQ(step(), ForceState::lost);
  EXPECT_FALSE(pushes());
  DeviceReading reading;
  EXPECT_FALSE(rig.device_reading(reading));
  device.here = true;
  step();
  EXPECT_TRUE(rig.device_reading(reading)) << "it is there again, though without force";
  expect_stays_off(ForceState::lost);
}

TEST_F(RealRig, StopsAtOnceWhenReadingsAreStale) {
  push();
  device.reading.age = 0.006;
  EXPECT_EQ(step(), ForceState::stale);
  EXPECT_FALSE(pushes());
  device.reading.age = 0;
  expect_stays_off(ForceState::stale);
}

TEST_F(RealRig, StopsAtOnceAtAFault) {
  push();
  device.reading.fault = true;
  EXPECT_EQ(step(), ForceState::fault);
  EXPECT_FALSE(pushes());
  device.reading.fault = false;
  expect_stays_off(ForceState::fault);
}

TEST_F(RealRig, StopsWhileThereIsNoHandAndFadesInAgain) {
  push();
  const double before = device.told[0];
  device.reading.hand = false;
  EXPECT_EQ(step(), ForceState::no_hand);
  EXPECT_FALSE(pushes());
  device.reading.hand = true;
  EXPECT_EQ(step(), ForceState::on);
  EXPECT_LT(std::abs(device.told[0]), 0.1 * std::abs(before));
  step(1000);
  EXPECT_NEAR(device.told[0], before, 0.01);
}

TEST_F(RealRig, TakesNoAngleThatIsNotANumber) {
  push();
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    const double good = device.reading.x[1];
    device.reading.x[1] = bad;
    EXPECT_EQ(step(), ForceState::fault);
    EXPECT_FALSE(pushes());
    device.reading.x[1] = good;
    for (const double value : rows.vec(rows.size() - 1, Column::measured_position)) {
      EXPECT_TRUE(std::isfinite(value));
    }
    expect_stays_off(ForceState::fault);
  }
}

TEST_F(RealRig, WaitsForTheFirstReading) {
  device.reading.count = 0;
  alive = false;
  armed = true;
  EXPECT_EQ(step(10), ForceState::stale);
  EXPECT_FALSE(pushes());
}

TEST_F(RealRig, IsWithoutForceAtAJumpOfItsAngle) {
  push();
  device.reading.x[1] += 0.5;
  EXPECT_EQ(step(), ForceState::too_fast);
  EXPECT_FALSE(pushes());
}

TEST_F(RealRig, SaysThatNobodyMeasuresTheHand) {
  step();
  for (const double value : rows.vec(0, Column::hand_torque)) EXPECT_TRUE(std::isnan(value));
  const Eigen::VectorXd target = rows.vec(0, Column::hand_target);
  EXPECT_LT((Vec3(target) - rig.tip()).norm(), 1e-12);
}

}  // namespace
}  // namespace limpid
