// The loop around a guarded device, here one that the test plays.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/dynamics/arm.h"
#include "core/dynamics/inverse_kinematics.h"
#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/fake_device.h"
#include "tests/support/random_arm.h"
#include "tests/support/rows.h"
#include "tests/support/wisher.h"

namespace limpid {
namespace {

// A device held 0.05 rad inside a stop of its first joint: it is pushed back.
struct RealRig : testing::Test {
  RealRig() : rig(arm, stop_at(x0[0]), nullptr), rows(rig.layout()) {
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
    scene.add({.name = "stop", .shape = JointStop{0, x - 0.05, 1}, .material = {20}});
    return scene;
  }
  ForceState step(int ticks = 1) {
    for (int i = 0; i < ticks; ++i) {
      if (alive) ++device.reading.count;
      // The last bit of every working encoder changes at times.
      if (trembles) device.reading.x[2] = x0[2] + (device.reading.count % 2 == 0 ? 1e-9 : 0);
      input.hand = {rig.tip(), 1};
      input.force = wisher.at(armed);
      rig.step({}, input, rows.add());
    }
    return rig.force_state();
  }
  void push() {
    armed = true;
    ASSERT_EQ(step(1000), ForceState::on);
    ASSERT_LT(device.told[0], -0.1);
  }
  bool pushes() const { return device.told != std::array<double, kMaxDof>{}; }
  // Expects no force after the end of the fault, until the device is armed again.
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
  bool armed = false, alive = true, trembles = true;
  test::Wisher wisher;
  RigInput input;  // the other input of a tick
  Rig rig;
  test::Rows rows;
};

TEST_F(RealRig, PushesNothingUntilItIsArmed) {
  EXPECT_EQ(step(500), ForceState::off);
  EXPECT_FALSE(pushes());
  push();
}

TEST_F(RealRig, PushesAtOnceWhereNoHandHasToBeGuarded) {
  device.own_traits().guarded = false;
  RigStart start{x0, x0 * 0, x0, x0 * 0, x0 * 0, Vec3::Zero(), true};
  rig.start({}, start);
  EXPECT_EQ(step(2), ForceState::on);
  device.reading.hand = false;
  device.reading.fault = true;
  EXPECT_EQ(step(200), ForceState::on);
  EXPECT_LT(device.told[0], -0.1);
}

TEST_F(RealRig, FadesInAndJumpsNowhere) {
  armed = true;
  step(1000);
  const double limit = arm.joints[0].effort;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const double before = rows.vec(k - 1, Column::motor_torque)[0];
    const double now = rows.vec(k, Column::motor_torque)[0];
    ASSERT_LE(std::abs(now - before), limit * 1e-3 / 0.02 + 1e-12);
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
    EXPECT_EQ(step(), ForceState::wrong);
    EXPECT_FALSE(pushes());
    device.reading.x[1] = good;
    for (const double value : rows.vec(rows.size() - 1, Column::measured_position)) {
      EXPECT_TRUE(std::isfinite(value));
    }
    expect_stays_off(ForceState::wrong);
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

// The tick after the stall is as long as the stall; normal ones follow.
TEST_F(RealRig, StartsFromNothingAfterAStallAndFadesIn) {
  const double limit = arm.joints[0].effort;
  for (const int stall : {6, 9, 20, 100, 1000}) {
    push();
    const double full = std::abs(device.told[0]);
    input.dt = 1e-3 * stall;
    input.periods = stall;
    EXPECT_EQ(step(), ForceState::stalled) << stall;
    input = {};
    for (int k = 1; k <= 600; ++k) {
      ASSERT_LE(std::abs(device.told[0]), 1.3 * full * k / 500 + 1e-9) << stall << " ms, " << k;
      ASSERT_LE(std::abs(device.told[0]), limit * k / 20 + 1e-12);
      step();
    }
    EXPECT_NEAR(std::abs(device.told[0]), full, 0.02) << "and then it is there again";
    armed = false;
    step();
  }
}

TEST_F(RealRig, StartsFromNothingWhenTheDeviceWasWithoutTorque) {
  push();
  const double full = std::abs(device.told[0]);
  ++device.reading.lapses;
  EXPECT_EQ(step(), ForceState::stalled);
  EXPECT_LE(std::abs(device.told[0]), 0.003 * full);
  EXPECT_EQ(step(100), ForceState::on);
  EXPECT_LE(std::abs(device.told[0]), 0.25 * full);
}

// The new device's count of lapses may have any value: nobody knows what it received.
TEST_F(RealRig, StartsFromNothingWithAnotherDevice) {
  push();
  const double full = std::abs(device.told[0]);
  test::FakeDevice another = device;
  rig.plug(&another);
  EXPECT_EQ(step(), ForceState::stalled);
  EXPECT_LE(std::abs(another.told[0]), 0.003 * full);
}

TEST_F(RealRig, StaysWhereItWasWhenTheDeviceIsLost) {
  push();
  device.here = false;
  device.reading.x[0] += 0.3;
  step();
  EXPECT_EQ(rows.vec(rows.size() - 1, Column::device_position)[0], x0[0]);
}

TEST_F(RealRig, GoesOnAfterAGapOfFourMilliseconds) {
  push();
  const double full = std::abs(device.told[0]);
  input.dt = 0.0049;
  input.periods = 4;
  EXPECT_EQ(step(), ForceState::on);
  EXPECT_GT(std::abs(device.told[0]), 0.9 * full);
}

TEST_F(RealRig, MeasuresVelocitiesInTheTimeThatPassed) {
  step(5);
  device.reading.x[1] += 0.003;
  input.dt = 0.003;
  input.periods = 3;
  step();
  const std::size_t last = rows.size() - 1;
  EXPECT_NEAR(rows.vec(last, Column::measured_velocity)[1], 1, 1e-9);
  EXPECT_NEAR(rows.vec(last, Column::device_velocity)[1], 1, 1e-9);
  EXPECT_NEAR(rows.at(last, Column::time) - rows.at(last - 1, Column::time), 0.003, 1e-12);
}

TEST_F(RealRig, SaysAfterAStallThatItIsAtRest) {
  step(5);
  device.reading.x[1] += 0.3;
  input.dt = 0.02;
  input.periods = 20;
  step();
  const std::size_t last = rows.size() - 1;
  EXPECT_EQ(rows.vec(last, Column::measured_velocity).norm(), 0);
  EXPECT_EQ(rows.vec(last, Column::device_velocity).norm(), 0);
  EXPECT_EQ(rows.vec(last, Column::hand_torque_estimate).norm(), 0);
  EXPECT_NEAR(rows.at(last, Column::time) - rows.at(last - 1, Column::time), 0.02, 1e-12);
}

// The motion during a stall is nobody's work.
TEST_F(RealRig, BooksNoEnergyForTheTimeOfAStall) {
  Parameters p;
  p.damping = 0.1;
  const auto tick = [&] {
    ++device.reading.count;
    input.hand = {rig.tip(), 1};
    rig.step(p, input, rows.add());
  };
  for (int i = 0; i < 5; ++i) tick();
  device.reading.x[1] += 0.3;
  input.dt = 0.02;
  input.periods = 20;
  tick();
  const std::size_t last = rows.size() - 1;
  EXPECT_NEAR(rows.at(last, Column::energy_total), rows.at(last - 1, Column::energy_total), 1e-6);
}

// The proxy goes on as if the stall had been one tick.
TEST_F(RealRig, MovesItsProxyByOneTickHoweverLongAStallWas) {
  const auto moved_after = [&](int periods) {
    for (int i = 0; i < 200; ++i) {
      device.reading.x[1] += 1e-3;  // 1 rad/s
      step();
    }
    input.dt = 0.02;
    input.periods = periods;
    step();
    input.dt = 0;
    input.periods = 1;
    step();
    const std::size_t last = rows.size() - 1;
    return rows.vec(last, Column::proxy_position)[1] -
           rows.vec(last - 1, Column::proxy_position)[1];
  };
  const double one = moved_after(1);
  EXPECT_GT(one, 1e-5);
  EXPECT_NEAR(moved_after(20), one, 0.05 * one);
}

// Two ticks in close succession raise the torque no further than the time between them allows. It
// falls at once.
TEST_F(RealRig, RaisesItsTorqueAtABoundedRateInWallTime) {
  test::Random random(50);
  const double limit = arm.joints[0].effort;
  armed = true;
  double before = device.told[0];
  for (int k = 0; k < 5000; ++k) {
    device.reading.x[0] = x0[0] + random.between(-0.03, 0.03);
    input.dt = random.between(1e-5, 2e-3);
    step();
    const double allowed = limit * std::min(input.dt, 1e-3) / 0.02;
    const bool turned = device.told[0] * before < 0;
    const double grown = std::abs(device.told[0]) - (turned ? 0 : std::abs(before));
    ASSERT_LE(grown, allowed + 1e-12) << k;
    before = device.told[0];
  }
}

TEST_F(RealRig, IsOffAfterItWasStartedOver) {
  push();
  RigStart start;
  start.x1 = start.x2 = x0;
  start.v1 = start.v2 = start.f1_hat = Eigen::Vector3d::Zero();
  start.armed = true;  // whatever asks for it
  rig.start({}, start);
  EXPECT_EQ(step(1000), ForceState::off);
  EXPECT_FALSE(pushes());
}

TEST_F(RealRig, KeepsItsForceWhenARecordingBegins) {
  push();
  const double before = device.told[0];
  RigStart scratch;
  scratch.x1 = scratch.v1 = scratch.x2 = scratch.v2 = scratch.f1_hat = Eigen::Vector3d::Zero();
  rig.restart_here({}, scratch, rig.tip());
  EXPECT_EQ(step(), ForceState::on);
  EXPECT_NEAR(device.told[0], before, 0.05 * std::abs(before));
  EXPECT_EQ(rows.at(rows.size() - 1, Column::time), 0);
}

TEST_F(RealRig, FadesAndTripsWhenTheWindowIsSilent) {
  push();
  const double full = std::abs(device.told[0]);
  input.silence = 0.3;
  EXPECT_EQ(step(30), ForceState::unwatched);
  EXPECT_NEAR(std::abs(device.told[0]), 0.5 * full, 0.1 * full);
  input.silence = 0.4;
  EXPECT_EQ(step(), ForceState::unwatched);
  EXPECT_FALSE(pushes());
  input.silence = 0;
  expect_stays_off(ForceState::unwatched);
}

// New readings keep coming with the same values.
TEST_F(RealRig, FadesAndStaysOffWhereItsReadingsStandStill) {
  push();
  const double full = std::abs(device.told[0]);
  trembles = false;
  EXPECT_EQ(step(295), ForceState::on);
  EXPECT_NEAR(std::abs(device.told[0]), full, 1e-3 * full);
  EXPECT_EQ(step(155), ForceState::frozen);
  EXPECT_NEAR(std::abs(device.told[0]), 0.5 * full, 0.02 * full);
  EXPECT_EQ(step(155), ForceState::frozen);
  EXPECT_FALSE(pushes());
  EXPECT_EQ(rows.at(rows.size() - 1, Column::force_state), 12);
  armed = false;
  step();
  armed = true;
  EXPECT_EQ(step(1000), ForceState::frozen) << "arming helps no sooner than it has moved";
  EXPECT_FALSE(pushes());
  trembles = true;
  expect_stays_off(ForceState::frozen);
}

// The torque sent to the motors counts, not the law's.
TEST_F(RealRig, MayStandStillForEverWithoutForce) {
  trembles = false;
  EXPECT_EQ(step(2000), ForceState::off);
  armed = true;
  EXPECT_EQ(step(100), ForceState::on);
  EXPECT_TRUE(pushes());
}

// A hand that holds still against a wall, and an encoder so coarse that it reads the same for
// seconds: 300 N/m at 0.13 m, a stick of 2e-3 kg m^2 without and with dry friction.
TEST_F(RealRig, PushesOnWhereAHandHoldsACoarseEncoderStill) {
  constexpr double kStep = 5e-4, kInertia = 2e-3, kHand = 5, kHandDamping = 0.1, kDry = 0.004;
  for (const double dry : {0.0, kDry}) {
    double x = x0[0], v = 0, least = 1e9, most = 0;
    int still = 0, longest = 0;
    const auto live = [&](int ticks, bool watch) {
      for (int k = 0; k < ticks; ++k) {
        for (int i = 0; i < 10; ++i) {
          const double f = device.told[0] + kHand * (x0[0] + 0.02 - x) - kHandDamping * v;
          const double after = v + 1e-4 / kInertia * f, brake = 1e-4 / kInertia * dry;
          v = std::abs(after) <= brake ? 0 : after - std::copysign(brake, after);
          x += 1e-4 * v;
        }
        const double read = kStep * std::round(x / kStep);
        still = read == device.reading.x[0] ? still + 1 : 0;
        longest = std::max(longest, still);
        device.reading.x[0] = read;
        step();
        if (!watch) continue;
        least = std::min(least, std::abs(device.told[0]));
        most = std::max(most, std::abs(device.told[0]));
      }
    };
    trembles = false;
    armed = true;
    live(2000, false);
    live(10000, true);
    EXPECT_GT(longest, 250) << "it stood still for a while";
    EXPECT_EQ(rig.force().armed(), true);
    EXPECT_GT(least, 0.85 * most) << "dry friction " << dry;
    armed = false;
    step(10);
  }
}

TEST_F(RealRig, ObeysLowerLimits) {
  push();
  rig.limit({.tip_force = 0.2});
  step(100);
  const Arm<3> model(arm);
  Arm<3>::Frames frames;
  model.frames(x0, frames);
  Jacobian<3> J;
  model.point_jacobian(frames, 2, model.tip(frames), J);
  const Eigen::Vector3d tau(device.told[0], device.told[1], device.told[2]);
  // The smallest tip force with this torque; J is square here.
  const Eigen::Matrix3d square = J;
  EXPECT_NEAR((square.transpose().inverse() * tau).norm(), 0.2, 1e-3);
}

// A body pulled with the mouse against the tip arms nothing, and the limits hold. A window that
// hangs meanwhile leaves the pull unchanged, and the force fades.
TEST_F(RealRig, IsPushedByABodyThatIsPulledOnlyWhileItIsArmedAndWithinItsLimits) {
  Scene scene;
  scene.gravity.setZero();
  scene.tip_radius = 0.004;
  Object ball{.name = "ball", .shape = Sphere{0.02}};
  ball.material = {600};
  ball.body = Body{};
  ball.body->mass = 1;
  const Arm<3> model(arm);
  const Vec3 tip = model.tip_at(x0);
  ball.pose.translation() = tip + Vec3(0, 0.03, 0);
  scene.add(ball);
  rig = Rig(arm, scene, nullptr);
  rows = test::Rows(rig.layout());
  rig.start({}, {x0, x0 * 0, x0, x0 * 0, x0 * 0, tip, false});
  rig.limit({.tip_force = 0.2});
  rig.plug(&device);
  Arm<3>::Frames frames;
  model.frames(x0, frames);
  Jacobian<3> J;
  model.point_jacobian(frames, 2, model.tip(frames), J);
  const Eigen::Matrix3d square = J;
  const auto force = [&] {
    const Eigen::Vector3d tau(device.told[0], device.told[1], device.told[2]);
    return (square.transpose().inverse() * tau).norm();
  };
  const Vec3 target = tip + Vec3(0, 0.015, 0);
  double most = 0;
  const auto pull = [&](int ticks) {
    for (int k = 0; k < ticks; ++k) {
      ++device.reading.count;
      device.reading.x[2] = x0[2] + (device.reading.count % 2 == 0 ? 1e-9 : 0);
      input.hand = {tip, 1};
      input.hand.pull = {0, Vec3::Zero(), target};
      input.force = wisher.at(armed);
      rig.step({}, input, rows.add());
      most = std::max(most, force());
    }
  };
  pull(500);
  const auto contact = [&] { return rows.vec(rows.size() - 1, Column::contact_torque).norm(); };
  EXPECT_GT(contact(), 0.1) << "the ball lies against the tip, and presses";
  EXPECT_FALSE(pushes());
  armed = true;
  pull(1000);
  EXPECT_NEAR(force(), 0.2, 1e-3);
  EXPECT_LE(most, 0.2 + 1e-9);
  input.silence = 1;
  pull(1);
  EXPECT_FALSE(pushes());
  EXPECT_EQ(rig.force_state(), ForceState::unwatched);
  EXPECT_GT(contact(), 0.1) << "it is pulled all the while";
}

// A single joint is pressed by a radian into a stop at zero: the spring and the limit of 10 N at
// the tip store some joules.
TEST(RealRigOfOneJoint, TakesEnergyFromTheHandAndGivesUpWhenTheMotorsGiveItBackAtOnce) {
  ArmDescription arm = test::random_arm(1, 52);
  arm.joints[0].lower = -4;
  arm.joints[0].upper = 4;
  arm.joints[0].effort = 20;
  arm.tip.translation() *= 4;
  const double lever = reach(arm);
  ASSERT_GT(lever, 0.3);
  Scene scene;
  scene.add({.name = "stop", .shape = JointStop{0, 0, 1}, .material = {100}});
  Rig rig(arm, scene, nullptr);
  Parameters p;
  p.k_vc = 100;
  RigStart start;
  start.x1 = start.v1 = start.x2 = start.v2 = start.f1_hat = Eigen::VectorXd::Constant(1, 0);
  rig.start(p, start);
  test::FakeDevice device(1);
  device.own_traits().lower = {-4};
  device.own_traits().upper = {4};
  rig.plug(&device);
  std::vector<double> row(static_cast<std::size_t>(rig.layout().stride()));
  const auto go = [&](double to, double rate) {
    double& x = device.reading.x[0];
    double work = 0;
    while (std::abs(to - x) > 1e-9 && rig.force_state() != ForceState::energy) {
      const double step = std::clamp(to - x, -1e-3 * rate, 1e-3 * rate);
      work += device.told[0] * step;
      x += step;
      ++device.reading.count;
      rig.step(p, {.hand = {rig.tip(), 1}}, row);
    }
    return work;
  };
  rig.step(p, {.hand = {rig.tip(), 1}, .force = ForceRequest::arm}, row);
  go(-0.3, 0.3);  // the force fades in meanwhile
  go(0, 1);
  ASSERT_EQ(rig.force_state(), ForceState::on);
  const double rate = 1.5 / lever;  // for 1.5 m/s at the tip
  EXPECT_LT(go(2.4, rate), -4) << "the hand puts in so many joules";
  EXPECT_EQ(rig.force_state(), ForceState::on);
  const double given = go(0, rate);
  EXPECT_EQ(rig.force_state(), ForceState::energy);
  EXPECT_GT(given, 1.4);
  EXPECT_LT(given, 1.8);
}

// In every run, the motors of an unarmed device are off, and no torque grows faster than allowed.
TEST_F(RealRig, NeverPushesUnarmedNorJumpsInAMillionTicks) {
  test::Random random(51);
  const auto chance = [&](double p) { return random.between(0, 1) < p; };
  std::vector<double> row(static_cast<std::size_t>(rig.layout().stride()));
  RigStart scratch;
  scratch.x1 = scratch.v1 = scratch.x2 = scratch.v2 = scratch.f1_hat = Eigen::Vector3d::Zero();
  Parameters p;
  bool asked = false;
  double before[3] = {};
  int pushed = 0;
  for (int k = 0; k < 1'000'000; ++k) {
    ++device.reading.count;
    for (std::size_t i = 0; i < 3; ++i) {
      device.reading.x[i] = x0[static_cast<Eigen::Index>(i)] +
                            0.002 * std::sin(1e-3 * k + 2.0 * static_cast<double>(i));
    }
    device.here = !chance(2e-5);
    device.reading.hand = !chance(5e-5);
    device.reading.fault = chance(2e-5);
    device.reading.age = chance(2e-5) ? 0.01 : 0.001;
    if (chance(2e-5)) device.reading.x[1] = std::nan("");
    if (chance(2e-5)) ++device.reading.lapses;
    input.dt = chance(1e-4) ? random.between(0, 0.02) : 1e-3;
    input.periods = input.dt > 1e-3 ? static_cast<int>(input.dt * 1e3) : 1;
    input.silence = chance(1e-4) ? random.between(0, 0.5) : 0;
    input.force = chance(1e-3)   ? ForceRequest::arm
                  : chance(1e-4) ? ForceRequest::cut
                                 : ForceRequest::as_it_is;
    input.hand = {rig.tip(), 1};
    if (chance(2e-5)) rig.plug(chance(0.5) ? nullptr : &device);
    if (chance(1e-4)) rig.plug(&device);
    if (chance(1e-4)) p.kind = static_cast<CouplingKind>(random.between(0, kLaws - 1e-9));
    if (chance(2e-5)) {
      scratch.x1 = scratch.x2 = x0;
      scratch.armed = chance(0.5);
      rig.start(p, scratch);
      asked = false;
      std::fill_n(before, 3, 0);
    }
    if (chance(2e-5)) rig.restart_here(p, scratch, rig.tip());
    if (input.force == ForceRequest::arm) asked = true;
    if (input.force == ForceRequest::cut) asked = false;
    rig.step(p, input, row);
    if (rig.force().state() == Arming::tripped || rig.force().state() == Arming::off) asked = false;
    const auto motor = rig.layout().in(std::span<const double>(row), Column::motor_torque);
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_TRUE(asked || motor[i] == 0) << k;
      const double grown = std::abs(motor[i]) - std::abs(before[i]);
      ASSERT_LE(grown, arm.joints[i].effort * std::min(input.dt, 1e-3) / 0.02 + 1e-12) << k;
      before[i] = motor[i];
    }
    pushed += pushes() ? 1 : 0;
  }
  EXPECT_GT(pushed, 100'000);
}

TEST_F(RealRig, SaysThatNobodyMeasuresTheHand) {
  step();
  for (const double value : rows.vec(0, Column::hand_torque)) EXPECT_TRUE(std::isnan(value));
  const Eigen::VectorXd target = rows.vec(0, Column::hand_target);
  EXPECT_LT((Vec3(target) - rig.tip()).norm(), 1e-12);
}

}  // namespace
}  // namespace limpid
